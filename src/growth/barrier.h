// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/simd.h"
#include "growth/grow_state.h"

#include <array>

namespace vdb_shell::growth
{

/// Linear bounds on one vertex, value(x) = n.(x - here) + value > 0, scaled to unit n: only where
/// they vanish matters. In float32, lane by lane: the barrier proposes, the exact tests decide.
class LinearBounds
{
public:
    /// Starts anew around the position of the vertex; `scale` is the length that is to be 1.
    void clear(const Vec3d& here, double scale);
    /// A bound of normal n, any length, through p. Left out where it does not hold here.
    void add(const Vec3d& n, const Vec3d& p);
    /// A bound of unit normal n and value here.
    void add_unit(const Vec3s& n, double value);
    /// The bounds of all tets of a prism that hold this vertex, under the twelve-tet test: what add
    /// would make of each, in float32. The other corners: a of the vertex, a of the next and of the
    /// one before it in its triangle, b of these.
    void add_prism(const std::array<Vec3d, 5>& corner);
    /// Gives the bounds from `first` on the weight `weight` each; all have 1 else.
    void weigh(std::size_t first, float weight);
    std::size_t size() const { return size_; }

    /// Bounds side by side; lanes that are not used have the weight 0.
    struct alignas(kLanesAlignment) Block {
        Block() {} // whoever adds one fills it
        std::array<float, kLanes> x, y, z, value, weight;
    };
    /// For barrier_minimum: the bounds, the place that they are relative to, and the inverse of
    /// their unit.
    std::vector<Block>& blocks() { return block_; }
    const Vec3d& here() const { return here_; }
    double scale() const { return scale_; }

private:
    std::vector<Block> block_;
    std::size_t size_ = 0;
    Vec3d here_{0.0};
    double scale_ = 1;
};

/// A ball that x has to stay in; infinite: no such bound.
struct Ball {
    Vec3d centre;
    double radius;
};

/// Minimum over x of gradient . x - weight * (sum of c_i log(bound_i(x)) + log(r^2 - |x - c|^2)),
/// where c_i is what weigh() gave the bound and the last term is there only for a ball of finite
/// radius: convex, three unknowns (docs/theory.md, "Barrier"). Damped Newton from where the bounds
/// were cleared. A few steps only: the vertex comes up again in the next sweep.
Vec3d barrier_minimum(LinearBounds& bounds, const Ball& ball, const Vec3d& gradient, double weight);

} // namespace vdb_shell::growth

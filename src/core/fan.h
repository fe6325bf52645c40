// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/orient3d_filter.h"

#include <openvdb/Types.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace vdb_shell
{

/// The triangles (apex, rim[i], rim[i+1]) of a closed fan, the last one back to rim[0]. Points are
/// float32 values held as doubles. What is said of it holds for certain; false, or a bit that is
/// not set, tells nothing.
class Fan
{
public:
    static constexpr std::size_t kMost = 24;
    /// From the apex to the rim, by axis.
    using Spokes = std::array<std::array<double, kMost + 4>, 3>;

    /// rim(i) is point i of `count` of the rim. Precondition: 3 <= count <= kMost.
    template <class Rim> Fan(const openvdb::Vec3d& apex, std::size_t count, const Rim& rim)
    {
        set(apex, count, rim);
    }
    /// One that is to be set.
    Fan() {}
    template <class Rim> void set(const openvdb::Vec3d& apex, std::size_t count, const Rim& rim)
    {
        count_ = count;
        for (std::size_t i = 0; i < count; ++i) {
            const openvdb::Vec3d& p = rim(i);
            for (int k = 0; k < 3; ++k)
                spoke_[std::size_t(k)][i] = p[k] - apex[k];
        }
        for (std::array<double, kMost + 4>& of_axis : spoke_)
            for (std::size_t i = 0; i < 4; ++i)
                of_axis[count + i] = of_axis[0];
    }

    /// The triangles meet each other in their common corners and edges only: seen along some
    /// direction they lie side by side around the apex, once (docs/theory.md, "Fans").
    bool surely_embedded() const;
    /// A bit for each triangle that has only the apex in common with triangle i.
    std::uint32_t surely_apart_from(std::size_t i) const;

private:
    std::size_t count_;
    Spokes spoke_; ///< the last is followed by the first, as often as lanes need it
};

/// Fan::surely_embedded for as many triangles as there may be: the same tests, one after the other.
/// A vertex of a hundred thousand triangles has too many pairs for exact tests of each.
template <class Rim>
bool large_fan_surely_embedded(const openvdb::Vec3d& apex, std::size_t count, const Rim& rim)
{
    const auto spoke = [&](std::size_t i) -> openvdb::Vec3d {
        return rim(i < count ? i : 0) - apex;
    };
    openvdb::Vec3d sum(0.0);
    for (std::size_t i = 0; i < count; ++i)
        sum += spoke(i).cross(spoke(i + 1));
    const auto k = int(openvdb::math::MaxIndex(openvdb::math::Abs(sum))), j = (k + 1) % 3;
    const auto below = [&](const openvdb::Vec3d& s) { return s[j] * sum[k] - s[k] * sum[j] < 0; };
    std::size_t rises = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const openvdb::Vec3d u = spoke(i), w = spoke(i + 1);
        // The margin of Fan::surely_embedded.
        if (exact::certain_triple_sign(sum, u, w, 3 * exact::kOrientError) <= 0)
            return false;
        rises += below(u) && !below(w);
    }
    return rises == 1;
}

} // namespace vdb_shell

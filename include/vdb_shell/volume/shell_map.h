// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/shell_stack.h"

#include <openvdb/Types.h>
#include <openvdb/math/BBox.h>
#include <openvdb/math/Mat3.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace vdb_shell
{

/// A place in a shell, the same in all its poses. In a prism it is given by the triangle's corners
/// and the way from the outer to the inner triangle, else by the corners of a tet.
struct ShellPlace {
    static constexpr std::uint32_t kNone = ~std::uint32_t(0);

    std::uint32_t tet = kNone;   ///< of the tets that the map was made of
    std::uint32_t prism = kNone; ///< layer * triangles + triangle; kNone: linear in the tet
    /// Of the prism: weights of its triangle's three corners, and the share of the way inwards. Of
    /// the tet: weights of its corners.
    openvdb::Vec4d weight{0.0};

    bool found() const { return tet != kNone; }
};

/// What a place is on the surface: where it is above, and how deep.
struct SurfacePlace {
    std::uint32_t triangle = ShellPlace::kNone; ///< kNone in a core
    openvdb::Vec3d weight{0.0};                 ///< of the triangle's corners
    std::uint32_t layer = 0;
    double share = 0; ///< of the way through the layer: 0 on its outer surface, 1 on its inner one
};

/// The map between a shell and space, prism by prism: a point of the triangle, moved along the
/// pillars' interpolated ways. Within a prism it is smooth, and it does not depend on diagonals, so
/// that no borders of tets show. It is one-to-one where the Jacobian is positive in all prisms, as
/// it is where all twelve tets are (docs/theory.md, "Coordinates of a shell"). In other prisms,
/// which are counted, and in a core it is linear in each tet.
class ShellMap
{
public:
    /// `tets`: those of make_tets of the stack, or joined_tets of them and a core.
    ShellMap(const ShellStack& stack, TetMesh tets);

    friend void make_linear_alike(ShellMap& a, ShellMap& b);

    const TetMesh& tets() const { return tets_; }
    std::size_t triangles() const { return triangles_; }
    std::size_t layers() const { return triangles_ == 0 ? 0 : corners_.size() / triangles_; }
    /// Prisms that have tets; of them, those with a Jacobian that is not positive throughout.
    std::size_t prisms() const { return prisms_; }
    std::size_t linear_prisms() const { return linear_prisms_; }

    /// Whether the tet holds the point, to a billionth of its size.
    bool holds(std::uint32_t tet, const openvdb::Vec3d& point) const;

    /// The place of a point that the tet holds. A point beside a curved side may lie in the prism
    /// of the neighbour, to which the place then belongs; or, where that is linear in its tets,
    /// beyond the side of its own prism, with a negative weight.
    ShellPlace place_in(std::uint32_t tet, const openvdb::Vec3d& point) const;

    /// The same of a point that the tet may or may not hold: not found where it does not.
    ShellPlace find_in(std::uint32_t tet, const openvdb::Vec3d& point) const;

    /// By tet: whether a box around one of the prisms that places found by place_in(tet) may lie in
    /// passes `meets`, which is asked by several threads at once: its own, and those that are not
    /// more than kMostPrisms - 1 sides away. Of a tet of a core its own box.
    std::vector<std::uint8_t>
    tets_that(const std::function<bool(const openvdb::BBoxd&)>& meets) const;

    /// Of a place of this shell in any pose. Precondition: found().
    openvdb::Vec3d point_of(const ShellPlace& place) const;
    /// The derivatives of point_of by the place's coordinates: weights of the triangle's corners 1
    /// and 2 and the share inwards, or weights of the tet's corners 1, 2 and 3.
    openvdb::Mat3d jacobian_of(const ShellPlace& place) const;
    SurfacePlace on_surface(const ShellPlace& place) const;

private:
    using Corners = std::array<openvdb::Vec3s, 6>; ///< three outer, three inner

    /// In which a place is looked for, one beside the other. A curved side is crossed once, or
    /// twice near a corner; where a pillar is turned far against narrow triangles, more often.
    static constexpr int kMostPrisms = 4;

    void count_prisms();
    ShellPlace linear_place(std::uint32_t tet, const openvdb::Vec4d& weight) const;
    ShellPlace place_of(std::uint32_t tet, const openvdb::Vec4d& weight,
                        const openvdb::Vec3d& point) const;
    std::vector<std::uint8_t> with_prisms_beside(std::vector<std::uint8_t> prism) const;
    openvdb::Vec4d tet_weights(std::uint32_t tet, const openvdb::Vec3d& point) const;

    TetMesh tets_;
    std::size_t triangles_ = 0, prisms_ = 0, linear_prisms_ = 0;
    std::vector<Corners> corners_;       ///< by prism
    std::vector<std::uint8_t> has_tets_; ///< by prism
    std::vector<std::uint8_t> curved_;   ///< by prism
    std::vector<openvdb::Vec3I> beyond_; ///< by triangle: that across the side opposite each corner
    /// By tet and corner: a bit for each corner of the prism that is this point.
    std::vector<std::array<std::uint8_t, 4>> corner_bits_;
};

/// Of the same shell in two poses: makes each linear where the other is, so that a point that goes
/// from one to the other comes back to where it was, but for points between a curved side and the
/// flat one of a linear prism beside it. Precondition: as many prisms.
void make_linear_alike(ShellMap& a, ShellMap& b);

} // namespace vdb_shell

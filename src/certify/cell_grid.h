// SPDX-License-Identifier: Apache-2.0
#pragma once

// A uniform grid of cells over a bounding box, made so that float32 points, triangles and tets can
// be matched with cells without ever missing one.

#include "vdb_shell/mesh/triangle_mesh.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Inclusive ranges of cells by axis.
struct CellRange {
    std::array<std::uint32_t, 3> first{}, last{};
};

/// Cell (i,j,k) is the closed box between neighbouring planes. Planes are float32: a point that is
/// drawn between two planes stays between them when it is rounded to float32, as rounding is
/// monotone.
struct CellGrid {
    std::array<std::vector<float>, 3> planes;
    openvdb::Vec3d low{0.0}, step{0.0};

    std::uint32_t count(std::size_t axis) const
    {
        return static_cast<std::uint32_t>(planes[axis].size() - 1);
    }
    std::size_t cells() const { return std::size_t(count(0)) * count(1) * count(2); }
    std::size_t columns() const { return std::size_t(count(0)) * count(1); }
    /// Cells of one vertical column stand together, from low to high z.
    std::uint32_t cell(std::uint32_t i, std::uint32_t j, std::uint32_t k) const
    {
        return (i * count(1) + j) * count(2) + k;
    }
    std::uint32_t column_of(std::uint32_t cell_index) const { return cell_index / count(2); }
    std::array<std::uint32_t, 3> position_of(std::uint32_t cell_index) const
    {
        const std::uint32_t column = column_of(cell_index);
        return {column / count(1), column % count(1), cell_index % count(2)};
    }
    /// The point of the cell at the fractions `unit` in [0,1) of its edges, rounded to float32.
    openvdb::Vec3s point_in(std::uint32_t cell_index, const openvdb::Vec3d& unit) const;
    /// All cells whose closed box meets the closed box. Precondition: it lies inside the grid.
    CellRange overlapped(const openvdb::Vec3s& box_low, const openvdb::Vec3s& box_high) const;
};

/// About `cells` (at most) nearly cubic cells, at most 1024 along an axis.
CellGrid make_cell_grid(const Bounds& bounds, std::size_t cells);

/// Intersection of at most five half-spaces, tested against boxes conservatively: it may keep a box
/// that it does not meet, but never loses one that it meets.
class HalfSpaces
{
public:
    /// The tet; `sign` is that of its orientation, not 0. `span` bounds all distances in the grid.
    static HalfSpaces of_tet(const std::array<openvdb::Vec3s, 4>& corners, int sign, double span);
    static HalfSpaces of_triangle(const std::array<openvdb::Vec3s, 3>& corners, double span);

    bool may_meet(const openvdb::Vec3d& centre, const openvdb::Vec3d& half_size) const
    {
        for (std::size_t i = 0; i < count_; ++i) {
            const Plane& plane = planes_[i];
            const openvdb::Vec3d& n = plane.outward;
            const double reach = std::abs(n[0]) * half_size[0] + std::abs(n[1]) * half_size[1] +
                                 std::abs(n[2]) * half_size[2] + plane.slack;
            if (n.dot(centre - plane.point) > reach)
                return false;
        }
        return true;
    }

private:
    struct Plane {
        openvdb::Vec3d point{0.0}, outward{0.0};
        double slack = 0; ///< far above the rounding error of the test
    };
    void add(const openvdb::Vec3d& point, const openvdb::Vec3d& outward, double size, double span);

    std::array<Plane, 5> planes_;
    std::size_t count_ = 0;
};

/// visit(cell index) for each cell of the range that `shape` may meet, by halving the range.
template <typename Visit>
void visit_cells(const CellGrid& grid, const CellRange& range, const HalfSpaces& shape,
                 const Visit& visit)
{
    openvdb::Vec3d centre, half_size;
    std::size_t longest = 0;
    std::uint32_t longest_extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<int>(axis);
        const double low = grid.planes[axis][range.first[axis]];
        const double high = grid.planes[axis][range.last[axis] + 1];
        centre[a] = 0.5 * (low + high);
        half_size[a] = 0.5 * (high - low);
        if (range.last[axis] - range.first[axis] > longest_extent) {
            longest = axis;
            longest_extent = range.last[axis] - range.first[axis];
        }
    }
    if (!shape.may_meet(centre, half_size))
        return;
    if (longest_extent == 0) {
        visit(grid.cell(range.first[0], range.first[1], range.first[2]));
        return;
    }
    CellRange lower = range, upper = range;
    lower.last[longest] = range.first[longest] + longest_extent / 2;
    upper.first[longest] = lower.last[longest] + 1;
    visit_cells(grid, lower, shape, visit);
    visit_cells(grid, upper, shape, visit);
}

} // namespace vdb_shell

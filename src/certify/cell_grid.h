// SPDX-License-Identifier: Apache-2.0
#pragma once

// A uniform grid of cells over a bounding box, made so that float32 points, triangles and tets can
// be matched with cells without ever missing one.

#include "vdb_shell/mesh/triangle_mesh.h"

#include <algorithm>
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

    /// The heights at which the column [low, high], of x and y, may meet: shortens [bottom, top];
    /// false when there are none. Both ends count by themselves: a box that holds them both, in
    /// whatever order, meets each half-space for all that is known.
    bool clip_column(const std::array<double, 2>& low, const std::array<double, 2>& high,
                     double& bottom, double& top) const
    {
        for (std::size_t i = 0; i < count_; ++i) {
            const Plane& plane = planes_[i];
            const openvdb::Vec3d& n = plane.outward;
            // The column's deepest place in the half-space at the height of the plane's point.
            const double depth = n[0] * ((n[0] > 0 ? low[0] : high[0]) - plane.point[0]) +
                                 n[1] * ((n[1] > 0 ? low[1] : high[1]) - plane.point[1]) -
                                 plane.slack;
            if (n[2] > 0)
                top = std::min(top, plane.point[2] - depth / n[2] + height_slack_);
            else if (n[2] < 0)
                bottom = std::max(bottom, plane.point[2] - depth / n[2] - height_slack_);
            else if (depth > 0)
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
    double height_slack_ = 0; ///< the same for a height
};

/// Shortens the run of cells [first, last] of the column (i, j), counted from the lowest, to those
/// that `shape` may meet; false when there are none.
inline bool clip_run(const CellGrid& grid, std::uint32_t i, std::uint32_t j,
                     const HalfSpaces& shape, std::uint32_t& first, std::uint32_t& last)
{
    const std::vector<float>&x = grid.planes[0], &y = grid.planes[1], &z = grid.planes[2];
    double bottom = z[first], top = z[last + 1];
    if (!shape.clip_column({x[i], y[j]}, {x[i + 1], y[j + 1]}, bottom, top))
        return false;
    while (first <= last && z[first + 1] < bottom)
        ++first;
    while (first < last && z[last] > top)
        --last;
    return first <= last && z[last] <= top;
}

/// visit(first, last) for each run of cells, one above the other, of the range that `shape` may
/// meet.
template <typename Visit>
void visit_runs(const CellGrid& grid, const CellRange& range, const HalfSpaces& shape,
                const Visit& visit)
{
    for (std::uint32_t i = range.first[0]; i <= range.last[0]; ++i)
        for (std::uint32_t j = range.first[1]; j <= range.last[1]; ++j) {
            std::uint32_t first = range.first[2], last = range.last[2];
            if (clip_run(grid, i, j, shape, first, last))
                visit(grid.cell(i, j, first), grid.cell(i, j, last));
        }
}

} // namespace vdb_shell

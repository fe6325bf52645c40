// SPDX-License-Identifier: Apache-2.0

// Takes: a closed surface and a grid of cells around it. Gives: which cells lie inside, which
// outside, and which the surface may pass through; and whether a single point is inside, exactly. A
// point in a cell of the first two kinds needs no test of its own. One in a cell of the third kind
// is decided by the crossings of a vertical ray with the triangles of its column alone. Inside is
// where the winding number is not nought, so a surface that crosses itself has an inside as well.
// Cells are listed by triangle in parallel, and put together in index order.

#include "certify/solid_cells.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "core/sort_unique.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;

std::array<Vec3s, 3> corners_of(const TriangleMesh& surface, std::size_t triangle)
{
    const openvdb::Vec3I& t = surface.triangles[triangle];
    return {surface.points[t[0]], surface.points[t[1]], surface.points[t[2]]};
}

std::vector<std::vector<std::uint32_t>> cells_by_triangle(const CellGrid& grid,
                                                          const TriangleMesh& surface, double span)
{
    std::vector<std::vector<std::uint32_t>> cells(surface.triangles.size());
    for_each_index(cells.size(), [&](std::size_t t) {
        const std::array<Vec3s, 3> p = corners_of(surface, t);
        using openvdb::math::maxComponent;
        using openvdb::math::minComponent;
        const CellRange range = grid.overlapped(minComponent(minComponent(p[0], p[1]), p[2]),
                                                maxComponent(maxComponent(p[0], p[1]), p[2]));
        visit_runs(grid, range, HalfSpaces::of_triangle(p, span),
                   [&](std::uint32_t first, std::uint32_t last) {
                       for (std::uint32_t cell = first; cell <= last; ++cell)
                           cells[t].push_back(cell);
                   });
    });
    return cells;
}

Shadow shadow_of(const TriangleMesh& surface, std::uint32_t triangle)
{
    const std::array<Vec3s, 3> p = corners_of(surface, triangle);
    return {std::min({p[0][0], p[1][0], p[2][0]}), std::max({p[0][0], p[1][0], p[2][0]}),
            std::min({p[0][1], p[1][1], p[2][1]}), std::max({p[0][1], p[1][1], p[2][1]}),
            std::max({p[0][2], p[1][2], p[2][2]}), triangle};
}

/// Lists the triangles of each column of cells. A vertical line meets a triangle only in cells that
/// the triangle meets, so the columns of those cells are all that matter. Cells are closed: a
/// triangle that ends on the plane between two columns is listed in both.
void list_columns(const CellGrid& grid, const TriangleMesh& surface,
                  std::vector<std::vector<std::uint32_t>> cells, SolidCells& result)
{
    result.column_offset.assign(grid.columns() + 1, 0);
    for_each_index(cells.size(), [&](std::size_t t) {
        std::vector<std::uint32_t>& columns = cells[t];
        for (std::uint32_t& cell : columns)
            cell = grid.column_of(cell);
        sort_unique(columns);
    });
    for (const std::vector<std::uint32_t>& columns : cells)
        for (const std::uint32_t column : columns)
            ++result.column_offset[column + 1];
    for (std::size_t c = 0; c < grid.columns(); ++c)
        result.column_offset[c + 1] += result.column_offset[c];
    result.column_shadow.resize(result.column_offset.back());
    std::vector<std::uint32_t> next(result.column_offset.begin(), result.column_offset.end() - 1);
    for (std::size_t t = 0; t < cells.size(); ++t) {
        const Shadow shadow = shadow_of(surface, static_cast<std::uint32_t>(t));
        for (const std::uint32_t column : cells[t])
            result.column_shadow[next[column]++] = shadow;
    }
}

} // namespace

SolidCells classify_cells(const CellGrid& grid, const TriangleMesh& surface)
{
    double span = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        span += double(grid.planes[axis].back()) - grid.planes[axis].front();
    SolidCells result;
    result.kind.assign(grid.cells(), CellKind::outside);
    std::vector<std::vector<std::uint32_t>> cells = cells_by_triangle(grid, surface, span);
    for (const std::vector<std::uint32_t>& of_triangle : cells)
        for (const std::uint32_t cell : of_triangle)
            result.kind[cell] = CellKind::surface;
    list_columns(grid, surface, std::move(cells), result);
    for_each_index(grid.columns(), [&](std::size_t column) {
        // Cells one above the other that the surface does not touch lie on the same side of it, as
        // they have a common face: one exact test is enough for each run of them. Columns do not
        // depend on each other.
        bool known = false, inside = false;
        for (std::uint32_t k = 0; k < grid.count(2); ++k) {
            const auto cell = static_cast<std::uint32_t>(column * grid.count(2) + k);
            if (result.kind[cell] == CellKind::surface) {
                known = false;
                continue;
            }
            if (!known) {
                const Vec3s middle = grid.point_in(cell, openvdb::Vec3d(0.5));
                inside = inside_solid(result, surface, static_cast<std::uint32_t>(column), middle);
                known = true;
            }
            if (inside)
                result.kind[cell] = CellKind::inside;
        }
    });
    return result;
}

bool inside_solid(const SolidCells& cells, const TriangleMesh& surface, std::uint32_t column,
                  const Vec3s& point)
{
    int winding = 0;
    bool on_surface = false;
    for (std::uint32_t i = cells.column_offset[column]; i < cells.column_offset[column + 1]; ++i) {
        const Shadow& shadow = cells.column_shadow[i];
        if (shadow.high_x < point[0] || shadow.low_x > point[0] || shadow.high_y < point[1] ||
            shadow.low_y > point[1] || shadow.high_z < point[2])
            continue;
        const std::array<Vec3s, 3> p = corners_of(surface, shadow.triangle);
        winding += exact::crossing_above(point, p[0], p[1], p[2], on_surface);
    }
    return winding != 0 && !on_surface;
}

} // namespace vdb_shell

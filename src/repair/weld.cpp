// SPDX-License-Identifier: Apache-2.0

// Takes triangles by index and makes points of equal position one, or points within a tolerance:
// each becomes the first point within it that stands for itself. So no point moves by more than the
// tolerance, and chains of near points do not run together, as they would if nearness were passed
// on. Near points are found in a grid of cells as wide as the tolerance, in 27 of them around each
// point. Points that are no longer used stay in the list, so that indices keep their meaning for
// the report, until the repair is done.

#include "repair/working_surface.h"

#include "core/stage_stop.h"
#include "mesh/equal_points.h"
#include "mesh/surface_defects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using Cell = std::array<std::int64_t, 3>;

Cell cell_of(const openvdb::Vec3s& point, double size)
{
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis)
        cell[std::size_t(axis)] = static_cast<std::int64_t>(std::floor(double(point[axis]) / size));
    return cell;
}

/// Cells as wide as the tolerance, but no more of them along an axis than an integer can number:
/// cells may be wider than the tolerance, they then just hold more points.
double cell_size(const std::vector<openvdb::Vec3s>& points, double tolerance)
{
    constexpr double kMostCells = 1e18; // under 2^60
    double farthest = 0;
    for (const openvdb::Vec3s& point : points)
        for (int axis = 0; axis < 3; ++axis)
            farthest = std::max(farthest, std::abs(double(point[axis])));
    return std::max(tolerance, farthest / kMostCells);
}

/// For each point the first point within the tolerance that stands for itself. Only such points are
/// put into the grid, which is why a point is never compared with one that has become another.
std::vector<std::uint32_t> first_near_point(const std::vector<openvdb::Vec3s>& points,
                                            double tolerance)
{
    std::map<Cell, std::vector<std::uint32_t>> grid;
    const double size = cell_size(points, tolerance);
    std::vector<std::uint32_t> first(points.size());
    for (std::uint32_t v = 0; v < points.size(); ++v) {
        stop_if_stage_wants(v);
        const Cell cell = cell_of(points[v], size);
        first[v] = v;
        for (std::int64_t i = 0; i < 27; ++i) {
            const auto entry =
                grid.find({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1});
            if (entry == grid.end())
                continue;
            for (const std::uint32_t u : entry->second)
                if (u < first[v] && (Vec3d(points[u]) - Vec3d(points[v])).length() <= tolerance)
                    first[v] = u;
        }
        if (first[v] == v)
            grid[cell].push_back(v);
    }
    return first;
}

} // namespace

void drop_triangles(WorkingSurface& surface, const std::vector<char>& drop)
{
    std::size_t kept = 0;
    for (std::size_t t = 0; t < drop.size(); ++t) {
        if (drop[t])
            continue;
        surface.mesh.triangles[kept] = surface.mesh.triangles[t];
        surface.source[kept++] = surface.source[t];
    }
    surface.mesh.triangles.resize(kept);
    surface.source.resize(kept);
}

void add_sources(Defect<std::uint32_t>& defect, const WorkingSurface& surface,
                 const std::vector<char>& marked)
{
    for (std::size_t t = 0; t < marked.size(); ++t)
        if (marked[t] && surface.source[t] != kNoSource)
            add_to(defect, surface.source[t]);
}

void weld_points(WorkingSurface& surface, double tolerance, RepairReport& report)
{
    const std::vector<openvdb::Vec3s>& points = surface.mesh.points;
    const std::vector<std::uint32_t> first =
        tolerance > 0 ? first_near_point(points, tolerance) : first_equal_point(points);
    for (std::uint32_t v = 0; v < first.size(); ++v)
        if (first[v] != v)
            add_to(report.welded_points, v);
    std::vector<char> drop(surface.mesh.triangles.size());
    for (std::uint32_t t = 0; t < drop.size(); ++t) {
        Vec3I& corner = surface.mesh.triangles[t];
        bool moved = false;
        for (int k = 0; k < 3; ++k) {
            // Welding points of one position changes indices only, and such a triangle is the
            // input's as before.
            moved |= points[corner[k]] != points[first[corner[k]]];
            corner[k] = first[corner[k]];
        }
        drop[t] = corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
        if (drop[t])
            add_to(report.collapsed, t);
        if (moved)
            surface.source[t] = kNoSource;
    }
    drop_triangles(surface, drop);
}

} // namespace vdb_shell::repair

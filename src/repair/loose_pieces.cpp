// SPDX-License-Identifier: Apache-2.0

// Takes a surface whose holes have been filled where a fill was found, and finds the small pieces
// that are open still: single triangles that hang on a point or float, as scanners leave them. They
// bound no solid, no fill closes them, for a fill without new points is the piece once more, and
// they may stand in the way of the fills of larger holes. A body's part may be small and open too,
// so they are dropped on request only, and every triangle is counted.

#include "mesh/components.h"
#include "mesh/triangle_area.h"
#include "repair/working_surface.h"

#include <algorithm>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3I;

// Shares of the area of the whole surface. What is open and larger is taken for a part of the
// object; and where so much is loose altogether, the object may be made of it.
constexpr double kLoose = 0.01, kLooseTogether = 0.25;

bool left_open(const HoleFill& hole)
{
    return hole.method == FillMethod::none;
}

double area_of(const TriangleMesh& mesh, const std::vector<char>& marked)
{
    double area = 0;
    for (std::size_t t = 0; t < marked.size(); ++t)
        area += marked[t] ? triangle_area(mesh.points, mesh.triangles[t]) : 0;
    return area;
}

/// A point that no triangle has any more is in nobody's way, and nobody need be moved from it.
void forget_unused(WorkingSurface& surface)
{
    std::vector<char> used(surface.mesh.points.size());
    for (const Vec3I& t : surface.mesh.triangles)
        for (int k = 0; k < 3; ++k)
            used[t[k]] = 1;
    for (std::vector<std::uint32_t>& place : surface.copies)
        place.erase(
            std::remove_if(place.begin(), place.end(), [&](std::uint32_t v) { return !used[v]; }),
            place.end());
    surface.copies.erase(std::remove_if(surface.copies.begin(), surface.copies.end(),
                                        [](const auto& place) { return place.size() < 2; }),
                         surface.copies.end());
}

} // namespace

std::vector<char> loose_triangles(const TriangleMesh& mesh)
{
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    const std::vector<std::uint32_t> component_of =
        component_of_triangles(uses, mesh.triangles.size());
    std::vector<char> at_rim(mesh.triangles.size());
    mark_rims(uses, at_rim);
    std::vector<double> area;
    std::vector<char> open;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::size_t piece = component_of[t];
        if (piece >= area.size()) {
            area.resize(piece + 1);
            open.resize(piece + 1);
        }
        area[piece] += triangle_area(mesh.points, mesh.triangles[t]);
        open[piece] |= at_rim[t];
    }
    const double most = kLoose * surface_area(mesh.points, mesh.triangles);
    std::vector<char> loose(mesh.triangles.size());
    for (std::size_t t = 0; t < loose.size(); ++t)
        loose[t] = open[component_of[t]] && area[component_of[t]] < most;
    return loose;
}

bool drop_loose_pieces(WorkingSurface& surface, bool wanted, RepairReport& report)
{
    // Those that are left may have been cut out since.
    if (!report.loose_dropped)
        report.loose = {};
    std::vector<HoleFill>& holes = report.holes;
    if (std::none_of(holes.begin(), holes.end(), left_open))
        return false;
    const std::vector<char> loose = loose_triangles(surface.mesh);
    if (area_of(surface.mesh, loose) >
        kLooseTogether * surface_area(surface.mesh.points, surface.mesh.triangles))
        return false;
    add_sources(report.loose, surface, loose);
    if (!wanted || std::find(loose.begin(), loose.end(), char(1)) == loose.end())
        return false;
    drop_triangles(surface, loose);
    forget_unused(surface);
    // Those that are not gone with their piece are tried again.
    holes.erase(std::remove_if(holes.begin(), holes.end(), left_open), holes.end());
    report.loose_dropped = true;
    return true;
}

} // namespace vdb_shell::repair

// SPDX-License-Identifier: Apache-2.0

// Takes a surface whose holes have been filled where a fill was found, and finds the small pieces
// that are open still: single triangles that hang on a point or float, as scanners leave them. They
// bound no solid, no fill closes them, for a fill without new points is the piece once more, and
// they may stand in the way of the fills of larger holes. A body's part may be small and open too,
// so they are dropped on request only, and every triangle is counted.

#include "mesh/components.h"
#include "mesh/surface_defects.h"
#include "repair/working_surface.h"

#include <algorithm>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// Shares of the area of the whole surface. What is open and larger is taken for a part of the
// object; and where so much is loose altogether, the object may be made of it.
constexpr double kLoose = 0.01, kLooseTogether = 0.25;

bool left_open(const HoleFill& hole)
{
    return hole.method == FillMethod::none;
}

/// Areas are only compared with each other.
double twice_area(const TriangleMesh& mesh, std::size_t t)
{
    const Vec3I& corner = mesh.triangles[t];
    const Vec3d a(mesh.points[corner[0]]);
    return (Vec3d(mesh.points[corner[1]]) - a).cross(Vec3d(mesh.points[corner[2]]) - a).length();
}

double share_of(const TriangleMesh& mesh, const std::vector<char>& marked)
{
    double all = 0, some = 0;
    for (std::size_t t = 0; t < marked.size(); ++t) {
        const double twice = twice_area(mesh, t);
        all += twice;
        some += marked[t] ? twice : 0;
    }
    return all > 0 ? some / all : 0;
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
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh.triangles);
    const std::vector<std::uint32_t> component_of =
        component_of_triangles(uses, mesh.triangles.size());
    std::vector<double> area;
    double all = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const double twice = twice_area(mesh, t);
        if (component_of[t] >= area.size())
            area.resize(component_of[t] + 1);
        area[component_of[t]] += twice;
        all += twice;
    }
    std::vector<char> open(area.size());
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin == 1)
            open[component_of[uses[begin].triangle]] = 1;
    }
    std::vector<char> loose(mesh.triangles.size());
    for (std::size_t t = 0; t < loose.size(); ++t)
        loose[t] = open[component_of[t]] && area[component_of[t]] < kLoose * all;
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
    if (share_of(surface.mesh, loose) > kLooseTogether)
        return false;
    for (std::size_t t = 0; t < loose.size(); ++t)
        if (loose[t] && surface.source[t] != kNoSource)
            add_to(report.loose, surface.source[t]);
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

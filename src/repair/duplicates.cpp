// SPDX-License-Identifier: Apache-2.0

// Takes triangles of which some have the same three points, whichever way they run, and leaves at
// most one of each. Whether one stays is a question of parity: an edge of a closed surface has an
// even number of triangles, so a repeat is kept if most of its edges need it for that, and a
// partition that two closed bodies have in common goes altogether. All edges are counted before
// anything goes, so the result does not depend on the order in which the groups are taken. The trap
// is that a neighbour which is repeated itself counts each time, so that a region which is there
// twice can go altogether.

#include "repair/working_surface.h"

#include "mesh/surface_defects.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace vdb_shell::repair
{
namespace
{

using Corners = std::array<std::uint32_t, 3>;

Corners sorted_corners(const openvdb::Vec3I& triangle)
{
    Corners corners{triangle[0], triangle[1], triangle[2]};
    std::sort(corners.begin(), corners.end());
    return corners;
}

} // namespace

void drop_duplicates(WorkingSurface& surface, RepairReport& report)
{
    const std::vector<openvdb::Vec3I>& triangles = surface.mesh.triangles;
    std::map<Corners, std::vector<std::uint32_t>> groups;
    std::map<Edge, std::size_t> uses;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const Corners c = sorted_corners(triangles[t]);
        groups[c].push_back(t);
        ++uses[{c[0], c[1]}], ++uses[{c[1], c[2]}], ++uses[{c[0], c[2]}];
    }
    std::vector<char> drop(triangles.size());
    bool any = false;
    for (const auto& [c, group] : groups) {
        if (group.size() == 1)
            continue;
        // The other triangles at an edge are an odd number where one of this group is needed to
        // close it. With three edges there is always a majority.
        int wanted = 0;
        for (const Edge& edge : {Edge{c[0], c[1]}, Edge{c[1], c[2]}, Edge{c[0], c[2]}})
            wanted += (uses.at(edge) - group.size()) % 2 == 1 ? 1 : -1;
        for (std::size_t i = wanted > 0 ? 1 : 0; i < group.size(); ++i) {
            drop[group[i]] = 1;
            any = true;
        }
    }
    if (!any)
        return;
    for (std::uint32_t t = 0; t < drop.size(); ++t)
        if (drop[t])
            add_to(report.duplicates, surface.source[t]);
    drop_triangles(surface, drop);
}

} // namespace vdb_shell::repair

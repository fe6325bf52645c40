// SPDX-License-Identifier: Apache-2.0

// Takes triangles that meet anyhow and makes neighbours run through their common edge opposite
// ways. Two steps: sheets that bound no solid, such as a partition inside a body or a fin on it,
// are removed, since an edge with three triangles has no pair of neighbours to agree; then in each
// piece, which is what hangs together by edges of two triangles, as few triangles as possible are
// turned. Whether a whole piece is inside out is decided after the holes are closed, when it has an
// inside. Parity is the idea of the first step: a surface that bounds a solid has an even number of
// triangles at each edge.

#include "mesh/orientation.h"
#include "mesh/surface_defects.h"
#include "mesh/triangle_area.h"
#include "repair/working_surface.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// An edge that has not just two triangles, with how often each piece uses it. Pieces end at such
/// edges, so these are all their rims.
struct BadEdge {
    std::size_t uses = 0;
    std::map<std::uint32_t, std::size_t> by_piece;
};

std::vector<BadEdge> bad_edges(const std::vector<EdgeUse>& uses,
                               const std::vector<std::uint32_t>& piece_of)
{
    std::vector<BadEdge> bad;
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin == 2)
            continue;
        bad.emplace_back();
        bad.back().uses = end - begin;
        for (std::size_t i = begin; i < end; ++i)
            ++bad.back().by_piece[piece_of[uses[i].triangle]];
    }
    return bad;
}

/// Whether `piece` hangs on the rest and every fault of its rim goes with it: each edge of the rim
/// has an odd number of triangles, and an even one without the piece. An open piece that meets no
/// other is no sheet but a surface with a hole.
bool is_sheet(const std::vector<BadEdge>& bad, std::uint32_t piece)
{
    bool hangs = false;
    for (const BadEdge& edge : bad) {
        const auto entry = edge.by_piece.find(piece);
        if (entry == edge.by_piece.end())
            continue;
        if (edge.uses % 2 == 0 || (edge.uses - entry->second) % 2 == 1)
            return false;
        hangs |= edge.uses > 2;
    }
    return hangs;
}

} // namespace

void drop_sheets(WorkingSurface& surface, RepairReport& report)
{
    // A share of the area of what is there at the time. A piece with more than that is taken for a
    // part of the object, not for a sheet on it.
    constexpr double kLargestShare = 0.25;
    for (bool dropped = true; dropped;) {
        dropped = false;
        const TriangleMesh& mesh = surface.mesh;
        const std::vector<EdgeUse> uses = sorted_edge_uses(mesh.triangles);
        const Orientation pieces = consistent_orientation(uses, mesh.triangles.size());
        const std::vector<BadEdge> bad = bad_edges(uses, pieces.piece_of);
        std::vector<double> area(pieces.one_sided.size());
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            area[pieces.piece_of[t]] += triangle_area(mesh.points, mesh.triangles[t]);
        const double all = std::accumulate(area.begin(), area.end(), 0.0);
        std::vector<std::uint32_t> smallest_first(area.size());
        std::iota(smallest_first.begin(), smallest_first.end(), 0U);
        std::stable_sort(smallest_first.begin(), smallest_first.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return area[a] < area[b]; });
        // One sheet at a time, as its loss may join pieces or mend the rims of others, and the
        // smallest first, since of two pieces that would each do the smaller loss is the better
        // one. Each turn removes triangles, so this ends.
        for (const std::uint32_t piece : smallest_first) {
            if (area[piece] > kLargestShare * all || !is_sheet(bad, piece))
                continue;
            std::vector<char> drop(mesh.triangles.size());
            for (std::size_t t = 0; t < drop.size(); ++t) {
                drop[t] = pieces.piece_of[t] == piece;
                if (drop[t] && surface.source[t] != kNoSource)
                    add_to(report.sheets, surface.source[t]);
            }
            drop_triangles(surface, drop);
            dropped = true;
            break;
        }
    }
}

void orient(WorkingSurface& surface, RepairReport& report)
{
    std::vector<Vec3I>& triangles = surface.mesh.triangles;
    const Orientation orientation =
        consistent_orientation(sorted_edge_uses(triangles), triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        // A turned triangle keeps its source: its coordinates are the input's.
        if (!orientation.turn[t])
            continue;
        std::swap(triangles[t][1], triangles[t][2]);
        if (surface.source[t] != kNoSource)
            add_to(report.turned, surface.source[t]);
    }
}

} // namespace vdb_shell::repair

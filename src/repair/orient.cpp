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
    bool changed = false; ///< a piece of it goes
};

std::vector<BadEdge> bad_edges(const EdgeUses& uses, const std::vector<std::uint32_t>& piece_of)
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

/// The bad edges that each piece has.
std::vector<std::vector<std::uint32_t>> edges_by_piece(const std::vector<BadEdge>& bad,
                                                       std::size_t pieces)
{
    std::vector<std::vector<std::uint32_t>> edges(pieces);
    for (std::uint32_t e = 0; e < bad.size(); ++e)
        for (const auto& [piece, uses] : bad[e].by_piece)
            edges[piece].push_back(e);
    return edges;
}

/// Whether `piece` hangs on the rest and every fault of its rim goes with it: each edge of the rim
/// has an odd number of triangles, and an even one without the piece. An open piece that meets no
/// other is no sheet but a surface with a hole.
bool is_sheet(const std::vector<BadEdge>& bad, const std::vector<std::uint32_t>& edges,
              std::uint32_t piece)
{
    bool hangs = false;
    for (const std::uint32_t e : edges) {
        const BadEdge& edge = bad[e];
        if (edge.changed || edge.uses % 2 == 0 || (edge.uses - edge.by_piece.at(piece)) % 2 == 1)
            return false;
        hangs |= edge.uses > 2;
    }
    return hangs;
}

/// The pieces, smallest first, and their areas.
struct PiecesBySize {
    std::vector<double> area;
    std::vector<std::uint32_t> order;
    double all = 0;
};

PiecesBySize pieces_by_size(const TriangleMesh& mesh, const Orientation& pieces)
{
    PiecesBySize sizes;
    sizes.area.resize(pieces.one_sided.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        sizes.area[pieces.piece_of[t]] += triangle_area(mesh.points, mesh.triangles[t]);
    sizes.all = std::accumulate(sizes.area.begin(), sizes.area.end(), 0.0);
    sizes.order.resize(sizes.area.size());
    std::iota(sizes.order.begin(), sizes.order.end(), 0U);
    std::stable_sort(sizes.order.begin(), sizes.order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return sizes.area[a] < sizes.area[b];
    });
    return sizes;
}

/// Sheets that can be told at one look, by triangle. The smallest first, since of two pieces that
/// would each do the smaller loss is the better one. The loss of a sheet may join pieces or mend
/// the rims of others, so what has an edge with it waits for the next look.
std::vector<char> find_sheets(const TriangleMesh& mesh)
{
    // A share of the area of what is there at the time. A piece with more than that is taken for a
    // part of the object, not for a sheet on it.
    constexpr double kLargestShare = 0.25;
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    const Orientation pieces = consistent_orientation(uses, mesh.triangles.size());
    std::vector<BadEdge> bad = bad_edges(uses, pieces.piece_of);
    const auto edges = edges_by_piece(bad, pieces.one_sided.size());
    const PiecesBySize sizes = pieces_by_size(mesh, pieces);
    std::vector<char> sheet(sizes.area.size());
    double left = sizes.all;
    for (const std::uint32_t piece : sizes.order) {
        if (sizes.area[piece] > kLargestShare * left || !is_sheet(bad, edges[piece], piece))
            continue;
        sheet[piece] = 1;
        left -= sizes.area[piece];
        for (const std::uint32_t e : edges[piece])
            bad[e].changed = true;
    }
    std::vector<char> drop(mesh.triangles.size());
    for (std::size_t t = 0; t < drop.size(); ++t)
        drop[t] = sheet[pieces.piece_of[t]];
    return drop;
}

} // namespace

void drop_sheets(WorkingSurface& surface, const StageProgress& progress, RepairReport& report)
{
    // Each look but the last drops triangles, so this ends; sheets that come to light one by one
    // would take as many looks, and this bounds the time. What is left then is found by the check.
    constexpr int kMostLooks = 200;
    for (int look = 0; look < kMostLooks; ++look) {
        progress.stop_if_interrupted(0);
        const std::vector<char> drop = find_sheets(surface.mesh);
        if (std::find(drop.begin(), drop.end(), char(1)) == drop.end())
            return;
        add_sources(report.sheets, surface, drop);
        drop_triangles(surface, drop);
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

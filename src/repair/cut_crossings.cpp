// SPDX-License-Identifier: Apache-2.0

// Takes a surface whose other faults are mended and removes the triangles that touch or cross
// others, so that the holes which this leaves can be filled without a crossing. Contacts are
// decided exactly on the float32 points. Unlike the other steps this one changes the shape, so it
// is done on request only, and every triangle of the input that goes is counted. The trap is that a
// fill may cross something in its turn: therefore the cut grows from round to round, and the caller
// bounds the number of rounds.

#include "core/triangle_pairs.h"
#include "mesh/surface_defects.h"
#include "mesh/triangle_contacts.h"
#include "repair/working_surface.h"

#include <algorithm>
#include <atomic>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// Marks all triangles with a corner in common with a marked one. The points are marked first and
/// the triangles afterwards: in a single pass a new mark could spread on to later triangles, and
/// the width of the ring would depend on the order of the triangles.
void add_ring(const TriangleMesh& mesh, std::vector<char>& marked)
{
    std::vector<char> points(mesh.points.size());
    for (std::size_t t = 0; t < marked.size(); ++t)
        for (int k = 0; k < 3 && marked[t]; ++k)
            points[mesh.triangles[t][k]] = 1;
    for (std::size_t t = 0; t < marked.size(); ++t)
        for (int k = 0; k < 3; ++k)
            marked[t] |= points[mesh.triangles[t][k]];
}

} // namespace

/// Triangles that cross or touch another one. The exact test is defined for triangles with an area
/// only, so one without area is marked together with everything that its box meets. A pair of which
/// both are marked already is neither tested nor sought, which saves most where much crosses; that
/// a triangle crosses something does not depend on which pair shows it first.
std::vector<char> crossing_triangles(const TriangleMesh& mesh, Interrupter* interrupter)
{
    const std::vector<char> flat = find_degenerate(mesh.points, mesh.triangles);
    const TriangleContacts contacts(mesh.points, mesh.triangles);
    std::vector<std::atomic<bool>> crossing(mesh.triangles.size());
    const auto marked = [&](std::uint32_t t) {
        return crossing[t].load(std::memory_order_relaxed);
    };
    const auto mark = [&](std::uint32_t first, std::uint32_t second) {
        if (marked(first) && marked(second))
            return false;
        if (flat[first] || flat[second] || contacts.touch(first, second)) {
            crossing[first].store(true, std::memory_order_relaxed);
            crossing[second].store(true, std::memory_order_relaxed);
        }
        return false; // no list of the pairs is wanted
    };
    PairBounds wanted;
    wanted.settled = marked;
    overlapping_triangles(mesh.points, mesh.triangles, mark, wanted, interrupter);
    return {crossing.begin(), crossing.end()};
}

void mark_rims(const EdgeUses& uses, std::vector<char>& marked)
{
    // The uses of one edge stand together; a single one is a rim.
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin == 1)
            marked[uses[begin].triangle] = 1;
    }
}

bool cut_crossings(WorkingSurface& surface, int round, RepairReport& report,
                   Interrupter* interrupter)
{
    std::vector<char> drop = crossing_triangles(surface.mesh, interrupter);
    // A rim that the last round has left belongs to a hole for which no fill was found. It needs
    // more room as well.
    if (round > 0)
        mark_rims(sorted_edge_uses(surface.mesh.triangles), drop);
    if (std::find(drop.begin(), drop.end(), char(1)) == drop.end())
        return false;
    // No ring in the first two rounds, one in the third, two in the fourth and so on: a wider cut
    // leaves a fill more room, but also less of the shape.
    for (int ring = 0; ring + 1 < round; ++ring)
        add_ring(surface.mesh, drop);
    add_sources(report.cut, surface, drop);
    drop_triangles(surface, drop);
    // What the cut has severed: closing it would leave a small body of its own beside the object.
    drop = loose_triangles(surface.mesh);
    add_sources(report.cut, surface, drop);
    drop_triangles(surface, drop);
    return true;
}

} // namespace vdb_shell::repair

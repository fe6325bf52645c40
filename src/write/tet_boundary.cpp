// SPDX-License-Identifier: Apache-2.0

// Takes: tets. Gives: the triangles that bound them, and between shell and core, with what each
// belongs to: solvers put conditions on these. Indices alone are compared, so it holds for inverted
// tets too. Faces are sorted by their corners, by buckets of the smallest: nearly linear time, and
// the order does not depend on threads, as the comparison tells all faces apart.

#include "write/tet_boundary.h"

#include "core/bucket_sort.h"
#include "core/parallel.h"
#include "shell/tet_faces.h"
#include "vdb_shell/shell/core_tets.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace vdb_shell
{
namespace
{

struct Side {
    std::array<std::uint32_t, 3> corners; ///< ascending
    std::uint32_t tet;
    std::uint8_t opposite; ///< the tet's corner that is none of the face
};

Side side_of(const TetMesh& tets, std::uint32_t tet, std::uint8_t opposite)
{
    return {ascending_corners(tet_face(tets.tets[tet], opposite)), tet, opposite};
}

/// All sides of all tets; those of a face stand together, in the order of their tets.
std::vector<Side> sorted_sides(const TetMesh& tets)
{
    std::vector<Side> sides(4 * tets.tets.size());
    for_each_index(
        tets.tets.size(),
        [&](std::size_t t) {
            for (std::uint8_t corner = 0; corner < 4; ++corner)
                sides[4 * t + corner] = side_of(tets, std::uint32_t(t), corner);
        },
        1024);
    return bucket_sort<Side>(
        std::array{std::move(sides)}, tets.points.size(),
        [](const Side& side) { return side.corners[0]; },
        [](const Side& x, const Side& y) {
            return std::tie(x.corners[1], x.corners[2], x.tet, x.opposite) <
                   std::tie(y.corners[1], y.corners[2], y.tet, y.opposite);
        });
}

bool of_core(const TetMesh& tets, const Side& side)
{
    return tets.prism_layer[side.tet] == kCoreLayer;
}

/// The pinned corners of an inner triangle are points of the outermost surface, so only triangles
/// with nothing else are part of that.
TetBoundary boundary_at(const TetMesh& tets, const Side& side)
{
    const bool outer = std::all_of(side.corners.begin(), side.corners.end(),
                                   [&](std::uint32_t p) { return tets.layer[p] == 0; });
    if (outer)
        return TetBoundary::outer;
    return of_core(tets, side) ? TetBoundary::hole : TetBoundary::inner;
}

} // namespace

const NameTable<TetBoundary>& names(TetBoundary)
{
    static const NameTable<TetBoundary> table{
        {"outer", TetBoundary::outer}, {"inner", TetBoundary::inner}, {"hole", TetBoundary::hole}};
    return table;
}

std::vector<BoundaryTriangle> boundary_of(const TetMesh& tets)
{
    const std::vector<Side> sides = sorted_sides(tets);
    std::vector<Side> found;
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        while (last < sides.size() && sides[last].corners == sides[first].corners)
            ++last;
        // The tets of a core stand behind those of the shell.
        const bool between =
            last - first == 2 && !of_core(tets, sides[first]) && of_core(tets, sides[first + 1]);
        if (last - first == 1 || between)
            found.push_back(sides[first]);
    }
    std::sort(found.begin(), found.end(), [](const Side& x, const Side& y) {
        return std::tie(x.tet, x.opposite) < std::tie(y.tet, y.opposite);
    });
    std::vector<BoundaryTriangle> boundary;
    boundary.reserve(found.size());
    for (const Side& side : found)
        boundary.push_back(
            {tet_face(tets.tets[side.tet], side.opposite), side.tet, boundary_at(tets, side)});
    return boundary;
}

} // namespace vdb_shell

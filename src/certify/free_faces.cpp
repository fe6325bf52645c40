// SPDX-License-Identifier: Apache-2.0

// Takes: a stack and its tets. Gives: the faces of one tet only, the outer triangles among them,
// and what hangs together. It compares indices only. Faces are sorted by their corners, by buckets
// of the smallest: nearly linear time, and the order does not depend on threads, as the comparison
// tells all faces apart.

#include "certify/free_faces.h"

#include "vdb_shell/shell/shared_points.h"

#include "core/bucket_sort.h"
#include "core/disjoint_sets.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;

/// A face of a tet, or an outer triangle.
struct Side {
    std::array<std::uint32_t, 3> corners; ///< ascending
    bool outer;
    std::uint32_t owner; ///< tet or triangle
    std::uint8_t local;  ///< of a tet: the corner opposite
};

bool operator<(const Side& x, const Side& y)
{
    return std::tie(x.corners, x.outer, x.owner, x.local) <
           std::tie(y.corners, y.outer, y.owner, y.local);
}

/// The outer triangles by points; outer vertices that no tet has are added to the points.
void append_outer(const ShellStack& stack, const TetMesh& tets, FreeFaces& free)
{
    const std::vector<openvdb::Vec3s>& outer = stack.surface(0);
    const std::vector<std::uint32_t> first = first_places(stack);
    constexpr std::uint32_t kNone = ~std::uint32_t(0);
    // Places on the outermost surface come first, so a point that an outer vertex has belongs to
    // a place of this surface.
    std::vector<std::uint32_t> point(outer.size(), kNone);
    for (std::uint32_t p = 0; p < tets.points.size(); ++p)
        if (tets.layer[p] == 0)
            point[tets.source_vertex[p]] = p;
    for (const Vec3I& triangle : stack.triangles()) {
        Vec3I face;
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& at = point[first[triangle[k]]];
            if (at == kNone) {
                at = static_cast<std::uint32_t>(free.points.size());
                free.points.push_back(outer[triangle[k]]);
            }
            face[k] = at;
        }
        free.faces.push_back(face);
    }
    free.outer_count = free.faces.size();
    free.tet.assign(free.outer_count, FreeFaces::kNoTet);
}

std::vector<Side> sorted_sides(const FreeFaces& free, const TetMesh& tets)
{
    std::vector<Side> sides;
    sides.reserve(4 * tets.tets.size() + free.faces.size());
    for (std::uint32_t i = 0; i < tets.tets.size(); ++i)
        for (std::uint8_t corner = 0; corner < 4; ++corner)
            sides.push_back({ascending_corners(tet_face(tets.tets[i], corner)), false, i, corner});
    for (std::uint32_t t = 0; t < free.faces.size(); ++t)
        sides.push_back({ascending_corners(free.faces[t]), true, t, 0});
    const auto smallest_corner = [](const Side& side) { return side.corners[0]; };
    return bucket_sort<Side>(std::array{std::move(sides)}, free.points.size(), smallest_corner,
                             std::less<>());
}

} // namespace

FreeFaces find_free_faces(const ShellStack& stack, const TetMesh& tets)
{
    FreeFaces free;
    free.points = tets.points;
    append_outer(stack, tets, free);
    const std::vector<Side> sides = sorted_sides(free, tets);
    DisjointSets pieces(tets.tets.size());
    std::vector<std::array<std::uint32_t, 2>> alone; // tet, corner opposite
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        while (last < sides.size() && sides[last].corners == sides[first].corners)
            ++last;
        const auto outer = std::find_if(sides.begin() + std::ptrdiff_t(first),
                                        sides.begin() + std::ptrdiff_t(last),
                                        [](const Side& side) { return side.outer; }) -
                           sides.begin();
        const std::size_t owners = std::size_t(outer) - first;
        for (std::size_t i = first + 1; i < first + owners; ++i)
            pieces.join(sides[first].owner, sides[i].owner);
        if (owners != 1)
            continue;
        if (std::size_t(outer) < last)
            free.tet[sides[std::size_t(outer)].owner] = sides[first].owner;
        else
            alone.push_back({sides[first].owner, sides[first].local});
    }
    std::sort(alone.begin(), alone.end());
    for (const auto& [tet, corner] : alone) {
        free.faces.push_back(tet_face(tets.tets[tet], corner));
        free.tet.push_back(tet);
    }
    for (std::uint32_t i = 0; i < tets.tets.size(); ++i)
        free.piece.push_back(pieces.root_of(i));
    return free;
}

std::vector<std::uint32_t> first_faces_of_pieces(const FreeFaces& free)
{
    struct Use {
        std::array<std::uint32_t, 2> edge;
        std::uint32_t face;
    };
    std::vector<Use> uses;
    for (std::uint32_t f = 0; f < free.faces.size(); ++f)
        if (free.tet[f] != FreeFaces::kNoTet)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = free.faces[f][k], b = free.faces[f][(k + 1) % 3];
                uses.push_back({{std::min(a, b), std::max(a, b)}, f});
            }
    uses = bucket_sort<Use>(
        std::array{std::move(uses)}, free.points.size(), [](const Use& use) { return use.edge[0]; },
        [](const Use& x, const Use& y) {
            return std::tie(x.edge[1], x.face) < std::tie(y.edge[1], y.face);
        });
    DisjointSets pieces(free.faces.size());
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
        while (last < uses.size() && uses[last].edge == uses[first].edge)
            ++last;
        if (last - first == 2)
            pieces.join(uses[first].face, uses[first + 1].face);
    }
    std::vector<std::uint32_t> firsts;
    for (std::uint32_t f = 0; f < free.faces.size(); ++f)
        if (free.tet[f] != FreeFaces::kNoTet && pieces.root_of(f) == f)
            firsts.push_back(f);
    return firsts;
}

} // namespace vdb_shell

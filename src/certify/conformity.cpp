// SPDX-License-Identifier: Apache-2.0

// Takes: tets, and the shell or the stack that they were made of. Gives: every face that has other
// than two sides, a free face that is no triangle of a free surface, and a triangle that no tet
// has. It compares indices only, so it says nothing of space and holds for inverted tets as well;
// it is a second way to what the certificate finds at edges (docs/theory.md, "Splits"), by the tets
// that are written and not by the orders that they were made from. All sides of all faces are
// sorted, by buckets of their smallest corner: nearly linear time. The comparison tells all
// different sides apart, so the order does not depend on how threads sorted the buckets. They are
// gone through in parts, by that corner: all at once they would take more memory than the shell.

#include "vdb_shell/certify/conformity.h"

#include "core/sort_unique.h"
#include "vdb_shell/shell/shared_points.h"

#include "core/bucket_sort.h"
#include "core/parallel.h"
#include "core/stage_stop.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <tuple>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;

/// One side of a face. The two surfaces are given sides of their own, turned away from the shell,
/// so that in a conforming mesh every face has exactly two, of opposite turn.
struct FaceSide {
    std::array<std::uint32_t, 3> corners; ///< ascending
    std::uint32_t owner;                  ///< tet, or triangle of the surface
    bool of_surface;
    bool even; ///< whether ascending order is an even permutation of the outward order
};

/// Compares sides that have the same smallest corner: the bucket sort has separated them by it
/// before. Tets come before surfaces, as judge_face expects, and two corners are compared as one
/// 64-bit number.
bool operator<(const FaceSide& x, const FaceSide& y)
{
    const auto pair = [](std::uint64_t high, std::uint64_t low) { return high << 32U | low; };
    const std::uint64_t x_face = pair(x.corners[1], x.corners[2]),
                        y_face = pair(y.corners[1], y.corners[2]);
    return x_face != y_face
               ? x_face < y_face
               : std::tie(x.of_surface, x.owner, x.even) < std::tie(y.of_surface, y.owner, y.even);
}

FaceSide side_of(const Vec3I& face, std::uint32_t owner, bool of_surface)
{
    FaceSide side{{face[0], face[1], face[2]}, owner, of_surface, true};
    auto order = [&](std::size_t i, std::size_t j) {
        if (side.corners[i] <= side.corners[j])
            return;
        std::swap(side.corners[i], side.corners[j]);
        side.even = !side.even;
    };
    // Three exchanges sort three corners, and each of them turns the permutation from even to odd
    // or back.
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return side;
}

/// The two free surfaces of a shell or of a stack.
struct FreeSurfaces {
    const std::vector<Vec3I>* triangles;
    std::size_t vertices, layers;
    std::vector<std::uint32_t> first; ///< by place: the first that shares its point
    bool tapered;

    std::uint32_t outer(std::uint32_t vertex) const { return first[vertex]; }
    std::uint32_t inner(std::uint32_t vertex) const { return first[layers * vertices + vertex]; }
    /// A vertex that is pinned in some layers and not in others has two different ends.
    bool pinned(std::uint32_t vertex) const { return outer(vertex) == inner(vertex); }
};

FreeSurfaces free_surfaces(const PrismShell* layers, std::size_t count, bool tapered)
{
    return {&layers->triangles, layers->outer.size(), count, first_places(layers, count, tapered),
            tapered};
}

/// By place the point of the tets that stands for it. A place without one gets a number beyond all
/// points, so that no face of a tet has it.
std::vector<std::uint32_t> index_points(const FreeSurfaces& free, const TetMesh& mesh)
{
    const auto points = static_cast<std::uint32_t>(mesh.points.size());
    std::vector<std::uint32_t> index(free.first.size());
    std::iota(index.begin(), index.end(), points);
    for (std::uint32_t p = 0; p < points; ++p)
        if (mesh.source_vertex[p] < free.vertices && mesh.layer[p] <= free.layers)
            index[mesh.layer[p] * free.vertices + mesh.source_vertex[p]] = p;
    return index;
}

/// The owners of offending faces. The count is of faces, and the list names each owner once,
/// however many of its faces offend.
class Offenders
{
public:
    void add(std::uint32_t owner) { owners_.push_back(owner); }
    void add(const Offenders& others)
    {
        owners_.insert(owners_.end(), others.owners_.begin(), others.owners_.end());
    }
    Defect<std::uint32_t> listed()
    {
        Defect<std::uint32_t> defect;
        defect.count = owners_.size();
        sort_unique(owners_);
        owners_.resize(std::min(owners_.size(), Defect<std::uint32_t>::kFirstShown));
        defect.first = owners_;
        return defect;
    }

private:
    std::vector<std::uint32_t> owners_;
};

struct Findings {
    Offenders crowded, misoriented, stray, missing;

    void add(const Findings& others)
    {
        crowded.add(others.crowded);
        misoriented.add(others.misoriented);
        stray.add(others.stray);
        missing.add(others.missing);
    }
};

/// Sides whose smallest corner is one of some points; `last` is the one after them.
struct SidesFrom {
    std::uint32_t first, last;
    std::vector<FaceSide> sides;

    void add(const Vec3I& face, std::uint32_t owner, bool of_surface)
    {
        const std::uint32_t smallest = std::min({face[0], face[1], face[2]});
        if (first <= smallest && smallest < last)
            sides.push_back(side_of(face, owner, of_surface));
    }
};

/// The sides that the surfaces should find a tet at on triangle t. One with three pinned corners
/// has no prism: its outer and inner triangle are one, and no tet is expected there.
void add_surface_sides(const FreeSurfaces& free, const std::vector<std::uint32_t>& index,
                       std::uint32_t t, SidesFrom& part)
{
    const auto outer = [&](std::uint32_t v) { return index[free.outer(v)]; };
    const auto inner = [&](std::uint32_t v) { return index[free.inner(v)]; };
    const Vec3I& v = (*free.triangles)[t];
    if (free.pinned(v[0]) && free.pinned(v[1]) && free.pinned(v[2]))
        return;
    // Each side is given as seen from outside of what owns it. The surfaces own what is not shell,
    // so the outer triangle is turned round and the inner one is not.
    part.add({outer(v[0]), outer(v[2]), outer(v[1])}, t, true);
    const Vec3I below(inner(v[0]), inner(v[1]), inner(v[2]));
    // Where vertices share their inner point, there is no inner triangle.
    if (below[0] != below[1] && below[1] != below[2] && below[2] != below[0])
        part.add(below, t, true);
}

/// Triangles of the free surfaces with the same corners that face each other bound nothing: either
/// two tets meet there, or none are there. Gives the end of those that are left.
FaceSide* without_opposite(FaceSide* first, FaceSide* last)
{
    const auto evens = std::count_if(first, last, [](const FaceSide& s) { return s.even; });
    const auto odds = (last - first) - evens;
    std::stable_partition(first, last, [&](const FaceSide& s) { return s.even == (evens > odds); });
    return first + std::abs(evens - odds);
}

/// `first` to `last`: all sides of one face, tets before surfaces.
void judge_face(FaceSide* first, FaceSide* last, bool tapered, Findings& findings)
{
    FaceSide* surface =
        std::find_if(first, last, [](const FaceSide& side) { return side.of_surface; });
    if (tapered)
        last = without_opposite(surface, last);
    const auto tets = surface - first, surfaces = last - surface;
    // The owner of the first side is the tet of the smallest index, as sides are sorted by it.
    if (tets >= 3)
        findings.crowded.add(first->owner);
    if (tets == 1 && surfaces == 0)
        findings.stray.add(first->owner);
    const bool paired = (tets == 2 && surfaces == 0) || (tets == 1 && surfaces >= 1);
    if (paired && first[0].even == first[1].even)
        findings.misoriented.add(first->owner);
    // Every surface triangle needs a free face of its own. With one tet and a surface the first of
    // the surfaces has it; any more of them, and all where two tets share the face, have none.
    for (const FaceSide* side = surface + (tets == 1 && surfaces >= 1 ? 1 : 0); side < last; ++side)
        findings.missing.add(side->owner);
}

// Tets, or sides of faces, that one thread takes at a time: a millisecond's work.
constexpr std::size_t kInBlock = 1 << 15;

std::size_t blocks_of(std::size_t count)
{
    return (count + kInBlock - 1) / kInBlock;
}

/// The least and the greatest corner of the tets of each block.
std::vector<std::array<std::uint32_t, 2>> corners_of_blocks(const TetMesh& mesh)
{
    std::vector<std::array<std::uint32_t, 2>> corners(blocks_of(mesh.tets.size()));
    for_each_index(
        corners.size(),
        [&](std::size_t block) {
            auto& [least, greatest] = corners[block] = {~0U, 0U};
            const std::size_t end = std::min(mesh.tets.size(), (block + 1) * kInBlock);
            for (std::size_t i = block * kInBlock; i < end; ++i)
                for (int k = 0; k < 4; ++k) {
                    least = std::min(least, mesh.tets[i][k]);
                    greatest = std::max(greatest, mesh.tets[i][k]);
                }
        },
        1);
    return corners;
}

/// What parts of the sides are listed from.
struct AllSides {
    const FreeSurfaces& free;
    const TetMesh& mesh;
    std::vector<std::uint32_t> index;                        ///< index_points
    std::vector<std::array<std::uint32_t, 2>> block_corners; ///< corners_of_blocks
};

/// All sides whose smallest corner is one of points first to last - 1, sorted.
std::vector<FaceSide> sorted_sides(const AllSides& all, std::uint32_t first, std::uint32_t last)
{
    const std::size_t tets = all.mesh.tets.size(), triangles = all.free.triangles->size();
    std::vector<std::vector<FaceSide>> found(blocks_of(std::max(tets, triangles)));
    for_each_index(
        found.size(),
        [&](std::size_t block) {
            SidesFrom part{first, last, {}};
            const std::size_t begin = block * kInBlock, end = begin + kInBlock;
            // Where near tets have near numbers most blocks have nothing in most parts.
            const bool any = block < all.block_corners.size() &&
                             all.block_corners[block][0] < last &&
                             all.block_corners[block][1] >= first;
            for (std::size_t i = begin; any && i < std::min(end, tets); ++i)
                for (std::size_t corner = 0; corner < 4; ++corner)
                    part.add(tet_face(all.mesh.tets[i], corner), static_cast<std::uint32_t>(i),
                             false);
            for (std::size_t t = begin; t < std::min(end, triangles); ++t)
                add_surface_sides(all.free, all.index, static_cast<std::uint32_t>(t), part);
            found[block] = std::move(part.sides);
        },
        1);
    stop_if_stage_wants();
    return bucket_sort<FaceSide>(
        found, last - first, [&](const FaceSide& side) { return side.corners[0] - first; },
        std::less<>());
}

void judge_sides(std::vector<FaceSide> sides, bool tapered, Findings& findings)
{
    const auto begins_face = [&](std::size_t i) {
        return i == 0 || sides[i].corners != sides[i - 1].corners;
    };
    const auto end_of_face = [&](std::size_t i, std::size_t end) {
        while (i < end && !begins_face(i))
            ++i;
        return i;
    };
    // A block has the faces that begin in it.
    std::vector<Findings> found(blocks_of(sides.size()));
    std::vector<std::size_t> begins(found.size());
    for_each_index(
        found.size(),
        [&](std::size_t block) { begins[block] = end_of_face(block * kInBlock, sides.size()); }, 1);
    begins.push_back(sides.size());
    for_each_index(
        found.size(),
        [&](std::size_t block) {
            for (std::size_t i = begins[block], next = i; i < begins[block + 1]; i = next) {
                // No farther, for the next block may turn its sides round already.
                next = end_of_face(i + 1, begins[block + 1]);
                judge_face(sides.data() + i, sides.data() + next, tapered, found[block]);
            }
        },
        1);
    for (const Findings& of_block : found)
        findings.add(of_block);
}

Conformity judge(const FreeSurfaces& free, const TetMesh& mesh, std::size_t most_sides)
{
    Findings findings;
    const AllSides all{free, mesh, index_points(free, mesh), corners_of_blocks(mesh)};
    const std::size_t sides = 4 * mesh.tets.size() + 2 * free.triangles->size(),
                      parts = 1 + sides / most_sides,
                      // Places without a point have numbers beyond all points.
        points = mesh.points.size() + free.first.size(),
                      points_of_part = 1 + mesh.points.size() / parts;
    for (std::size_t first = 0, last = 0; first < points; first = last) {
        // The last part has all numbers beyond the points too, of which hardly any are used.
        last = first + points_of_part < mesh.points.size() ? first + points_of_part : points;
        judge_sides(
            sorted_sides(all, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)),
            free.tapered, findings);
    }
    return {findings.crowded.listed(), findings.misoriented.listed(), findings.stray.listed(),
            findings.missing.listed()};
}

} // namespace

Conformity check_conformity(const PrismShell& shell, const TetMesh& mesh, std::size_t most_sides)
{
    return judge(free_surfaces(&shell, 1, false), mesh, most_sides);
}

Conformity check_conformity(const ShellStack& stack, const TetMesh& mesh, std::size_t most_sides)
{
    return judge(free_surfaces(stack.layers.data(), stack.layers.size(), stack.tapered), mesh,
                 most_sides);
}

} // namespace vdb_shell

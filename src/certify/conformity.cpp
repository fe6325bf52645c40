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

/// The sides that the surfaces should find a tet at. A triangle with three pinned corners has no
/// prism: its outer and inner triangle are one, and no tet is expected there.
void add_surface_sides(const FreeSurfaces& free, const std::vector<std::uint32_t>& index,
                       SidesFrom& part)
{
    const auto outer = [&](std::uint32_t v) { return index[free.outer(v)]; };
    const auto inner = [&](std::uint32_t v) { return index[free.inner(v)]; };
    for (std::uint32_t t = 0; t < free.triangles->size(); ++t) {
        const Vec3I& v = (*free.triangles)[t];
        if (free.pinned(v[0]) && free.pinned(v[1]) && free.pinned(v[2]))
            continue;
        // Each side is given as seen from outside of what owns it. The surfaces own what is not
        // shell, so the outer triangle is turned round and the inner one is not.
        part.add({outer(v[0]), outer(v[2]), outer(v[1])}, t, true);
        const Vec3I below(inner(v[0]), inner(v[1]), inner(v[2]));
        // Where vertices share their inner point, there is no inner triangle.
        if (below[0] != below[1] && below[1] != below[2] && below[2] != below[0])
            part.add(below, t, true);
    }
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

void judge_part(const FreeSurfaces& free, const std::vector<std::uint32_t>& index,
                const TetMesh& mesh, SidesFrom part, Findings& findings)
{
    for (std::uint32_t i = 0; i < mesh.tets.size(); ++i)
        for (std::size_t corner = 0; corner < 4; ++corner)
            part.add(tet_face(mesh.tets[i], corner), i, false);
    add_surface_sides(free, index, part);
    stop_if_stage_wants();
    const auto smallest_corner = [&](const FaceSide& side) { return side.corners[0] - part.first; };
    std::vector<FaceSide> sides = bucket_sort<FaceSide>(
        std::array{std::move(part.sides)}, part.last - part.first, smallest_corner, std::less<>());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        while (last < sides.size() && sides[last].corners == sides[first].corners)
            ++last;
        judge_face(sides.data() + first, sides.data() + last, free.tapered, findings);
    }
}

Conformity judge(const FreeSurfaces& free, const TetMesh& mesh, std::size_t most_sides)
{
    Findings findings;
    const std::vector<std::uint32_t> index = index_points(free, mesh);
    const std::size_t sides = 4 * mesh.tets.size() + 2 * free.triangles->size(),
                      parts = 1 + sides / most_sides,
                      // Places without a point have numbers beyond all points.
        points = mesh.points.size() + free.first.size(),
                      points_of_part = 1 + mesh.points.size() / parts;
    for (std::size_t first = 0, last = 0; first < points; first = last) {
        // The last part has all numbers beyond the points too, of which hardly any are used.
        last = first + points_of_part < mesh.points.size() ? first + points_of_part : points;
        SidesFrom part{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last), {}};
        // Parts have about as many sides each, and a vector that grows is copied.
        part.sides.reserve(sides / parts + sides / (8 * parts));
        judge_part(free, index, mesh, std::move(part), findings);
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

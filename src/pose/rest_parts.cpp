// SPDX-License-Identifier: Apache-2.0

// Takes a shell at rest. Gives what every frame of it needs: which points are the skin's, the maps
// from which distortion is measured, the tets around each point, and sets of points that have no
// tet in common, so that those of a set can move at the same time.

#include "pose/rest_parts.h"

#include "vdb_shell/shell/shared_points.h"

#include "mesh/topology.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Parts = RestShell::Parts;

/// Gradients of the barycentric coordinates; those of a flat tet are 0, and it counts for nothing.
RestTet rest_tet(const std::vector<Vec3d>& points, const openvdb::Vec4I& tet)
{
    const Vec3d a = points[tet[0]], b = points[tet[1]] - a, c = points[tet[2]] - a,
                d = points[tet[3]] - a;
    const double volume = b.dot(c.cross(d));
    RestTet made;
    for (Vec3d& gradient : made.gradient)
        gradient = Vec3d(0.0);
    if (!(volume > 0))
        return made;
    made.gradient[1] = c.cross(d) / volume;
    made.gradient[2] = d.cross(b) / volume;
    made.gradient[3] = b.cross(c) / volume;
    made.gradient[0] = -(made.gradient[1] + made.gradient[2] + made.gradient[3]);
    return made;
}

/// The list of each point, one behind the other: add(k, into) calls into(point) for entry k.
template <typename Add>
void list_by_point(std::size_t points, std::size_t entries, const Add& add,
                   std::vector<std::uint32_t>& first, std::vector<std::uint32_t>& list)
{
    first.assign(points + 1, 0);
    for (std::size_t k = 0; k < entries; ++k)
        add(k, [&](std::uint32_t point, std::uint32_t) { ++first[point + 1]; });
    for (std::size_t p = 0; p < points; ++p)
        first[p + 1] += first[p];
    list.resize(first[points]);
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t k = 0; k < entries; ++k)
        add(k, [&](std::uint32_t point, std::uint32_t value) { list[next[point]++] = value; });
}

void place_points(Parts& parts)
{
    const std::size_t vertices = parts.stack.surface(0).size();
    parts.first_place = first_places(parts.stack);
    parts.point_of_place.assign(parts.first_place.size(), Parts::kFree);
    for (std::size_t p = 0; p < parts.tets.points.size(); ++p)
        parts.point_of_place[parts.tets.layer[p] * vertices + parts.tets.source_vertex[p]] =
            static_cast<std::uint32_t>(p);
    parts.skin_vertex.assign(parts.rest.size(), Parts::kFree);
    for (std::size_t v = 0; v < vertices; ++v) {
        const std::uint32_t point =
            parts.point_of_place[parts.first_place[parts.stack.skin * vertices + v]];
        if (point != Parts::kFree)
            parts.skin_vertex[point] = static_cast<std::uint32_t>(v);
    }
    for (std::size_t i = 0; i < parts.core.points.size(); ++i)
        parts.skin_vertex[parts.tets.points.size() + i] = parts.core.source_vertex[i];
    list_by_point(
        parts.rest.size(), parts.first_place.size(),
        [&](std::size_t place, const auto& into) {
            const std::uint32_t point = parts.point_of_place[parts.first_place[place]];
            if (point != Parts::kFree)
                into(point, static_cast<std::uint32_t>(place % vertices));
        },
        parts.first_source, parts.source);
}

/// First fit by point index.
void colour_points(Parts& parts)
{
    std::vector<int> colour(parts.rest.size(), -1);
    std::vector<std::uint32_t> taken_for;
    for (std::uint32_t p = 0; p < parts.rest.size(); ++p) {
        if (parts.skin_vertex[p] != Parts::kFree)
            continue;
        for (std::uint32_t k = parts.first[p]; k < parts.first[p + 1]; ++k)
            for (int i = 0; i < 4; ++i) {
                const int other = colour[parts.all[parts.incident[k]][i]];
                if (other >= 0)
                    taken_for[static_cast<std::size_t>(other)] = p;
            }
        std::size_t c = 0;
        while (c < taken_for.size() && taken_for[c] == p)
            ++c;
        if (c == taken_for.size()) {
            taken_for.push_back(Parts::kFree);
            parts.colour.emplace_back();
        }
        colour[p] = static_cast<int>(c);
        parts.colour[c].push_back(p);
    }
}

void list_neighbours(Parts& parts)
{
    const EdgeUses uses = sorted_edge_uses(parts.stack.triangles());
    for (std::size_t i = 1; i < uses.size(); ++i)
        if (uses[i].edge == uses[i - 1].edge)
            parts.neighbours.push_back({uses[i - 1].triangle, uses[i].triangle});
}

/// How a free face leaves one of its edges: at which angle around it, and whether the tet behind
/// the face is on the side where angles grow.
struct Leaf {
    std::uint32_t face;
    double angle;
    bool tet_beyond;
};
Leaf leaf_at(const Parts& parts, const EdgeUse& use)
{
    const openvdb::Vec3I& face = parts.free.faces[use.triangle];
    const openvdb::Vec4I& tet = parts.all[parts.free.tet[use.triangle]];
    const auto at = [&](std::uint32_t p) { return Vec3d(parts.free.points[p]); };
    const Vec3d from = at(use.edge[0]), along = (at(use.edge[1]) - from).unitSafe();
    // The same two axes for all faces of the edge.
    const Vec3d u = along.cross(std::abs(along[0]) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)),
                w = along.cross(u);
    const auto third = face[(use.side + 2) % 3];
    std::uint32_t opposite = tet[0];
    for (int k = 0; k < 4; ++k)
        if (tet[k] != face[0] && tet[k] != face[1] && tet[k] != face[2])
            opposite = tet[k];
    const Vec3d leaf = at(third) - from;
    return {use.triangle, std::atan2(w.dot(leaf), u.dot(leaf)),
            leaf.cross(at(opposite) - from).dot(along) > 0};
}

/// Where more than two free faces meet in an edge, those with void between them stand next to each
/// other around it.
void list_neighbour_faces(Parts& parts)
{
    const FreeFaces& free = parts.free;
    const EdgeUses uses = sorted_edge_uses(free.faces);
    std::vector<Leaf> leaves;
    for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
        leaves.clear();
        for (last = first; last < uses.size() && uses[last].edge == uses[first].edge; ++last)
            if (free.tet[uses[last].triangle] != FreeFaces::kNoTet)
                leaves.push_back(leaf_at(parts, uses[last]));
        std::sort(leaves.begin(), leaves.end(), [](const Leaf& x, const Leaf& y) {
            return x.angle != y.angle ? x.angle < y.angle : x.face < y.face;
        });
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            const Leaf &leaf = leaves[i], &next = leaves[(i + 1) % leaves.size()];
            const std::uint32_t f = std::min(leaf.face, next.face),
                                g = std::max(leaf.face, next.face);
            if (!leaf.tet_beyond && next.tet_beyond && free.inner(g) && free.tet[f] != free.tet[g])
                parts.neighbour_faces.push_back({f, g});
        }
    }
}

void list_free_faces(Parts& parts)
{
    if (!parts.stack.tapered || !parts.core.empty())
        return;
    parts.free = find_free_faces(parts.stack, parts.tets);
    for (std::uint32_t f = 0; f < parts.free.faces.size(); ++f)
        parts.triangle_of_face.push_back(parts.free.inner(f) ? parts.tets.prism[parts.free.tet[f]]
                                                             : f);
    list_neighbour_faces(parts);
}

void measure_spacing(Parts& parts)
{
    parts.spacing.assign(parts.rest.size(), 0.0);
    for (std::size_t p = 0; p < parts.rest.size(); ++p) {
        double sum = 0;
        for (std::uint32_t k = parts.first[p]; k < parts.first[p + 1]; ++k)
            for (int i = 0; i < 4; ++i)
                sum += (parts.rest[parts.all[parts.incident[k]][i]] - parts.rest[p]).length();
        parts.spacing[p] = sum / std::max(1.0, 3.0 * (parts.first[p + 1] - parts.first[p]));
    }
}

} // namespace

RestShell::Parts::Parts(ShellStack s, CoreTets c)
    : stack(std::move(s)), core(std::move(c)), tets(make_tets(stack)),
      motion(stack.surface(stack.skin), stack.triangles())
{
    const TetMesh joined = joined_tets(tets, core);
    rest.assign(joined.points.begin(), joined.points.end());
    all = joined.tets;
    rest_tet.reserve(all.size());
    for (const openvdb::Vec4I& tet : all)
        rest_tet.push_back(vdb_shell::rest_tet(rest, tet));
    place_points(*this);
    list_by_point(
        rest.size(), all.size(),
        [&](std::size_t t, const auto& into) {
            for (int i = 0; i < 4; ++i)
                into(all[t][i], static_cast<std::uint32_t>(t));
        },
        first, incident);
    measure_spacing(*this);
    colour_points(*this);
    list_neighbours(*this);
    list_free_faces(*this);
}

RestShell::RestShell(ShellStack stack, CoreTets core)
    : parts_(std::make_unique<const Parts>(std::move(stack), std::move(core)))
{
}
RestShell::~RestShell() = default;
RestShell::RestShell(RestShell&&) noexcept = default;
RestShell& RestShell::operator=(RestShell&&) noexcept = default;

const ShellStack& RestShell::stack() const
{
    return parts_->stack;
}
const CoreTets& RestShell::core() const
{
    return parts_->core;
}
const TetMesh& RestShell::tets() const
{
    return parts_->tets;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Parts a surface into pieces that are connected by edges, and says of each how large it is,
// whether it is closed, how many others enclose it and whether it is inside out. A cavity is a
// closed piece within an odd number of others, and has to be oriented the other way round
// (docs/theory.md, "Remarks"). Whether a piece encloses a point is decided by the parity of exact
// crossings of an upward ray; the winding number would need the orientation, which is what is to be
// found out. Volumes are sums in doubles, whose sign is no proof. One ray from each component is
// held against all triangles at once, by a tree over their boxes; only those that cross or touch
// are compared one by one.

#include "mesh/components.h"

#include "core/box_pairs.h"
#include "core/disjoint_sets.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "core/sort_unique.h"
#include "core/triangle_piece.h"
#include "mesh/equal_points.h"
#include "mesh/exact_volume.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using Indices = std::vector<std::uint32_t>;

/// The triangles of each component, ascending.
std::vector<Indices> triangles_by_component(const Indices& component_of)
{
    std::vector<Indices> result;
    for (std::uint32_t t = 0; t < component_of.size(); ++t) {
        // Components are numbered by their first triangles, so a new number is always the next one.
        if (component_of[t] == result.size())
            result.emplace_back();
        result[component_of[t]].push_back(t);
    }
    return result;
}

/// One sixth of the sum of determinants (the divergence theorem). Points are taken relative to one
/// of the component's own: far from the origin, the determinants would be large, of both signs, and
/// cancel to little more than rounding.
double volume_of(const TriangleMesh& mesh, const Indices& triangles)
{
    const openvdb::Vec3d origin(mesh.points[mesh.triangles[triangles.front()][0]]);
    double six_volumes = 0.0;
    for (const std::uint32_t t : triangles) {
        const openvdb::Vec3I& corner = mesh.triangles[t];
        const openvdb::Vec3d a = openvdb::Vec3d(mesh.points[corner[0]]) - origin;
        const openvdb::Vec3d b = openvdb::Vec3d(mesh.points[corner[1]]) - origin;
        const openvdb::Vec3d c = openvdb::Vec3d(mesh.points[corner[2]]) - origin;
        six_volumes += a.dot(b.cross(c));
    }
    return six_volumes / 6.0;
}

/// How many points each component has, and which points are of several or stand where one of
/// another component stands. Components may have a common point, which counts for each of them:
/// Euler's number is that of a surface by itself.
struct PointFindings {
    std::vector<int> points;
    std::vector<char> shared;
};

PointFindings look_at_points(const TriangleMesh& mesh, const std::vector<Indices>& triangles)
{
    PointFindings found{std::vector<int>(triangles.size()), std::vector<char>(mesh.points.size())};
    Indices counted_for(mesh.points.size(), ~0U), at_place = counted_for; // the last component
    const Indices place =
        triangles.size() > 1 ? first_equal_point(mesh.points) : Indices(mesh.points.size());
    for (std::uint32_t c = 0; c < triangles.size(); ++c)
        for (const std::uint32_t t : triangles[c])
            for (int corner = 0; corner < 3; ++corner) {
                const std::uint32_t v = mesh.triangles[t][corner];
                if (std::exchange(counted_for[v], c) == c)
                    continue;
                ++found.points[c];
                const std::uint32_t before = std::exchange(at_place[place[v]], c);
                found.shared[place[v]] |= char(before != ~0U && before != c);
            }
    for (std::size_t v = 0; v < place.size(); ++v)
        found.shared[v] = found.shared[place[v]];
    return found;
}

/// What the edges say: which components are closed, which run through each edge as often one way
/// as the other (only these have an inside), and how many edges each has.
struct EdgeFindings {
    std::vector<char> closed, balanced;
    std::vector<int> edges;
};

EdgeFindings look_at_edges(const EdgeUses& uses, const Indices& component_of,
                           std::size_t components)
{
    EdgeFindings found{std::vector<char>(components, 1), std::vector<char>(components, 1),
                       std::vector<int>(components, 0)};
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        int forward = 0;
        for (; end < uses.size() && uses[end].edge == uses[begin].edge; ++end)
            forward += uses[end].forward ? 1 : -1;
        if (uses[begin].edge[0] == uses[begin].edge[1])
            continue; // of a triangle that is listed as degenerate
        const std::uint32_t component = component_of[uses[begin].triangle];
        ++found.edges[component];
        // Three or more triangles at an edge leave no gap there, so the piece counts as closed.
        if (end - begin == 1)
            found.closed[component] = 0;
        if (forward != 0)
            found.balanced[component] = 0;
    }
    return found;
}

FloatBox box_of(const std::vector<FloatBox>& triangle_boxes, const Indices& triangles)
{
    FloatBox box = triangle_boxes[triangles.front()];
    for (const std::uint32_t t : triangles)
        box.add(triangle_boxes[t]);
    return box;
}

struct Piece {
    Indices triangles;
    FloatBox box;
    bool closed;
};

/// Whether `point` lies inside the closed `piece`: an odd number of crossings above it.
bool encloses(const TriangleMesh& mesh, const std::vector<FloatBox>& boxes, const Piece& piece,
              const openvdb::Vec3s& point, bool& on_surface)
{
    bool inside = false;
    for (const std::uint32_t t : piece.triangles) {
        const FloatBox& box = boxes[t];
        // Only triangles that the upward ray through the point can meet: those whose boxes hold x
        // and y and do not end below it.
        if (point[0] < box.lo[0] || point[0] > box.hi[0] || point[1] < box.lo[1] ||
            point[1] > box.hi[1] || point[2] > box.hi[2])
            continue;
        const openvdb::Vec3I& corner = mesh.triangles[t];
        inside ^= exact::crossing_above(point, mesh.points[corner[0]], mesh.points[corner[1]],
                                        mesh.points[corner[2]], on_surface) != 0;
    }
    return inside;
}

/// Two pieces that neither cross nor touch have one answer for every corner, so the first corner
/// decides; corners on the other surface, which both can have by index, decide nothing. Where the
/// pieces cross or touch, the corners of at most kMostTested triangles, spread over the piece, are
/// tested, and all of them have to be inside.
bool encloses(const TriangleMesh& mesh, const std::vector<FloatBox>& boxes, const Piece& outer,
              const Piece& inner, bool crossing)
{
    constexpr std::size_t kMostTested = 256;
    const std::size_t stride = crossing ? inner.triangles.size() / kMostTested + 1 : 1;
    bool any_inside = false;
    for (std::size_t i = 0; i < inner.triangles.size(); i += stride) {
        for (int corner = 0; corner < 3; ++corner) {
            const openvdb::Vec3s& point = mesh.points[mesh.triangles[inner.triangles[i]][corner]];
            bool on_surface = false;
            const bool inside =
                outer.box.contains(point) && encloses(mesh, boxes, outer, point, on_surface);
            if (on_surface)
                continue;
            if (!crossing || !inside)
                return inside;
            any_inside = true;
        }
    }
    return any_inside;
}

/// How many closed pieces each piece is in.
class Nesting
{
public:
    /// `shared`: points of several pieces; `crossing`: the pairs of pieces that cross or touch.
    Nesting(const TriangleMesh& mesh, const std::vector<FloatBox>& boxes,
            const std::vector<Piece>& pieces, const Indices& component_of,
            const std::vector<char>& shared,
            const std::vector<std::array<std::uint32_t, 2>>& crossing)
        : mesh_(mesh), boxes_(boxes), pieces_(pieces), component_of_(component_of), shared_(shared),
          crossed_(pieces.size())
    {
        // An open piece has no inside.
        std::vector<openvdb::Vec3I> closed;
        for (std::uint32_t t = 0; t < component_of.size() && pieces.size() > 1; ++t)
            if (pieces[component_of[t]].closed) {
                closed.push_back(mesh.triangles[t]);
                closed_.push_back(t);
            }
        PartBoxes parts = part_boxes(mesh.points, closed);
        part_ = std::move(parts.triangle);
        tree_.build(parts.boxes);
        for (const auto& [a, b] : crossing) {
            crossed_[a].push_back(b);
            crossed_[b].push_back(a);
        }
        for (Indices& others : crossed_)
            std::sort(others.begin(), others.end());
    }

    int depth(std::uint32_t c) const
    {
        int depth = 0;
        for (const std::uint32_t other : crossed_[c])
            depth +=
                pieces_[other].closed && encloses(mesh_, boxes_, pieces_[other], pieces_[c], true);
        const std::vector<Hit> hits = hits_above(c);
        for (std::size_t begin = 0, end = 0; begin < hits.size(); begin = end) {
            bool inside = false, on_surface = false;
            for (; end < hits.size() && hits[end].piece == hits[begin].piece; ++end) {
                inside ^= hits[end].crosses;
                on_surface |= hits[end].on_surface;
            }
            // A point on the other piece tells nothing.
            depth += on_surface
                         ? encloses(mesh_, boxes_, pieces_[hits[begin].piece], pieces_[c], false)
                         : inside;
        }
        return depth;
    }

private:
    struct Hit {
        std::uint32_t piece, triangle;
        bool crosses, on_surface;
    };

    /// Of the upward ray from a point of piece c with closed pieces that it does not cross, sorted
    /// by piece.
    std::vector<Hit> hits_above(std::uint32_t c) const
    {
        const openvdb::Vec3s& point = mesh_.points[own_point(pieces_[c].triangles)];
        FloatBox ray = FloatBox::around(point);
        ray.hi[2] = std::numeric_limits<float>::infinity();
        // Of a triangle the ray may meet several parts.
        Indices triangles;
        const Indices& crossed = crossed_[c];
        tree_.for_each_overlap(ray, [&](int i) {
            const std::uint32_t t = closed_[part_[std::size_t(i)]], other = component_of_[t];
            if (other != c && !std::binary_search(crossed.begin(), crossed.end(), other))
                triangles.push_back(t);
        });
        sort_unique(triangles);
        std::vector<Hit> hits;
        for (const std::uint32_t t : triangles) {
            const openvdb::Vec3I& corner = mesh_.triangles[t];
            Hit hit{component_of_[t], t, false, false};
            hit.crosses =
                exact::crossing_above(point, mesh_.points[corner[0]], mesh_.points[corner[1]],
                                      mesh_.points[corner[2]], hit.on_surface) != 0;
            hits.push_back(hit);
        }
        std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
            return a.piece != b.piece ? a.piece < b.piece : a.triangle < b.triangle;
        });
        return hits;
    }

    /// One that no other piece has, if there is one: it may be on the surface of none, and is not
    /// where thousands of pieces meet.
    std::uint32_t own_point(const Indices& triangles) const
    {
        for (const std::uint32_t t : triangles)
            for (int k = 0; k < 3; ++k)
                if (!shared_[mesh_.triangles[t][k]])
                    return mesh_.triangles[t][k];
        return mesh_.triangles[triangles.front()][0];
    }

    const TriangleMesh& mesh_;
    const std::vector<FloatBox>& boxes_;
    const std::vector<Piece>& pieces_;
    const Indices& component_of_;
    const std::vector<char>& shared_;
    Indices closed_; ///< triangles of closed pieces
    Indices part_;   ///< for each box of the tree a place among these
    BoxTree tree_;   ///< over parts of them
    std::vector<Indices> crossed_;
};

} // namespace

Indices component_of_triangles(const EdgeUses& sorted_uses, std::size_t triangle_count)
{
    DisjointSets sets(triangle_count);
    for (std::size_t i = 1; i < sorted_uses.size(); ++i) {
        // Uses of one edge stand together, so joining each with the one before it joins all of
        // them.
        const auto& edge = sorted_uses[i].edge;
        if (edge != sorted_uses[i - 1].edge || edge[0] == edge[1])
            continue;
        sets.join(sorted_uses[i - 1].triangle, sorted_uses[i].triangle);
    }
    Indices component(triangle_count);
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < triangle_count; ++t) {
        // A root is its component's first triangle.
        const std::uint32_t root = sets.root_of(t);
        component[t] = root == t ? count++ : component[root];
    }
    return component;
}

std::vector<std::array<std::uint32_t, 2>>
crossing_components(const std::vector<TrianglePair>& pairs, const Indices& component_of)
{
    std::vector<std::array<std::uint32_t, 2>> crossing;
    for (const TrianglePair& pair : pairs) {
        // These are references into the vector, which stays; minmax of two temporaries would leave
        // them without an object.
        const auto [low, high] = std::minmax(component_of[pair[0]], component_of[pair[1]]);
        if (low != high)
            crossing.push_back({low, high});
    }
    sort_unique(crossing);
    return crossing;
}

std::vector<Component>
describe_components(const TriangleMesh& mesh, const EdgeUses& sorted_uses,
                    const Indices& component_of,
                    const std::vector<std::array<std::uint32_t, 2>>& crossing)
{
    std::vector<Indices> triangles = triangles_by_component(component_of);
    const std::size_t count = triangles.size();
    const PointFindings at_points = look_at_points(mesh, triangles);
    const EdgeFindings found = look_at_edges(sorted_uses, component_of, count);
    const std::vector<FloatBox> boxes = triangle_boxes(mesh.points, mesh.triangles);
    std::vector<Piece> pieces(count);
    std::vector<Component> components(count);
    for_each_index(count, [&](std::size_t c) {
        Component& component = components[c];
        component.triangles = triangles[c].size();
        component.first_triangle = triangles[c].front();
        component.volume = volume_of(mesh, triangles[c]);
        component.closed = found.closed[c] != 0;
        component.euler =
            at_points.points[c] - found.edges[c] + static_cast<int>(triangles[c].size());
        // Before the list is moved away in the next line.
        const FloatBox box = box_of(boxes, triangles[c]);
        pieces[c] = {std::move(triangles[c]), box, component.closed};
    });
    const Nesting nesting(mesh, boxes, pieces, component_of, at_points.shared, crossing);
    for_each_index(
        count,
        [&](std::size_t c) {
            const int depth = components[c].nesting_depth = nesting.depth(std::uint32_t(c));
            if (found.closed[c] == 0 || found.balanced[c] == 0)
                return;
            // Exact: of a needle, the volume in doubles may have any sign.
            const int sign = exact::volume_sign(mesh.points, mesh.triangles, pieces[c].triangles);
            components[c].inside_out = sign == (depth % 2 == 0 ? -1 : 1);
            components[c].flat = sign == 0;
        },
        1);
    return components;
}

} // namespace vdb_shell

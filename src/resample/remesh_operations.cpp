// SPDX-License-Identifier: Apache-2.0

// Takes the ends of an edge, or a vertex and where it is to go, and makes the patch that splits,
// collapses or flips the edge or moves the vertex. What a patch cannot tell is tested here: the
// link condition, and that feature edges stay what they are. A vertex on a curve has no place of
// its own but a length along the curve, which its feature edges hold; so it stays on the input's
// own curve however often it is moved. The trap is a closed curve: there the length of a vertex
// depends on the edge that is asked, and only differences along one edge count.

#include "resample/remesh_surface.h"

#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"

#include <algorithm>
#include <cassert>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

// A vertex may not come to a place where the input faces away from what is around it now: that is
// another sheet. The cosine of 80 degrees.
constexpr double kSameSheet = 0.17;

Vec3I with(Vec3I c, std::uint32_t from, std::uint32_t to)
{
    for (int k = 0; k < 3; ++k)
        if (c[k] == from)
            c[k] = to;
    return c;
}

} // namespace

const RemeshSurface::FeatureEdge* RemeshSurface::feature(std::uint32_t a, std::uint32_t b) const
{
    if (kind_[a] == VertexKind::free || kind_[b] == VertexKind::free)
        return nullptr;
    const auto found = feature_edges_.find(key(a, b));
    return found == feature_edges_.end() ? nullptr : &found->second;
}

bool RemeshSurface::has_edge(std::uint32_t a, std::uint32_t b) const
{
    // Closed and consistent: each neighbour is once the next corner.
    return std::any_of(star_[a].begin(), star_[a].end(),
                       [&](std::uint32_t t) { return corner_after(triangles_[t], a) == b; });
}

std::array<std::uint32_t, 2> RemeshSurface::triangles_at(std::uint32_t a, std::uint32_t b) const
{
    std::array<std::uint32_t, 2> found{};
    for (const std::uint32_t t : star_[a]) {
        const std::uint32_t next = corner_after(triangles_[t], a);
        if (next == b)
            found[0] = t;
        else if (corner_after(triangles_[t], next) == b)
            found[1] = t;
    }
    return found;
}

std::array<std::uint32_t, 2> RemeshSurface::opposite(std::uint32_t a, std::uint32_t b) const
{
    const auto [left, right] = triangles_at(a, b);
    return {corner_after(triangles_[left], b), corner_after(triangles_[right], a)};
}

std::vector<std::uint32_t> RemeshSurface::ring(std::uint32_t v) const
{
    std::vector<std::uint32_t> ring;
    ring.reserve(star_[v].size());
    for (const std::uint32_t t : star_[v])
        ring.push_back(corner_after(triangles_[t], v));
    return ring;
}

std::uint32_t RemeshSurface::new_vertex(const Vec3d& p, double size)
{
    if (free_vertices_.empty()) {
        free_vertices_.push_back(static_cast<std::uint32_t>(points_.size()));
        points_.emplace_back();
        kind_.emplace_back();
        on_input_.emplace_back();
        size_.emplace_back();
        star_.emplace_back();
    }
    const std::uint32_t v = free_vertices_.back();
    free_vertices_.pop_back();
    points_[v] = Vec3s(p);
    kind_[v] = VertexKind::free;
    on_input_[v] = 0;
    size_[v] = size;
    return v;
}

Refusal RemeshSurface::split(std::uint32_t a, std::uint32_t b, SplitTo place, double cosine)
{
    const FeatureEdge* edge = feature(a, b);
    const double s = edge ? 0.5 * (edge->s_from + edge->s_to) : 0.0;
    const Vec3d middle = 0.5 * (point(a) + point(b));
    const Vec3d p = edge                      ? features_.curves[edge->curve].point_at(s)
                    : place == SplitTo::input ? foot_of(middle).point
                                              : middle;
    const auto [left, right] = triangles_at(a, b);
    const auto [c, d] = opposite(a, b);
    const std::uint32_t m = new_vertex(p, size_of_edge(a, b));
    patch_.clear();
    patch_.hub = m;
    patch_.same_surface = !edge && place == SplitTo::middle;
    patch_.removed = {left, right};
    patch_.added = {Vec3I(a, m, c), Vec3I(m, b, c), Vec3I(b, m, d), Vec3I(m, a, d)};
    if (edge) {
        const std::uint32_t from = edge->from, to = from == a ? b : a;
        patch_.forgotten = {key(a, b)};
        patch_.features = {{from, m, {edge->curve, from, edge->s_from, s}},
                           {m, to, {edge->curve, m, s, edge->s_to}}};
        kind_[m] = VertexKind::on_curve;
    }
    on_input_[m] = edge || place == SplitTo::input;
    const Refusal refusal = replace(patch_, points_[m], cosine);
    if (refusal != Refusal::none)
        free_vertices_.push_back(m);
    return refusal;
}

/// The link condition (Dey and others 1999, "Topology preserving edge contraction"). A tetrahedron
/// satisfies it too and would collapse to nothing, which the degrees exclude.
bool RemeshSurface::keeps_manifold(std::uint32_t a, std::uint32_t b) const
{
    const std::vector<std::uint32_t> of_a = ring(a), of_b = ring(b);
    const auto common = std::count_if(of_b.begin(), of_b.end(), [&](std::uint32_t w) {
        return std::find(of_a.begin(), of_a.end(), w) != of_a.end();
    });
    return common == 2 && (of_a.size() > 3 || of_b.size() > 3);
}

/// What collapsing leaves, with the kept vertex at s of the curve if the edge is a feature edge;
/// false where two feature edges would become one.
bool RemeshSurface::collapse_patch(std::uint32_t gone, std::uint32_t kept, double s,
                                   Patch& patch) const
{
    patch.clear();
    patch.hub = kept;
    for (const std::uint32_t w : opposite(gone, kept))
        if (feature(gone, w) && feature(kept, w))
            return false;
    for (const std::uint32_t v : {gone, kept})
        for (const std::uint32_t t : star_[v]) {
            const Vec3I& c = triangles_[t];
            const bool of_gone = c[0] == gone || c[1] == gone || c[2] == gone;
            const bool of_kept = c[0] == kept || c[1] == kept || c[2] == kept;
            if (v == kept && of_gone)
                continue; // came with the other star
            patch.removed.push_back(t);
            if (!(of_gone && of_kept))
                patch.added.push_back(with(c, gone, kept));
        }
    hand_on_features(gone, kept, s, patch);
    return true;
}

/// The feature edges of both ends, if they are on a curve, as they are with the kept one at s.
void RemeshSurface::hand_on_features(std::uint32_t gone, std::uint32_t kept, double s,
                                     Patch& patch) const
{
    const FeatureEdge* edge = feature(gone, kept);
    if (!edge)
        return;
    // The lengths that the two ends had along the edge; s is told in these.
    const double s_gone = edge->from == gone ? edge->s_from : edge->s_to;
    const double s_kept = edge->from == gone ? edge->s_to : edge->s_from;
    const auto reach = [&](std::uint32_t v, std::uint32_t skipped, double shift) {
        for (const std::uint32_t w : ring(v)) {
            const FeatureEdge* other = w == skipped ? nullptr : feature(v, w);
            if (!other)
                continue;
            FeatureEdge moved = *other;
            (moved.from == v ? moved.s_from : moved.s_to) += shift;
            moved.from = moved.from == v ? kept : moved.from;
            patch.forgotten.push_back(key(v, w));
            patch.features.push_back({kept, w, moved});
        }
    };
    patch.forgotten.push_back(key(gone, kept));
    reach(gone, kept, s - s_gone);
    if (s != s_kept)
        reach(kept, gone, s - s_kept);
}

bool RemeshSurface::too_long(const Vec3d& p, double longest) const
{
    for (const Vec3I& c : patch_.added)
        for (int k = 0; k < 3; ++k)
            if (c[k] == patch_.hub) {
                const std::uint32_t w = c[(k + 1) % 3];
                if ((point(w) - p).length() > longest * size_of_edge(patch_.hub, w))
                    return true;
            }
    return false;
}

Refusal RemeshSurface::collapse_to(std::uint32_t gone, std::uint32_t kept, const Vec3d& p, double s,
                                   double longest, double cosine)
{
    if (!collapse_patch(gone, kept, s, patch_))
        return Refusal::feature;
    if (too_long(p, longest))
        return Refusal::length;
    const Refusal refusal = replace(patch_, Vec3s(p), cosine);
    if (refusal == Refusal::none)
        free_vertices_.push_back(gone);
    return refusal;
}

Refusal RemeshSurface::collapse_free(std::uint32_t a, std::uint32_t b, double longest,
                                     double cosine)
{
    const double size = size_of_edge(a, b);
    const Foot middle = foot_of(0.5 * (point(a) + point(b)));
    Refusal refusal = collapse_to(a, b, middle.point, 0, longest, cosine);
    if (refusal == Refusal::none) {
        on_input_[b] = 1;
        size_[b] = size;
        return refusal;
    }
    if (collapse_to(a, b, point(b), 0, longest, cosine) == Refusal::none ||
        collapse_to(b, a, point(a), 0, longest, cosine) == Refusal::none)
        refusal = Refusal::none;
    return refusal;
}

Refusal RemeshSurface::collapse_on_curve(std::uint32_t a, std::uint32_t b, double longest,
                                         double cosine)
{
    const FeatureEdge edge = *feature(a, b);
    const double s_b = edge.from == a ? edge.s_to : edge.s_from;
    if (kind_[b] == VertexKind::corner)
        return collapse_to(a, b, point(b), s_b, longest, cosine);
    const double s_a = edge.s_from + edge.s_to - s_b, middle = 0.5 * (s_a + s_b);
    const Refusal refusal =
        collapse_to(a, b, features_.curves[edge.curve].point_at(middle), middle, longest, cosine);
    if (refusal == Refusal::none ||
        collapse_to(a, b, point(b), s_b, longest, cosine) == Refusal::none ||
        collapse_to(b, a, point(a), s_a, longest, cosine) == Refusal::none)
        return Refusal::none;
    return refusal;
}

Refusal RemeshSurface::collapse(std::uint32_t a, std::uint32_t b, double longest, double cosine)
{
    // The one that may do more goes.
    if (kind_[a] > kind_[b])
        std::swap(a, b);
    const bool on_feature = is_feature(a, b);
    if ((on_feature && kind_[a] == VertexKind::corner) ||
        (!on_feature && kind_[a] != VertexKind::free))
        return Refusal::feature;
    if (!keeps_manifold(a, b))
        return Refusal::topology;
    if (on_feature)
        return collapse_on_curve(a, b, longest, cosine);
    if (kind_[b] == VertexKind::free)
        return collapse_free(a, b, longest, cosine);
    return collapse_to(a, b, point(b), 0, longest, cosine);
}

Refusal RemeshSurface::flip(std::uint32_t a, std::uint32_t b, double cosine)
{
    if (is_feature(a, b))
        return Refusal::feature;
    const auto [c, d] = opposite(a, b);
    if (star_[a].size() <= 3 || star_[b].size() <= 3 || has_edge(c, d))
        return Refusal::topology;
    const auto [left, right] = triangles_at(a, b);
    patch_.clear();
    patch_.hub = c;
    patch_.removed = {left, right};
    patch_.added = {Vec3I(c, a, d), Vec3I(d, b, c)};
    return replace(patch_, points_[c], cosine);
}

Refusal RemeshSurface::move(std::uint32_t v, const Vec3d& p, double cosine)
{
    assert(kind_[v] == VertexKind::free);
    const Foot foot = foot_of(p);
    patch_.clear();
    patch_.hub = v;
    patch_.removed = star_[v];
    Vec3d normal(0.0);
    for (const std::uint32_t t : star_[v]) {
        patch_.added.push_back(triangles_[t]);
        normal += cross_of(triangles_[t]);
    }
    if (normal.dot(foot.normal) < kSameSheet * normal.length())
        return Refusal::turned;
    const Refusal refusal = replace(patch_, Vec3s(foot.point), cosine);
    if (refusal == Refusal::none)
        on_input_[v] = 1;
    return refusal;
}

std::array<std::uint32_t, 2> RemeshSurface::along_curve(std::uint32_t v) const
{
    std::array<std::uint32_t, 2> ends{};
    for (const std::uint32_t w : ring(v))
        if (const FeatureEdge* edge = feature(v, w))
            ends[edge->from == v ? 1 : 0] = w;
    return ends;
}

Vec3d RemeshSurface::point_between(std::uint32_t v, double share) const
{
    const auto [before, after] = along_curve(v);
    const FeatureEdge &first = *feature(before, v), &second = *feature(v, after);
    const double whole = first.s_to - first.s_from + second.s_to - second.s_from;
    return features_.curves[first.curve].point_at(first.s_from + share * whole);
}

Refusal RemeshSurface::slide(std::uint32_t v, double share, double cosine)
{
    assert(kind_[v] == VertexKind::on_curve);
    const auto [before, after] = along_curve(v);
    FeatureEdge first = *feature(before, v), second = *feature(v, after);
    const double whole = first.s_to - first.s_from + second.s_to - second.s_from;
    const double s = first.s_from + share * whole;
    second.s_from += s - first.s_to;
    first.s_to = s;
    patch_.clear();
    patch_.hub = v;
    patch_.removed = star_[v];
    for (const std::uint32_t t : star_[v])
        patch_.added.push_back(triangles_[t]);
    patch_.features = {{before, v, first}, {v, after, second}};
    return replace(patch_, Vec3s(features_.curves[first.curve].point_at(s)), cosine);
}

} // namespace vdb_shell

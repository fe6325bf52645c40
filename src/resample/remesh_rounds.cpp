// SPDX-License-Identifier: Apache-2.0

// Takes a surface of operations that look after validity themselves, and decides which of them to
// ask for: those of Botsch and Kobbelt 2004, "A remeshing approach to multiresolution modeling".
// Lengths are held against a wanted length at each vertex, as in Dunyach and others 2013, "Adaptive
// remeshing for real-time mesh deformation"; but it does not come from curvature, which a scan's
// noise has everywhere. It becomes smaller where the tolerance or a feature has refused a collapse,
// so the surface is fine where it has to be and nowhere else.

#include "resample/remesh_rounds.h"
#include "core/sort_unique.h"
#include "core/stage_stop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// Cosines of the angles that operations may not go below, unless they were smaller before: 15
// degrees for collapses and flips, after which smoothing follows, 30 for moves.
constexpr double kEdgesMayLeave = 0.966, kMovesMayLeave = 0.866;
// The cosine of one degree for splits: what comes after them mends angles, but needs some to begin
// with.
constexpr double kSplitsMayLeave = 0.99985;
// Of the smallest angle of a needle of the input that share may be left, for a split divides the
// angle at its far end. Later rounds make no needles, but where the surface is folded so tightly
// that nothing mends them, and there they would become narrower without end.
constexpr double kSplitNeedles = 0.3;
// A refused collapse leaves an edge of this share of the wanted length that it sets: in range.
constexpr double kLengthOverRefused = 1.1;
// How often all edges are gone through that are too long, for each time that the longest has to be
// halved: once is enough where no flip makes one longer.
constexpr int kRoundsForHalf = 3;
// Moves under that share of the wanted length are not worth their tests.
constexpr double kLeastMove = 0.01;

struct LongEdge {
    double ratio;
    std::uint32_t a, b;

    auto order() const { return std::tie(ratio, a, b); }
    bool operator<(const LongEdge& other) const { return order() < other.order(); }
    bool operator==(const LongEdge& other) const { return order() == other.order(); }
};

double ratio_of(const RemeshSurface& surface, std::uint32_t a, std::uint32_t b)
{
    return surface.length(a, b) / surface.size_of_edge(a, b);
}

/// The edges for which keep(ratio) holds, ratio being length over wanted length, ascending; of
/// triangles that have become what they are at `since` or later.
template <typename Keep>
std::vector<LongEdge> edges_by_ratio(const RemeshSurface& surface, std::uint64_t since,
                                     const Keep& keep)
{
    std::vector<LongEdge> edges;
    for (std::uint32_t t = 0; t < surface.triangle_slots(); ++t) {
        if (!surface.alive(t) || surface.changed_at(t) < since)
            continue;
        const Vec3I& c = surface.triangle(t);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = std::min(c[k], c[(k + 1) % 3]);
            const std::uint32_t b = std::max(c[k], c[(k + 1) % 3]);
            const double ratio = ratio_of(surface, a, b);
            if (keep(ratio))
                edges.push_back({ratio, a, b});
        }
    }
    sort_unique(edges); // most are seen from both sides
    return edges;
}

std::vector<LongEdge> edges_too_long(const RemeshSurface& surface)
{
    return edges_by_ratio(surface, 0, [](double ratio) { return ratio > kTooLong; });
}

/// Flips the edges for which wanted(edge) holds, of triangles that have changed since; `cosine` as
/// in RemeshSurface::flip.
template <typename Wanted>
void flip_edges(RemeshSurface& surface, double cosine, std::uint64_t since, const Wanted& wanted)
{
    const std::vector<LongEdge> edges = edges_by_ratio(surface, since, [](double) { return true; });
    for (std::size_t i = 0; i < edges.size(); ++i) {
        stop_if_stage_wants(i);
        if (surface.has_edge(edges[i].a, edges[i].b) && wanted(edges[i]))
            surface.flip(edges[i].a, edges[i].b, cosine);
    }
}

/// Of the angle that a split of the edge may leave, where needles are split too.
double cosine_for_split(const RemeshSurface& surface, std::uint32_t a, std::uint32_t b)
{
    const auto [left, right] = surface.triangles_at(a, b);
    const double narrowest = std::max(surface.cosine(left), surface.cosine(right));
    return std::max(kSplitsMayLeave, std::cos(kSplitNeedles * std::acos(std::min(1.0, narrowest))));
}

/// Whether the edge is as long as it is for the sake of the input and not of its neighbours.
bool is_forced(Refusal refusal)
{
    return refusal == Refusal::feature || refusal == Refusal::far || refusal == Refusal::contact ||
           refusal == Refusal::turned;
}

/// Of the four vertices at an edge, how far their numbers of neighbours are from six, before and
/// after a flip: the difference.
int gain_of_flip(const RemeshSurface& surface, std::uint32_t a, std::uint32_t b)
{
    const auto [left, right] = surface.triangles_at(a, b);
    int gain = 0;
    const auto off = [](int valence) { return std::abs(valence - 6); };
    for (const std::uint32_t t : {left, right})
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = surface.triangle(t)[k];
            const int valence = static_cast<int>(surface.star(v).size());
            if (v != a && v != b)
                gain += off(valence) - off(valence + 1);
            else if (t == left) // the ends are in both
                gain += off(valence) - off(valence - 1);
        }
    return gain;
}

/// To the mean of the middles of the triangles around it, in the plane of their mean normal. A
/// triangle counts by its area in squares of the wanted length: as many of them as there should be.
Vec3d towards_middle(const RemeshSurface& surface, std::uint32_t v)
{
    Vec3d sum(0.0), normal(0.0);
    double weights = 0;
    for (const std::uint32_t t : surface.star(v)) {
        const Vec3I& c = surface.triangle(t);
        const Vec3d p = surface.point(c[0]), q = surface.point(c[1]), r = surface.point(c[2]);
        const Vec3d cross = (q - p).cross(r - p);
        const double size = surface.size(c[0]) + surface.size(c[1]) + surface.size(c[2]);
        const double weight = cross.length() / (size * size);
        sum += (p + q + r) * (weight / 3);
        weights += weight;
        normal += cross;
    }
    const double squared = normal.lengthSqr();
    if (!(weights > 0 && squared > 0))
        return Vec3d(0.0);
    const Vec3d to = sum / weights - surface.point(v);
    return to - normal * (to.dot(normal) / squared);
}

void smooth_on_surface(RemeshSurface& surface, std::uint32_t v)
{
    const Vec3d to = towards_middle(surface, v);
    if (to.length() < kLeastMove * surface.size(v) && surface.on_input(v))
        return;
    const Vec3d from = surface.point(v);
    // The whole way, or a part of it where the whole is too far.
    for (const double share : {1.0, 0.5, 0.2})
        if (surface.move(v, from + to * share, kMovesMayLeave) == Refusal::none)
            return;
}

void smooth_on_curve(RemeshSurface& surface, std::uint32_t v)
{
    const auto [before, after] = surface.along_curve(v);
    const double first = surface.size_of_edge(before, v), second = surface.size_of_edge(v, after);
    const double share = first / (first + second);
    if ((surface.point_between(v, share) - surface.point(v)).length() <
        kLeastMove * surface.size(v))
        return;
    surface.slide(v, share, kMovesMayLeave);
}

} // namespace

std::array<std::uint32_t, 3> from_longest(const RemeshSurface& surface, std::uint32_t t)
{
    const Vec3I& c = surface.triangle(t);
    int longest = 0;
    double most = -1;
    for (int k = 0; k < 3; ++k) {
        const double length = surface.length(c[k], c[(k + 1) % 3]);
        if (length > most)
            most = length, longest = k;
    }
    return {c[longest], c[(longest + 1) % 3], c[(longest + 2) % 3]};
}

void split_long_edges(RemeshSurface& surface, bool needles)
{
    std::vector<LongEdge> edges = edges_too_long(surface);
    // Halves may be too long as well; each time round the longest are shorter, but for flips, which
    // may make one longer.
    const int rounds = edges.empty() ? 0 : kRoundsForHalf * (2 + std::ilogb(edges.back().ratio));
    bool any = true;
    for (int round = 0; round < rounds && any && !edges.empty(); ++round) {
        any = false;
        const std::uint64_t before = surface.now();
        // Longest first, so that triangles are cut at their longest sides.
        for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) {
            stop_if_stage_wants(std::size_t(edge - edges.rbegin()));
            any |= surface.has_edge(edge->a, edge->b) &&
                   surface.split(edge->a, edge->b, SplitTo::middle,
                                 needles ? cosine_for_split(surface, edge->a, edge->b)
                                         : kSplitsMayLeave) == Refusal::none;
        }
        // Needles that are cut across again and again leave triangles by the hundred thousand,
        // which are as narrow; between the cuts most can be flipped into good ones.
        if (edges.back().ratio > 2 * kTooLong)
            flip_to_angle(surface, before);
        edges = edges_too_long(surface);
    }
}

void collapse_short_edges(RemeshSurface& surface, double least_size)
{
    const std::vector<LongEdge> edges =
        edges_by_ratio(surface, 0, [](double ratio) { return ratio < kTooShort; });
    for (std::size_t i = 0; i < edges.size(); ++i) {
        stop_if_stage_wants(i);
        const LongEdge& edge = edges[i];
        // Collapses before may have moved or taken it.
        if (!surface.has_edge(edge.a, edge.b) || ratio_of(surface, edge.a, edge.b) >= kTooShort)
            continue;
        const Refusal refusal = surface.collapse(edge.a, edge.b, kTooLong, kEdgesMayLeave);
        if (!is_forced(refusal))
            continue;
        const double size =
            std::max(least_size, kLengthOverRefused * surface.length(edge.a, edge.b));
        for (const std::uint32_t v : {edge.a, edge.b})
            surface.size(v) = std::min(surface.size(v), size);
    }
}

void flip_to_valence(RemeshSurface& surface)
{
    flip_edges(surface, kEdgesMayLeave, 0,
               [&](const LongEdge& edge) { return gain_of_flip(surface, edge.a, edge.b) > 0; });
}

void flip_to_angle(RemeshSurface& surface, std::uint64_t since)
{
    // Each flip makes an angle larger that was the smallest of its place, as in Lawson's algorithm;
    // a few times round are enough for what is left to pay.
    for (int round = 0; round < 3; ++round) {
        const std::uint64_t before = surface.now() + 1;
        flip_edges(surface, kLargerThanBefore, since, [](const LongEdge&) { return true; });
        since = before;
    }
}

void smooth(RemeshSurface& surface)
{
    for (std::uint32_t v = 0; v < surface.vertex_slots(); ++v) {
        stop_if_stage_wants(v);
        if (surface.star(v).empty())
            continue;
        if (surface.kind(v) == VertexKind::free)
            smooth_on_surface(surface, v);
        else if (surface.kind(v) == VertexKind::on_curve)
            smooth_on_curve(surface, v);
    }
}

void bring_nearer(RemeshSurface& surface, const std::vector<FarPoint>& far)
{
    std::vector<std::uint32_t> slot;
    for (std::uint32_t t = 0; t < surface.triangle_slots(); ++t)
        if (surface.alive(t))
            slot.push_back(t);
    for (const FarPoint& f : far)
        surface.look_at(f.point, slot[f.triangle]);
    const std::uint64_t before = surface.now();
    for (const std::uint32_t place : triangles_of(far)) {
        const std::uint32_t t = slot[place];
        // Another cut may have changed it already.
        if (!surface.alive(t) || surface.changed_at(t) > before)
            continue;
        const auto [a, b, c] = from_longest(surface, t);
        // Cut where it is, it may still be moved afterwards.
        if (surface.split(a, b, SplitTo::input, kSplitsMayLeave) != Refusal::none)
            surface.split(a, b, SplitTo::middle, kSplitsMayLeave);
    }
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t t = 0; t < surface.triangle_slots(); ++t)
        if (surface.alive(t) && surface.changed_at(t) > before)
            for (int k = 0; k < 3; ++k)
                vertices.push_back(surface.triangle(t)[k]);
    sort_unique(vertices);
    for (const std::uint32_t v : vertices)
        if (surface.kind(v) == VertexKind::free)
            surface.move(v, surface.point(v), kMovesMayLeave);
}

void grade_sizes(RemeshSurface& surface, double largest, double slope, double growth)
{
    using Entry = std::pair<double, std::uint32_t>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (std::uint32_t v = 0; v < surface.vertex_slots(); ++v) {
        if (surface.star(v).empty())
            continue;
        surface.size(v) = std::min(largest, growth * surface.size(v));
        queue.emplace(surface.size(v), v);
    }
    // From the smallest on, as in Dijkstra's algorithm.
    while (!queue.empty()) {
        const auto [size, v] = queue.top();
        queue.pop();
        if (size > surface.size(v))
            continue;
        for (const std::uint32_t t : surface.star(v))
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t w = surface.triangle(t)[k];
                const double most = size + slope * surface.length(v, w);
                if (surface.size(w) > most) {
                    surface.size(w) = most;
                    queue.emplace(most, w);
                }
            }
    }
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "growth/start.h"

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/untangle.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <optional>

namespace vdb_shell::growth
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kThinShare = 0.02;
constexpr double kShrink = 0.65; ///< factor on a pillar of a prism that violates
// The same for carried pillars, as the share that goes: it doubles each time, up to the last.
constexpr double kFirstShare = 0.01, kLastShare = 0.7;
// Rounds in which their inner points are untangled; what is bad after them shrinks only, so that it
// ends.
constexpr int kUntangledRounds = 7;
constexpr int kFirstSweeps = 12, kSweeps = 5;

double smallest_altitude(const Corners& c)
{
    const double longest =
        std::max({(c[1] - c[0]).lengthSqr(), (c[2] - c[1]).lengthSqr(), (c[0] - c[2]).lengthSqr()});
    return longest > 0 ? (c[1] - c[0]).cross(c[2] - c[0]).length() / std::sqrt(longest) : 0;
}

void place(GrowState& s, const Directions& directions, const std::vector<double>& h)
{
    for_each_index(s.b.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        if (!s.pinned[v])
            s.b[v] = end_within_cap(s, v, directions.inward[v], h[v]);
        if (s.b[v] == s.a[v] || s.pinned[v]) {
            s.b[v] = s.a[v];
            s.pinned[v] = 1;
        }
    });
}

using Marks = std::vector<std::atomic<std::uint8_t>>;

void mark(std::atomic<std::uint8_t>& entry)
{
    entry.store(1, std::memory_order_relaxed);
}

/// By vertex, for the corners of the faces that changed: inner_fan_surely_embedded.
std::vector<std::uint8_t> embedded_fans(const GrowState& s,
                                        const std::vector<std::uint8_t>& changed)
{
    std::vector<std::uint8_t> embedded(s.b.size(), 0);
    for_each_index(embedded.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        const Slice<FaceCorner> around = star(*s.mesh, v);
        embedded[i] = std::any_of(around.begin(), around.end(),
                                  [&](const FaceCorner& at) { return changed[at.face] != 0; }) &&
                      inner_fan_surely_embedded(s, v);
    });
    return embedded;
}

/// Whether both are in the fan of a marked vertex.
bool share_marked(const Connectivity& m, const std::vector<std::uint8_t>& marked, int f, int g)
{
    for (int k = 0; k < 3; ++k)
        if (marked[m.corner(f, k)] && m.incident_to(g, m.corner(f, k)))
            return true;
    return false;
}

/// Marks the triangles that touch others in a place where they should not, of those that `changed`
/// and are not marked yet.
void mark_contacts(GrowState& s, const std::vector<std::uint8_t>& changed, bool first, Marks& bad)
{
    std::vector<FloatBox> boxes(changed.size());
    std::vector<std::uint8_t> ask(changed.size());
    for_each_index(ask.size(), [&](std::size_t f) {
        if (changed[f])
            boxes[f] = float_box_of(inner_corners(s, static_cast<int>(f)));
        ask[f] = changed[f] && !bad[f];
    });
    first ? s.inner_tree.build(std::move(boxes)) : s.inner_tree.refit(boxes, changed);
    const auto asked = [&](int f) { return ask[f] != 0; };
    const std::vector<std::uint8_t> embedded = embedded_fans(s, changed);
    for_each_range(
        s.inner_tree.groups(),
        [&](std::size_t begin, std::size_t end) {
            BoxTree::Near near;
            std::optional<InnerTriangle> triangle;
            const auto of = [&](int f) -> const InnerTriangle& {
                if (!triangle || triangle->face() != f)
                    triangle.emplace(s, f);
                return *triangle;
            };
            for (std::size_t group = begin; group < end; ++group) {
                s.inner_tree.for_each_overlap_of(
                    group, s.inner_tree, near, asked, [&](int f, int g) {
                        // Each pair once where both are asked about, and only if it could mark one.
                        if (f == g || (asked(g) && g < f) || (bad[f] && bad[g]) ||
                            share_marked(*s.mesh, embedded, f, g) || !of(f).meets_inner(g))
                            return;
                        mark(bad[f]);
                        mark(bad[g]);
                    });
                s.inner_tree.for_each_overlap_of(group, s.outer_tree, near, asked,
                                                 [&](int f, int g) {
                                                     if (!bad[f] && of(f).meets_outer(g))
                                                         mark(bad[f]);
                                                 });
            }
        },
        4);
}

/// Looks at the faces that have changed, and marks those that violate.
std::vector<std::uint8_t> violating_faces(GrowState& s, const std::vector<std::uint8_t>& changed,
                                          bool first)
{
    Marks bad(changed.size());
    for_each_index(bad.size(), [&](std::size_t i) {
        const int f = static_cast<int>(i);
        if (changed[f] && (!prism_valid(s, f) || holds_component(s, f)))
            mark(bad[f]);
    });
    mark_contacts(s, changed, first, bad);
    return {bad.begin(), bad.end()};
}

/// Parameter where p + t d meets the triangle, or infinity: a hint, in plain doubles.
double ray_hit(const Vec3d& p, const Vec3d& d, const Corners& c)
{
    const Vec3d e1 = c[1] - c[0], e2 = c[2] - c[0], h = d.cross(e2);
    const double det = e1.dot(h);
    if (det == 0)
        return kInfinity;
    const Vec3d s = p - c[0], q = s.cross(e1);
    const double u = s.dot(h) / det, v = d.dot(q) / det, t = e2.dot(q) / det;
    return u < 0 || v < 0 || u + v > 1 || t <= 0 ? kInfinity : t;
}

/// Marks the corners of violating prisms that are not pinned.
std::vector<std::uint8_t> corners_of(const GrowState& s, const std::vector<std::uint8_t>& bad)
{
    std::vector<std::uint8_t> corners(s.b.size(), 0);
    for (int f = 0; f < s.mesh->face_count(); ++f)
        for (int k = 0; bad[f] && k < 3; ++k) {
            const int v = s.mesh->corner(f, k);
            corners[v] = !s.pinned[v];
        }
    return corners;
}

/// Shorter ones are lost in the rounding.
double shortest_pillar(const GrowState& s)
{
    return 2 * s.rounding;
}

/// Marks the faces to look at again once the vertices marked have moved.
std::vector<std::uint8_t> faces_around(const GrowState& s, const std::vector<std::uint8_t>& moved)
{
    const Connectivity& m = *s.mesh;
    // A witness that moves may come to lie in any prism of another component.
    const bool all = m.components > 1;
    std::vector<std::uint8_t> faces(m.faces.size());
    for (int f = 0; f < m.face_count(); ++f)
        faces[f] = all || moved[m.corner(f, 0)] || moved[m.corner(f, 1)] || moved[m.corner(f, 2)];
    return faces;
}

/// Shrinks the pillars of violating prisms; marks the faces that this changes. False when there is
/// nothing left to shrink.
bool shrink_around(GrowState& s, const std::vector<std::uint8_t>& bad, std::vector<double>& h,
                   std::vector<std::uint8_t>& changed)
{
    const std::vector<std::uint8_t> shrunk = corners_of(s, bad);
    bool any = false;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!shrunk[v])
            continue;
        any = true;
        h[v] *= kShrink;
        if (h[v] < shortest_pillar(s))
            s.pinned[v] = 1;
    }
    changed = faces_around(s, shrunk);
    return any;
}

/// Shortens the pillars of violating prisms, each by its share, and doubles that; marks in `moved`
/// what this moves. False when there is nothing to shorten.
bool shorten_around(GrowState& s, const std::vector<std::uint8_t>& bad, std::vector<double>& share,
                    std::vector<std::uint8_t>& moved)
{
    moved = corners_of(s, bad);
    bool any = false;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!moved[v])
            continue;
        any = true;
        const Vec3d arm = (1 - share[v]) * (s.b[v] - s.a[v]);
        share[v] = std::min(2 * share[v], kLastShare);
        s.b[v] = arm.length() < shortest_pillar(s) ? s.a[v] : rounded(s.a[v] + arm);
        s.pinned[v] = s.b[v] == s.a[v];
    }
    return any;
}

/// Marks what is pinned from the beginning.
void pin_what_cannot_leave(GrowState& s, const Directions& directions, const std::vector<double>& h)
{
    for (int v = 0; v < s.mesh->vertices; ++v) {
        const bool stranded = star(*s.mesh, v).size() == 0;
        s.pinned[v] = stranded || directions.visibility[v] <= 0 || h[v] <= 0 || s.cap[v] <= 0;
        s.reach[v] = 0;
    }
}

} // namespace

std::vector<double> half_rays(const GrowState& s, const Directions& directions)
{
    std::vector<double> half(s.a.size(), 0);
    for_each_index(half.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        const Vec3d& d = directions.inward[v];
        double best = s.diagonal;
        s.outer_tree.for_each_on_ray(s.a[v], d, best, [&](int f) {
            if (!s.mesh->incident_to(f, v))
                best = std::min(best, ray_hit(s.a[v], d, outer_corners(s, f)));
        });
        half[v] = 0.5 * best;
    });
    return half;
}

std::vector<double> thin_heights(const GrowState& s)
{
    std::vector<double> h(s.a.size(), kInfinity);
    for (int f = 0; f < s.mesh->face_count(); ++f) {
        const double height = kThinShare * smallest_altitude(outer_corners(s, f));
        for (int k = 0; k < 3; ++k)
            h[s.mesh->corner(f, k)] = std::min(h[s.mesh->corner(f, k)], height);
    }
    return h;
}

void settle_start(GrowState& s, const Directions& directions, std::vector<double> h,
                  const StageProgress& progress)
{
    pin_what_cannot_leave(s, directions, h);
    for (std::size_t v = 0; v < h.size(); ++v)
        h[v] = std::min(h[v], s.cap[v]);
    std::vector<std::uint8_t> changed(s.mesh->faces.size(), 1);
    place(s, directions, h);
    bool first = true;
    // Every round shrinks or pins a vertex by a fixed factor, so it ends even on a surface that
    // crosses itself: with all its vertices pinned.
    while (shrink_around(s, violating_faces(s, changed, first), h, changed)) {
        progress.stop_if_interrupted(0);
        place(s, directions, h);
        first = false;
    }
}

std::vector<double> settle_carried(GrowState& s, const Directions& directions,
                                   const std::vector<double>& h, const StageProgress& progress)
{
    const Connectivity& m = *s.mesh;
    pin_what_cannot_leave(s, directions, h);
    place(s, directions, h);
    const std::vector<Vec3d> carried = s.b;
    std::vector<std::uint8_t> look(h.size(), 1), moved(h.size(), 1);
    std::vector<double> share(h.size(), kFirstShare);
    for (int round = 0;; ++round) {
        progress.stop_if_interrupted(0);
        if (round < kUntangledRounds)
            untangle(s, round == 0 ? kFirstSweeps : kSweeps, look, moved);
        const bool first = round == 0;
        const std::vector<std::uint8_t> changed =
            first ? std::vector<std::uint8_t>(m.faces.size(), 1) : faces_around(s, moved);
        if (!shorten_around(s, violating_faces(s, changed, first), share, moved))
            break;
        for (int v = 0; v < m.vertices; ++v) {
            if (!moved[v])
                continue;
            look[v] = 1;
            for (const int u : neighbours(m, v))
                look[u] = 1;
        }
    }
    std::vector<double> lost(h.size());
    for_each_index(lost.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        lost[i] = -inner_volume6_gradient(s, v).dot(carried[i] - s.b[i]);
    });
    return lost;
}

} // namespace vdb_shell::growth

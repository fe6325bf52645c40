// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell, and a pinned vertex to which the pillars around it leave none of its own.
// Leaves: those shorter, or turned to where they see their triangles better, until it can have one.
// Short enough they always leave one to a vertex that the surface itself does not pin; what
// rounding takes of that, turning gives back (docs/theory.md, "Pins that geometry demands").

#include "growth/pillars_around_pin.h"

#include "core/sort_unique.h"
#include "core/unit_vector.h"
#include "growth/move_tests.h"
#include "growth/violations.h"
#include "mesh/most_visible.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

/// The float32 points around x, the nearest first: the one that it is rounded to and those beside
/// that.
std::vector<Vec3d> points_around(const Vec3d& x)
{
    constexpr int kPoints = 27;
    std::vector<Vec3d> points;
    points.reserve(kPoints);
    const auto step = [](double coordinate, int by) {
        constexpr float kFar = std::numeric_limits<float>::max();
        const auto at = static_cast<float>(coordinate);
        return double(by == 0 ? at : std::nextafter(at, by < 0 ? -kFar : kFar));
    };
    for (int i = 0; i < kPoints; ++i)
        points.push_back({step(x[0], i % 3 - 1), step(x[1], i / 3 % 3 - 1), step(x[2], i / 9 - 1)});
    std::stable_sort(points.begin(), points.end(), [&](const Vec3d& p, const Vec3d& q) {
        return (p - x).lengthSqr() < (q - x).lengthSqr();
    });
    return points;
}

/// Of the two triangles at the edge jk, the corner of that without v which is opposite to it.
int corner_across(const GrowState& s, int v, int j, int k)
{
    for (const FaceCorner& at : star(*s.mesh, j)) {
        const int p = s.mesh->corner(at.face, (at.local + 1) % 3);
        const int q = s.mesh->corner(at.face, (at.local + 2) % 3);
        if (p == k && q != v)
            return q;
        if (q == k && p != v)
            return p;
    }
    return -1;
}

/// Where both other corners of a triangle at v are pinned, its prism is a tet on the edge between
/// them, and has to stay within the angle of the surface there. If v lies inside the plane of the
/// other triangle at that edge, but nearer than its pillar is long, that must not lean out of it.
/// False: there are none.
bool add_planes_across_pins(const GrowState& s, int v, double length, View& view)
{
    const std::size_t before = view.bounds.size();
    for (const FaceCorner& at : star(*s.mesh, v)) {
        const int j = s.mesh->corner(at.face, (at.local + 1) % 3);
        const int k = s.mesh->corner(at.face, (at.local + 2) % 3);
        if (!s.pinned[j] || !s.pinned[k])
            continue;
        const int x = corner_across(s, v, j, k);
        if (x < 0 || orient(s.a[k], s.a[x], s.a[j], s.a[v]) <= 0)
            continue;
        const Vec3d inward = unit_vector((s.a[x] - s.a[k]).cross(s.a[j] - s.a[k]));
        if (inward.lengthSqr() > 0 && inward.dot(s.a[v] - s.a[k]) < length)
            view.bounds.push_back({inward, {-1, -1}});
    }
    return view.bounds.size() > before;
}

/// The one that keeps farthest from the worst of the view's bounds.
void choose_direction(View& view)
{
    std::vector<Vec3d> normals;
    normals.reserve(view.bounds.size());
    for (const Bound& bound : view.bounds)
        normals.push_back(bound.normal);
    view.direction = most_visible(normals);
    view.least = view.direction.lengthSqr() > 0 ? smallest_dot(normals, view.direction) : 0;
}

/// With the ends of the pillars beside v where they are, or all of them at the surface.
View view_of(const GrowState& s, int v, bool with_pillars)
{
    View view;
    for (const FaceCorner& at : star(*s.mesh, v)) {
        const int j = s.mesh->corner(at.face, (at.local + 1) % 3);
        const int k = s.mesh->corner(at.face, (at.local + 2) % 3);
        for (const int inner_j : {-1, j})
            for (const int inner_k : {-1, k}) {
                if (!with_pillars && (inner_j >= 0 || inner_k >= 0))
                    continue;
                const Vec3d& p = inner_j < 0 ? s.a[j] : s.b[j];
                const Vec3d& q = inner_k < 0 ? s.a[k] : s.b[k];
                const Vec3d n = (q - s.a[v]).cross(p - s.a[v]);
                if (!(n.lengthSqr() > 0))
                    continue;
                view.bounds.push_back({n / n.length(), {inner_j, inner_k}});
            }
    }
    choose_direction(view);
    return view;
}

} // namespace

View best_view(const GrowState& s, int v)
{
    return view_of(s, v, true);
}

std::optional<View> view_beside_pins(const GrowState& s, int v, double length, View view)
{
    if (!add_planes_across_pins(s, v, length, view))
        return std::nullopt;
    choose_direction(view);
    return view;
}

View view_of_surface(const GrowState& s, int v)
{
    return view_of(s, v, false);
}

PillarsAround::PillarsAround(GrowState& s, int v, const std::vector<double>& visibility,
                             Shortening shortening)
    : s_(s), pin_(v), visibility_(visibility), shortening_(shortening), faces_(faces_at(*s.mesh, v))
{
}

bool PillarsAround::shorten(const View& view, double least)
{
    // The bounds that bind are about equal where the worst is as far off as can be.
    constexpr double kAboutEqual = 0.01;
    const double near = shortening_.all ? least : std::min(least, view.least + kAboutEqual);
    std::vector<int> blocking;
    for (const Bound& bound : view.bounds)
        if (bound.normal.dot(view.direction) < near)
            for (const int u : bound.inner)
                if (u >= 0 && !s_.pinned[u])
                    blocking.push_back(u);
    sort_unique(blocking);
    bool any = false;
    for (const int u : blocking)
        any = change(u, shortening_.share * (s_.b[u] - s_.a[u])) || any;
    return any;
}

bool PillarsAround::turn(const Vec3d& direction)
{
    bool any = false;
    for (const int u : corners_of_failing(direction)) {
        const View view = best_view(s_, u);
        const Vec3d arm = s_.b[u] - s_.a[u];
        const double length = arm.length(), clear = clear_view(s_, visibility_[u]);
        const Vec3d turned = arm / length + view.direction;
        any = (view.least < clear       ? shorten(view, clear)
               : turned.lengthSqr() > 0 ? change(u, 0.5 * length * turned.unit())
                                        : false) ||
              any;
    }
    return any;
}

std::vector<PillarEnd> PillarsAround::restore()
{
    std::vector<PillarEnd> ends{{pin_, s_.b[pin_]}};
    s_.b[pin_] = s_.a[pin_];
    s_.pinned[pin_] = 1;
    for (const Pillar& p : pillars_) {
        ends.push_back({p.vertex, s_.b[p.vertex]});
        s_.b[p.vertex] = p.before;
    }
    return ends;
}

double PillarsAround::void6() const
{
    double sum = 0;
    for (const int f : faces_) {
        const Corners b = inner_corners(s_, f);
        sum += (b[0] - s_.a[pin_]).dot((b[1] - s_.a[pin_]).cross(b[2] - s_.a[pin_]));
    }
    return sum;
}

bool PillarsAround::valid() const
{
    return faces_valid(s_, faces_);
}

/// Of the vertex's prisms that fail with its shortest pillar, the other corners.
std::vector<int> PillarsAround::corners_of_failing(const Vec3d& direction)
{
    std::vector<int> corners;
    s_.pinned[pin_] = 0;
    s_.b[pin_] = end_within_cap(s_, pin_, direction, 2 * shortest_pillar(s_));
    for (const FaceCorner& at : star(*s_.mesh, pin_))
        if (!prism_valid(s_, at.face))
            for (int k = 1; k < 3; ++k)
                corners.push_back(s_.mesh->corner(at.face, (at.local + k) % 3));
    s_.b[pin_] = s_.a[pin_];
    s_.pinned[pin_] = 1;
    sort_unique(corners);
    const auto is_pinned = [&](int u) { return s_.pinned[u] != 0; };
    corners.erase(std::remove_if(corners.begin(), corners.end(), is_pinned), corners.end());
    return corners;
}

PillarsAround::Pillar& PillarsAround::pillar(int u)
{
    const auto at = std::find_if(pillars_.begin(), pillars_.end(),
                                 [&](const Pillar& p) { return p.vertex == u; });
    if (at != pillars_.end())
        return *at;
    pillars_.push_back({u, false, s_.b[u]});
    return pillars_.back();
}

/// Puts the end of u's pillar to the float32 point nearest to that arm at which its prisms are
/// valid: rounded as usual, a short one that leans may come to lie beyond a plane of its own tets.
/// False, with nothing changed and no other try for this pillar, where there is none.
bool PillarsAround::change(int u, const Vec3d& arm)
{
    Pillar& p = pillar(u);
    const Vec3d before = s_.b[u];
    const double longest = (before - s_.a[u]).lengthSqr();
    const std::vector<int> faces = faces_at(*s_.mesh, u);
    const auto fits = [&](const Vec3d& end) {
        s_.b[u] = end;
        // A pillar of some roundings is rounded to what it was, and would be shortened for ever.
        return end != s_.a[u] && (end - s_.a[u]).lengthSqr() < longest && within_cap(s_, u, end) &&
               std::all_of(faces.begin(), faces.end(), [&](int f) { return prism_valid(s_, f); });
    };
    const std::vector<Vec3d> ends = points_around(s_.a[u] + arm);
    const double shortest = std::max(shortest_pillar(s_), s_.schedule.pins.shortest_share *
                                                              (p.before - s_.a[u]).length());
    p.done = p.done || !(arm.length() > shortest) || std::none_of(ends.begin(), ends.end(), fits);
    if (p.done) {
        s_.b[u] = before;
        return false;
    }
    faces_.insert(faces_.end(), faces.begin(), faces.end());
    sort_unique(faces_);
    return true;
}

} // namespace vdb_shell::growth

// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/candidates.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

/// What a triangle can become until the lists are made again: each corner within its reach.
struct Reachable {
    Corners corner;
    Vec3d reach{0.0};
    Vec3d normal{0.0}; ///< any length
};

Reachable reachable(const Corners& corner, const Vec3d& reach)
{
    const Vec3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    return {corner, reach, normal};
}

Box reach_box(const Reachable& t)
{
    Box box;
    for (int k = 0; k < 3; ++k) {
        Box ball;
        ball.add(t.corner[k]);
        ball.inflate(t.reach[k]);
        box.add(ball);
    }
    return box;
}

/// Whether a plane across `axis` keeps the two apart. The slack covers the rounding of this very
/// test: leaving a pair out has to be right, keeping one costs time only.
bool apart_along(const Vec3d& axis, const Reachable& s, const Reachable& t)
{
    const double length = axis.length();
    double s_lo = 1e300, s_hi = -1e300, t_lo = 1e300, t_hi = -1e300, size = 0;
    for (int k = 0; k < 3; ++k) {
        // Differences, so that an object far from the origin does not lose its digits.
        const Vec3d p = s.corner[k] - s.corner[0], q = t.corner[k] - s.corner[0];
        const double a = axis.dot(p), b = axis.dot(q);
        const double da = length * s.reach[k], db = length * t.reach[k];
        s_lo = std::min(s_lo, a - da), s_hi = std::max(s_hi, a + da);
        t_lo = std::min(t_lo, b - db), t_hi = std::max(t_hi, b + db);
        size = std::max({size, p.lengthSqr(), q.lengthSqr()});
    }
    constexpr double kSlack = 1e-12;
    const double need = length * kSlack * std::sqrt(size);
    return t_lo - s_hi > need || s_lo - t_hi > need;
}

bool far_apart(const Reachable& s, const Reachable& t)
{
    const Vec3d between =
        (t.corner[0] + t.corner[1] + t.corner[2]) - (s.corner[0] + s.corner[1] + s.corner[2]);
    return apart_along(between, s, t) || apart_along(s.normal, s, t) || apart_along(t.normal, s, t);
}

} // namespace

namespace
{

/// Makes the homes and boxes, and gives back what each inner triangle can reach.
std::vector<Reachable> take_stock(GrowState& s)
{
    const std::size_t count = s.mesh->faces.size();
    s.home = s.b;
    std::vector<Reachable> inner(count);
    for_each_index(
        count,
        [&](std::size_t i) {
            const int f = static_cast<int>(i);
            const Corners corners = inner_corners(s, f);
            s.inner_box[f] = box_of(corners);
            const Vec3I& v = s.mesh->faces[f];
            inner[f] = reachable(corners, {s.reach[v[0]], s.reach[v[1]], s.reach[v[2]]});
        },
        256);
    return inner;
}

std::vector<Box> boxes_of(const std::vector<Reachable>& inner)
{
    std::vector<Box> boxes(inner.size());
    for_each_index(
        inner.size(), [&](std::size_t f) { boxes[f] = reach_box(inner[f]); }, 256);
    return boxes;
}

void list_candidates(GrowState& s, const std::vector<Reachable>& inner, int f)
{
    const Box box = reach_box(inner[f]);
    s.near_inner[f].clear();
    s.near_outer[f].clear();
    s.inner_tree.for_each_overlap(box, [&](int g) {
        if (g != f && (s.mesh->share_a_corner(f, g) || !far_apart(inner[f], inner[g])))
            s.near_inner[f].push_back(g);
    });
    s.outer_tree.for_each_overlap(box, [&](int g) {
        if (!far_apart(inner[f], reachable(outer_corners(s, g), Vec3d(0.0))))
            s.near_outer[f].push_back(g);
    });
}

} // namespace

void rebuild_candidates(GrowState& s)
{
    const std::vector<Reachable> inner = take_stock(s);
    s.inner_tree.build(boxes_of(inner));
    for_each_index(inner.size(),
                   [&](std::size_t f) { list_candidates(s, inner, static_cast<int>(f)); });
}

void update_candidates(GrowState& s, const std::vector<std::uint8_t>& faces)
{
    const std::vector<Reachable> inner = take_stock(s);
    s.inner_tree.refit(boxes_of(inner));
    for_each_index(inner.size(), [&](std::size_t f) {
        if (faces[f])
            list_candidates(s, inner, static_cast<int>(f));
    });
}

} // namespace vdb_shell::growth

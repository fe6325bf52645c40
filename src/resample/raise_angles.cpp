// SPDX-License-Identifier: Apache-2.0

// Takes a remeshed surface and mends the triangles that are still too narrow. Smoothing makes
// triangles good in the mean; next to features, and where the tolerance holds vertices back, single
// ones stay bad. Here each operation has to make the smallest angle around it larger, so nothing is
// lost, and little is looked at.

#include "core/stage_stop.h"
#include "resample/remesh_rounds.h"
#include "resample/triangle_angle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// The search for a better place asks in these directions, 45 degrees apart, with a first step of
// this share of the wanted length, which is halved until it is a hundredth: no longer than what
// smoothing leaves undone (kLeastMove of remesh_rounds.cpp).
constexpr int kDirections = 8, kStepHalvings = 5;
constexpr double kFirstStep = 0.3;
// Of a cosine; less is no better angle but rounding.
constexpr double kLeastGain = 1e-6;
// Along a curve every tenth of the way between the neighbours is asked for.
constexpr int kPlacesOnCurve = 10;

/// Cosine of the smallest angle around v if it were at p; more than 1 where a triangle would turn
/// over.
double cosine_at(const RemeshSurface& surface, std::uint32_t v, const Vec3d& p, const Vec3d& normal)
{
    double worst = -1;
    for (const std::uint32_t t : surface.star(v)) {
        const Vec3I& c = surface.triangle(t);
        std::array<Vec3d, 3> q;
        for (int k = 0; k < 3; ++k)
            q[std::size_t(k)] = c[k] == v ? p : surface.point(c[k]);
        worst = std::max(worst, cosine_of_smallest_angle(q[0], q[1], q[2]));
        if ((q[1] - q[0]).cross(q[2] - q[0]).dot(normal) <= 0)
            return 2;
    }
    return worst;
}

Vec3d normal_at(const RemeshSurface& surface, std::uint32_t v)
{
    Vec3d normal(0.0);
    for (const std::uint32_t t : surface.star(v)) {
        const Vec3I& c = surface.triangle(t);
        normal += (surface.point(c[1]) - surface.point(c[0]))
                      .cross(surface.point(c[2]) - surface.point(c[0]));
    }
    const double length = normal.length();
    return length > 0 ? normal / length : Vec3d(0.0);
}

/// Steps in the plane of the mean normal to where the smallest angle is largest. There is no
/// derivative where two angles are equal, which is where such a search ends; so it asks around.
bool move_to_larger(RemeshSurface& surface, std::uint32_t v)
{
    const Vec3d normal = normal_at(surface, v), start = surface.point(v);
    // Any axis that is not nearly along the normal.
    const Vec3d any = std::abs(normal[0]) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    Vec3d u = any - normal * normal.dot(any);
    u.normalize();
    const Vec3d w = normal.cross(u);
    Vec3d best = start;
    double cosine = cosine_at(surface, v, start, normal);
    double step = kFirstStep * surface.size(v);
    for (int halvings = 0; halvings < kStepHalvings;) {
        const Vec3d from = best;
        for (int k = 0; k < kDirections; ++k) {
            const double angle = 2 * M_PI * k / kDirections;
            const Vec3d p = from + (u * std::cos(angle) + w * std::sin(angle)) * step;
            const double there = cosine_at(surface, v, p, normal);
            if (there < cosine - kLeastGain)
                cosine = there, best = p;
        }
        if (best == from)
            step *= 0.5, ++halvings;
    }
    if (best == start)
        return false;
    for (const double share : {1.0, 0.5, 0.25})
        if (surface.move(v, start + (best - start) * share, kLargerThanBefore) == Refusal::none)
            return true;
    return false;
}

bool slide_to_larger(RemeshSurface& surface, std::uint32_t v)
{
    double best = 0, cosine = 1;
    for (int i = 1; i < kPlacesOnCurve; ++i) {
        const double share = double(i) / kPlacesOnCurve;
        double worst = -1;
        const Vec3d p = surface.point_between(v, share);
        for (const std::uint32_t t : surface.star(v)) {
            const Vec3I& c = surface.triangle(t);
            std::array<Vec3d, 3> q;
            for (int k = 0; k < 3; ++k)
                q[std::size_t(k)] = c[k] == v ? p : surface.point(c[k]);
            worst = std::max(worst, cosine_of_smallest_angle(q[0], q[1], q[2]));
        }
        if (worst < cosine)
            cosine = worst, best = share;
    }
    return best > 0 && surface.slide(v, best, kLargerThanBefore) == Refusal::none;
}

bool raise(RemeshSurface& surface, std::uint32_t t)
{
    constexpr double kAnyLength = 2; // of the wanted one: as a last resort edges may be long
    const auto [a, b, c] = from_longest(surface, t);
    if (surface.flip(a, b, kLargerThanBefore) == Refusal::none)
        return true;
    const bool first = surface.length(b, c) < surface.length(c, a);
    if (surface.collapse(first ? b : c, first ? c : a, kAnyLength, kLargerThanBefore) ==
        Refusal::none)
        return true;
    for (const std::uint32_t v : {c, a, b}) {
        if (surface.kind(v) == VertexKind::free && move_to_larger(surface, v))
            return true;
        if (surface.kind(v) == VertexKind::on_curve && slide_to_larger(surface, v))
            return true;
    }
    return false;
}

} // namespace

std::size_t raise_angles(RemeshSurface& surface, double cosine)
{
    std::size_t looked_at = 0, done = 0;
    for (std::uint32_t t = 0; t < surface.triangle_slots(); ++t) {
        if (!surface.alive(t) || surface.cosine(t) <= cosine)
            continue;
        stop_if_stage_wants(looked_at++);
        done += raise(surface, t);
    }
    return done;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/untangle.h"

#include "core/parallel.h"
#include "shell/grow/move_tests.h"

#include <openvdb/math/Mat3.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

// Over the shortest inner edge around a vertex.
constexpr double kRoom = 0.1;     ///< what each bound is to keep
constexpr double kMostMove = 1.0; ///< of one vertex, in one sweep
// The same in the rounding of a coordinate: below it float32 cannot tell.
constexpr double kRoomInRoundings = 4, kMostMoveInRoundings = 20;
// Share of that rounding, far above the error of a determinant in doubles.
constexpr double kPositive = 1e-3;
/// Weight of staying, where a bound has 1: bounds that are at odds with each other, as they are
/// where a whole patch is sheared, should not throw a vertex about.
constexpr double kStay = 1.0;
constexpr int kSteps = 6; ///< while the bounds that are not kept change

/// n.(x - here) + value, unit n.
struct Bound {
    Vec3d n;
    double value;
};

double shortest_inner_edge(const GrowState& s, int v)
{
    double shortest = std::numeric_limits<double>::infinity();
    for (const int u : neighbours(*s.mesh, v))
        shortest = std::min(shortest, (s.b[u] - s.b[v]).length());
    return shortest;
}

/// The bounds of the twelve tets of each prism around v; gives back the least value of one.
double list_bounds(const GrowState& s, int v, std::vector<Bound>& out)
{
    out.clear();
    double least = std::numeric_limits<double>::infinity();
    for (const FaceCorner& at : star(*s.mesh, v)) {
        const auto& tets = tables().from_b[kTwelve][at.local];
        for (int i = 0; i < tables().from_b_count[kTwelve][at.local]; ++i) {
            if (dropped(s, at.face, tets[i].pillar))
                continue;
            const Vec3d& p = corner_of(s, at.face, tets[i].base[0]);
            const Vec3d n = (corner_of(s, at.face, tets[i].base[1]) - p)
                                .cross(corner_of(s, at.face, tets[i].base[2]) - p);
            const double length = n.length();
            if (!(length > 0))
                continue;
            out.push_back({n / length, n.dot(s.b[v] - p) / length});
            least = std::min(least, out.back().value);
        }
    }
    return least;
}

/// Damped Gauss-Newton steps on the squares of what the bounds lack of `room`.
Vec3d least_move(const std::vector<Bound>& bounds, double room)
{
    Vec3d x(0.0);
    for (int step = 0; step < kSteps; ++step) {
        openvdb::Mat3d h = openvdb::Mat3d::identity() * kStay;
        Vec3d g(0.0);
        for (const Bound& bound : bounds) {
            const double lacks = room - bound.value - bound.n.dot(x);
            if (lacks <= 0)
                continue;
            g += lacks * bound.n;
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k)
                    h(i, k) += bound.n[i] * bound.n[k];
        }
        if (g == Vec3d(0.0))
            break;
        x += h.inverse(0.0) * g;
    }
    return x;
}

/// Where v should go; where it is if that is good.
Vec3d better_place(const GrowState& s, int v, std::vector<Bound>& bounds)
{
    const Vec3d& here = s.b[v];
    if (list_bounds(s, v, bounds) > kPositive * s.rounding)
        return here;
    const double edge = shortest_inner_edge(s, v);
    Vec3d move = least_move(bounds, std::max(kRoom * edge, kRoomInRoundings * s.rounding));
    const double most = kMostMove * edge + kMostMoveInRoundings * s.rounding;
    const double length = move.length();
    if (length > most)
        move *= most / length;
    return capped(s, v, rounded(here + move));
}

} // namespace

void untangle(GrowState& s, int sweeps, std::vector<std::uint8_t>& look,
              std::vector<std::uint8_t>& moved)
{
    tbb::enumerable_thread_specific<std::vector<Bound>> scratch;
    const auto visit = [&](int v) {
        if (!look[v])
            return;
        look[v] = 0;
        if (s.pinned[v])
            return;
        const Vec3d x = better_place(s, v, scratch.local());
        if (x == s.b[v] || x == s.a[v])
            return;
        s.b[v] = x;
        moved[v] = look[v] = 1;
        // No other vertex of the colour has a neighbour in common with this one.
        for (const int u : neighbours(*s.mesh, v))
            look[u] = 1;
    };
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        if (std::find(look.begin(), look.end(), 1) == look.end())
            return;
        for (const std::vector<int>& colour : s.mesh->colour)
            for_each_index(colour.size(), [&](std::size_t i) { visit(colour[i]); });
    }
}

} // namespace vdb_shell::growth

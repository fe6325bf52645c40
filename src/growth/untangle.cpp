// SPDX-License-Identifier: Apache-2.0

// Takes: inner points near which tets are inverted. Leaves: fewer of those. Each vertex is moved by
// as little as puts the bounds of its tets right in least squares, with a weight on staying where
// it is: bounds that are at odds with each other, as they are where a whole patch is sheared, must
// not throw it about. Nothing is promised and contacts are not looked at; what is left is found by
// the exact tests. Vertices of a colour have no common neighbour and move at the same time, so the
// result is the same for any number of threads. Damped Gauss-Newton: Nocedal and Wright 2006,
// "Numerical Optimization", chapter 10.

#include "growth/untangle.h"

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/prism_lanes.h"

#include <openvdb/math/Mat3.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

// Share of the rounding of a coordinate, far above the error of a determinant in doubles.
constexpr double kPositive = 1e-3;

/// Of one vertex. A thread keeps its own from vertex to vertex for the memory, since allocating it
/// anew costs as much as all the rest; nothing that is in it lasts longer than a vertex.
struct Scratch {
    std::vector<CountedPrism> prisms;
    std::vector<TetBounds> bounds; ///< two to a prism; one of the chosen tets
};

double shortest_inner_edge(const GrowState& s, int v)
{
    double shortest = std::numeric_limits<double>::infinity();
    for (const int u : neighbours(*s.mesh, v))
        shortest = std::min(shortest, (s.b[u] - s.b[v]).length());
    return shortest;
}

Vec3d inner_normal(const GrowState& s, int v)
{
    const Vec3d gradient = inner_volume6_gradient(s, v);
    const double length = gradient.length();
    return length > 0 ? gradient / length : Vec3d(0.0);
}

/// The bounds of the chosen tets of each prism around v; gives back the least value of one.
double list_chosen_bounds(const GrowState& s, int v, Scratch& out)
{
    constexpr double kEnough = std::numeric_limits<double>::infinity();
    out.bounds.clear();
    double least = kEnough;
    for (const FaceCorner& at : star(*s.mesh, v)) {
        TetBounds& of_prism = out.bounds.emplace_back();
        of_prism.value.fill(kEnough);
        std::size_t lane = 0;
        const auto add = [&](const Vec3d& n, const Vec3d& p) {
            const double length = n.length();
            if (!(length > 0))
                return;
            of_prism.x[lane] = n[0] / length, of_prism.y[lane] = n[1] / length;
            of_prism.z[lane] = n[2] / length;
            of_prism.value[lane] = n.dot(s.b[v] - p) / length;
            least = std::min(least, of_prism.value[lane++]);
        };
        for_each_base(s, at.face, chosen_tets_with_inner(s, at.face, at.local), add);
    }
    return least;
}

/// The bounds of the twelve tets of each prism around v; gives back the least value of one.
double list_twelve_bounds(const GrowState& s, int v, Scratch& out)
{
    out.prisms.clear();
    for (const FaceCorner& at : star(*s.mesh, v)) {
        const int next = s.mesh->corner(at.face, (at.local + 1) % 3),
                  last = s.mesh->corner(at.face, (at.local + 2) % 3);
        out.prisms.push_back(
            {prism_around(s, at), s.pinned[next] ? 0.0 : 1.0, s.pinned[last] ? 0.0 : 1.0});
    }
    out.bounds.resize(2 * out.prisms.size());
    return bound_tets(out.prisms.data(), out.prisms.size(), s.b[v].asPointer(), out.bounds.data());
}

/// Damped Gauss-Newton steps on the squares of what the bounds are short of `room`.
Vec3d least_move(const Scratch& bounds, double room, const Vec3d& across,
                 const MendSchedule& schedule)
{
    openvdb::Mat3d stay = openvdb::Mat3d::identity() * schedule.weight_of_staying;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            stay(i, k) += schedule.weight_of_staying_across * across[i] * across[k];
    Vec3d x(0.0);
    for (int step = 0; step < schedule.newton_steps; ++step) {
        const auto [gx, gy, gz, xx, xy, xz, yy, yz, zz] =
            sum_shortfalls(bounds.bounds.data(), bounds.bounds.size(), room, x.asPointer());
        const Vec3d g(gx, gy, gz);
        if (g == Vec3d(0.0))
            break;
        const openvdb::Mat3d h(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        // There always is an inverse: h is a sum of squares, and what is added to it is positive.
        x += (h + stay).inverse(0.0) * g;
    }
    return x;
}

/// Where v should go; where it is if that is good.
Vec3d better_place(const GrowState& s, int v, UntangledTets tets, Scratch& bounds)
{
    const Vec3d& here = s.b[v];
    const double least = tets == UntangledTets::twelve ? list_twelve_bounds(s, v, bounds)
                                                       : list_chosen_bounds(s, v, bounds);
    if (least > kPositive * s.rounding)
        return here;
    const double edge = shortest_inner_edge(s, v);
    const MendSchedule& schedule = s.schedule.mend;
    const double room = std::max(schedule.room * edge, schedule.room_in_roundings * s.rounding);
    Vec3d move = least_move(bounds, room, inner_normal(s, v), schedule);
    const double most =
        schedule.longest_move * edge + schedule.longest_move_in_roundings * s.rounding;
    const double length = move.length();
    if (!std::isfinite(length))
        return here;
    if (length > most)
        move *= most / length;
    return capped(s, v, rounded(here + move));
}

} // namespace

void untangle(GrowState& s, int sweeps, std::vector<std::uint8_t>& look,
              std::vector<std::uint8_t>& moved, UntangledTets tets)
{
    tbb::enumerable_thread_specific<Scratch> scratch;
    const auto visit = [&](int v) {
        if (!look[v])
            return;
        look[v] = 0;
        if (s.pinned[v])
            return;
        const Vec3d x = better_place(s, v, tets, scratch.local());
        // A point that comes to lie on its outer one would be a pin that is not marked as one.
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

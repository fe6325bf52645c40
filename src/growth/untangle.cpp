// SPDX-License-Identifier: Apache-2.0

// Takes: inner points near which tets are inverted. Leaves: fewer of those. Each vertex is moved by
// as little as puts the bounds of its tets right in least squares, with a weight on staying where
// it is: bounds that are at odds with each other, as they are where a whole patch is sheared, must
// not throw it about. Nothing is promised; what is left is found by the exact tests.

#include "growth/untangle.h"

#include "core/lanes.h"
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

/// The bounds of half the tets of one prism, lane by lane: n.(x - here) + value, unit n. A tet that
/// does not count has n = 0 and a value that is always enough.
struct alignas(8 * kDoubleLanes) Bounds4 {
    DoubleLanes x, y, z, value;
};

/// Of one vertex. Kept, for what is made and thrown away here costs as much as all the rest.
struct Scratch {
    std::vector<Bounds4> bounds;
    std::size_t count = 0;

    Bounds4* clear(std::size_t wanted)
    {
        if (bounds.size() < wanted)
            bounds.resize(wanted);
        count = wanted;
        return bounds.data();
    }
    const Bounds4* begin() const { return bounds.data(); }
    const Bounds4* end() const { return bounds.data() + count; }
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

/// The bounds of four tets of a prism; `counts` is 0 for a tet that does not.
VDB_SHELL_LANES_PART void bound(const Bases& bases, const DoubleLanes& counts, Bounds4& out)
{
    constexpr double kEnough = std::numeric_limits<double>::infinity();
    const DoublePoint& p = bases.p;
    DoublePoint u, w;
    for (std::size_t k = 0; k < 3; ++k)
        u[k] = bases.u[k] - p[k], w[k] = bases.w[k] - p[k];
    const DoubleLanes x = u[1] * w[2] - u[2] * w[1], y = u[2] * w[0] - u[0] * w[2],
                      z = u[0] * w[1] - u[1] * w[0], value = -(x * p[0] + y * p[1] + z * p[2]);
    const DoubleLanes squared = (x * x + y * y + z * z) * counts;
    DoubleLanes length;
    for (std::size_t i = 0; i < kDoubleLanes; ++i)
        length[i] = std::sqrt(squared[i]);
    const DoubleLanes inverse = squared > 0 ? 1 / length : DoubleLanes{};
    out.x = x * inverse, out.y = y * inverse, out.z = z * inverse;
    out.value = squared > 0 ? value * inverse : DoubleLanes{} + kEnough;
}

VDB_SHELL_LANES_PART void bound_prism(const GrowState& s, const FaceCorner& at, Bounds4* out)
{
    const int v = s.mesh->corner(at.face, at.local);
    const int next = s.mesh->corner(at.face, (at.local + 1) % 3),
              last = s.mesh->corner(at.face, (at.local + 2) % 3);
    std::array<Bases, 2> half;
    bases_around(s, at, s.b[v], half);
    const double of_next = s.pinned[next] ? 0 : 1, of_last = s.pinned[last] ? 0 : 1;
    bound(half[0], DoubleLanes{1, of_next, of_last, 1}, out[0]);
    bound(half[1], DoubleLanes{of_last, 1, of_next, 1}, out[1]);
}

/// The bounds of the twelve tets of each prism around v; gives back the least value of one.
VDB_SHELL_TWO_TARGETS double list_bounds(const GrowState& s, int v, Scratch& out)
{
    const Slice<FaceCorner> fan = star(*s.mesh, v);
    Bounds4* of_prism = out.clear(2 * static_cast<std::size_t>(fan.size()));
    DoubleLanes least = DoubleLanes{} + std::numeric_limits<double>::infinity();
    for (const FaceCorner& at : fan) {
        bound_prism(s, at, of_prism);
        for (const Bounds4* b : {of_prism, of_prism + 1})
            least = b->value < least ? b->value : least;
        of_prism += 2;
    }
    return std::min({least[0], least[1], least[2], least[3]});
}

VDB_SHELL_LANES_PART double sum(const DoubleLanes& lanes)
{
    return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

/// Gradient and curvature, by columns of the lower triangle, of half the squares of what the bounds
/// are short of `room` at x.
struct Shortfall {
    DoubleLanes gx{}, gy{}, gz{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};

VDB_SHELL_LANES_PART void add_shortfall(const Bounds4& b, const Vec3d& x, double room,
                                        Shortfall& shortfall)
{
    const DoubleLanes open = room - b.value - (b.x * x[0] + b.y * x[1] + b.z * x[2]);
    const DoubleLanes by = open > 0 ? open : DoubleLanes{};
    const DoubleLanes nx = open > 0 ? b.x : DoubleLanes{}, ny = open > 0 ? b.y : DoubleLanes{},
                      nz = open > 0 ? b.z : DoubleLanes{};
    shortfall.gx += by * nx, shortfall.gy += by * ny, shortfall.gz += by * nz;
    shortfall.xx += nx * nx, shortfall.xy += nx * ny, shortfall.xz += nx * nz;
    shortfall.yy += ny * ny, shortfall.yz += ny * nz, shortfall.zz += nz * nz;
}

/// Damped Gauss-Newton steps on the squares of what the bounds are short of `room`.
VDB_SHELL_TWO_TARGETS Vec3d least_move(const Scratch& bounds, double room, const Vec3d& across,
                                       const MendSchedule& schedule)
{
    openvdb::Mat3d stay = openvdb::Mat3d::identity() * schedule.weight_of_staying;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            stay(i, k) += schedule.weight_of_staying_across * across[i] * across[k];
    Vec3d x(0.0);
    for (int step = 0; step < schedule.newton_steps; ++step) {
        Shortfall shortfall;
        for (const Bounds4& b : bounds)
            add_shortfall(b, x, room, shortfall);
        const Vec3d g(sum(shortfall.gx), sum(shortfall.gy), sum(shortfall.gz));
        if (g == Vec3d(0.0))
            break;
        const double xy = sum(shortfall.xy), xz = sum(shortfall.xz), yz = sum(shortfall.yz);
        const openvdb::Mat3d h(sum(shortfall.xx), xy, xz, xy, sum(shortfall.yy), yz, xz, yz,
                               sum(shortfall.zz));
        x += (h + stay).inverse(0.0) * g;
    }
    return x;
}

/// Where v should go; where it is if that is good.
Vec3d better_place(const GrowState& s, int v, Scratch& bounds)
{
    const Vec3d& here = s.b[v];
    if (list_bounds(s, v, bounds) > kPositive * s.rounding)
        return here;
    const MendSchedule& schedule = s.schedule.mend;
    const double edge = shortest_inner_edge(s, v);
    const double room = std::max(schedule.room * edge, schedule.room_in_roundings * s.rounding);
    Vec3d move = least_move(bounds, room, inner_normal(s, v), schedule);
    const double most =
        schedule.longest_move * edge + schedule.longest_move_in_roundings * s.rounding;
    const double length = move.length();
    if (length > most)
        move *= most / length;
    return capped(s, v, rounded(here + move));
}

} // namespace

void untangle(GrowState& s, int sweeps, std::vector<std::uint8_t>& look,
              std::vector<std::uint8_t>& moved)
{
    tbb::enumerable_thread_specific<Scratch> scratch;
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

// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/untangle.h"

#include "core/lanes.h"
#include "core/parallel.h"
#include "shell/grow/move_tests.h"

#include <openvdb/math/Mat3.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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
/// where a whole patch is sheared, should not throw a vertex about. More of it across the inner
/// surface: most of what is wrong can be put right along it, where nothing is lost.
constexpr double kStay = 1.0, kStayAcross = 10.0;
constexpr int kSteps = 6; ///< while the bounds that are not kept change

// Doubles: what is still positive is decided by less than floats can tell.
// Four, not eight: what the processor does not have in one piece goes through memory.
constexpr std::size_t kDoubles = 4;
using Doubles __attribute__((vector_size(8 * kDoubles))) = double;

/// The bounds of half the tets of one prism, lane by lane: n.(x - here) + value, unit n. A tet that
/// does not count has n = 0 and a value that is always enough.
struct alignas(8 * kDoubles) Bounds4 {
    Doubles x, y, z, value;
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

/// Corners of the bases of four tets relative to the vertex, by corner and axis, and 0 for a tet
/// that does not count.
struct alignas(8 * kDoubles) Bases {
    std::array<std::array<std::array<double, kDoubles>, 3>, 3> corner;
    std::array<double, kDoubles> counts;
};

VDB_SHELL_LANES_PART void load(const std::array<double, kDoubles>& from, Doubles& lanes)
{
    std::memcpy(&lanes, from.data(), sizeof lanes);
}

VDB_SHELL_LANES_PART void bound(const Bases& bases, Bounds4& out)
{
    constexpr double kEnough = std::numeric_limits<double>::infinity();
    std::array<Doubles, 3> p, u, w;
    for (std::size_t k = 0; k < 3; ++k) {
        load(bases.corner[0][k], p[k]);
        load(bases.corner[1][k], u[k]);
        load(bases.corner[2][k], w[k]);
        u[k] -= p[k], w[k] -= p[k];
    }
    const Doubles x = u[1] * w[2] - u[2] * w[1], y = u[2] * w[0] - u[0] * w[2],
                  z = u[0] * w[1] - u[1] * w[0], value = -(x * p[0] + y * p[1] + z * p[2]);
    Doubles counts;
    load(bases.counts, counts);
    const Doubles squared = (x * x + y * y + z * z) * counts;
    Doubles length;
    for (std::size_t i = 0; i < kDoubles; ++i)
        length[i] = std::sqrt(squared[i]);
    const Doubles inverse = squared > 0 ? 1 / length : Doubles{};
    out.x = x * inverse, out.y = y * inverse, out.z = z * inverse;
    out.value = squared > 0 ? value * inverse : Doubles{} + kEnough;
}

VDB_SHELL_LANES_PART void bound_prism(const GrowState& s, const FaceCorner& at, Bounds4* out)
{
    const Vec3I& face = s.mesh->faces[at.face];
    const Vec3d& here = s.b[face[at.local]];
    std::array<Vec3d, 6> corner;
    std::array<double, 3> counts;
    for (int k = 0; k < 3; ++k) {
        corner[k] = s.a[face[k]] - here;
        corner[3 + k] = s.b[face[k]] - here;
        counts[k] = s.pinned[face[k]] ? 0.0 : 1.0;
    }
    const TetFromInner* tet = tables().from_b[kTwelve][at.local].data();
    for (std::size_t half = 0; half < 2; ++half, tet += kDoubles) {
        Bases bases;
        for (std::size_t i = 0; i < kDoubles; ++i) {
            bases.counts[i] = counts[tet[i].pillar];
            for (std::size_t c = 0; c < 3; ++c)
                for (int k = 0; k < 3; ++k)
                    bases.corner[c][k][i] = corner[tet[i].base[c]][k];
        }
        bound(bases, out[half]);
    }
}

/// The bounds of the twelve tets of each prism around v; gives back the least value of one.
VDB_SHELL_TWO_TARGETS double list_bounds(const GrowState& s, int v, std::vector<Bounds4>& out)
{
    const Slice<FaceCorner> fan = star(*s.mesh, v);
    out.resize(2 * static_cast<std::size_t>(fan.size()));
    Doubles least = Doubles{} + std::numeric_limits<double>::infinity();
    for (int f = 0; f < fan.size(); ++f) {
        Bounds4* const of_prism = out.data() + 2 * static_cast<std::size_t>(f);
        bound_prism(s, fan.first[f], of_prism);
        for (const Bounds4* b : {of_prism, of_prism + 1})
            least = b->value < least ? b->value : least;
    }
    return std::min({least[0], least[1], least[2], least[3]});
}

VDB_SHELL_LANES_PART double sum(const Doubles& lanes)
{
    return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

/// Gradient and curvature, by columns of the lower triangle, of half the squares of what the bounds
/// lack of `room` at x.
struct Lack {
    Doubles gx{}, gy{}, gz{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
};

VDB_SHELL_LANES_PART void add_lack(const Bounds4& b, const Vec3d& x, double room, Lack& lack)
{
    const Doubles open = room - b.value - (b.x * x[0] + b.y * x[1] + b.z * x[2]);
    const Doubles by = open > 0 ? open : Doubles{};
    const Doubles nx = open > 0 ? b.x : Doubles{}, ny = open > 0 ? b.y : Doubles{},
                  nz = open > 0 ? b.z : Doubles{};
    lack.gx += by * nx, lack.gy += by * ny, lack.gz += by * nz;
    lack.xx += nx * nx, lack.xy += nx * ny, lack.xz += nx * nz;
    lack.yy += ny * ny, lack.yz += ny * nz, lack.zz += nz * nz;
}

/// Damped Gauss-Newton steps on the squares of what the bounds lack of `room`.
VDB_SHELL_TWO_TARGETS Vec3d least_move(const std::vector<Bounds4>& bounds, double room,
                                       const Vec3d& across)
{
    openvdb::Mat3d stay = openvdb::Mat3d::identity() * kStay;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k)
            stay(i, k) += kStayAcross * across[i] * across[k];
    Vec3d x(0.0);
    for (int step = 0; step < kSteps; ++step) {
        Lack lack;
        for (const Bounds4& b : bounds)
            add_lack(b, x, room, lack);
        const Vec3d g(sum(lack.gx), sum(lack.gy), sum(lack.gz));
        if (g == Vec3d(0.0))
            break;
        const double xy = sum(lack.xy), xz = sum(lack.xz), yz = sum(lack.yz);
        const openvdb::Mat3d h(sum(lack.xx), xy, xz, xy, sum(lack.yy), yz, xz, yz, sum(lack.zz));
        x += (h + stay).inverse(0.0) * g;
    }
    return x;
}

/// Where v should go; where it is if that is good.
Vec3d better_place(const GrowState& s, int v, std::vector<Bounds4>& bounds)
{
    const Vec3d& here = s.b[v];
    if (list_bounds(s, v, bounds) > kPositive * s.rounding)
        return here;
    const double edge = shortest_inner_edge(s, v);
    Vec3d move = least_move(bounds, std::max(kRoom * edge, kRoomInRoundings * s.rounding),
                            inner_normal(s, v));
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
    tbb::enumerable_thread_specific<std::vector<Bounds4>> scratch;
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

// SPDX-License-Identifier: Apache-2.0

// Takes: the half-spaces that a vertex is to stay in, and the direction in which volume is won.
// Gives: about where its convex problem has its minimum, by damped Newton steps. In float32 and a
// few steps, because nothing rests on it: every move is tested exactly afterwards (docs/theory.md,
// "Barrier"). Positions are relative to the vertex and in units of its trust radius, so that floats
// have their digits where the move is. Eight bounds make a block; sums over a block have one order,
// so the result is the same on every processor (core/simd.h).

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "growth/barrier.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/simd-inl.h"
#include "core/symmetric.h"
#include "growth/barrier.h"

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace vdb_shell::growth
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;
using Block = LinearBounds::Block;

// More steps change neither fill nor time much: the neighbours move before the vertex's next turn.
constexpr int kNewtonSteps = 3;
// Newton decrements. Below the first full steps converge quadratically, as they do for every
// self-concordant function (Boyd and Vandenberghe 2004, "Convex Optimization", 9.6); below the
// second it has converged.
constexpr double kDamped = 0.25;
constexpr double kConverged = 0.05;

/// Where x + t dx leaves the ball. Precondition: x lies in it.
HWY_INLINE double room_in_ball(const Ball& ball, const Vec3d& x, const Vec3d& dx)
{
    const Vec3d arm = x - ball.centre;
    const double a = dx.lengthSqr(), b = arm.dot(dx);
    const double c = ball.radius * ball.radius - arm.lengthSqr();
    if (!std::isfinite(c) || c <= 0 || !(a > 0))
        return std::numeric_limits<double>::max();
    const double root = std::sqrt(b * b + a * c);
    return b > 0 ? c / (root + b) : (root - b) / a;
}

/// Adds gradient and curvature of -log(r^2 - |x - c|^2), whose weight is that of one tet. An
/// infinite radius, and a vertex that is not inside, mean that there is no such bound.
HWY_INLINE void add_ball(const Ball& ball, const Vec3d& x, Vec3d& gradient, Symmetric& h)
{
    const Vec3d arm = x - ball.centre;
    const double room = ball.radius * ball.radius - arm.lengthSqr();
    if (!std::isfinite(room) || room <= 0)
        return;
    const Vec3d n = arm * (2 / room);
    gradient += n;
    h.xx += 2 / room + n[0] * n[0], h.yy += 2 / room + n[1] * n[1], h.zz += 2 / room + n[2] * n[2];
    h.xy += n[0] * n[1], h.xz += n[0] * n[2], h.yz += n[1] * n[2];
}

/// LinearBounds::add_prism, of corners relative to the vertex. prism_lanes.cpp has the same bases
/// in doubles, four at a time, where a sign is to be proven; a hint can do with floats, of which
/// eight are one block of bounds.
void bound_prism(const std::array<Vec3d, 5>& corner, const Vec3d& here, double scale, Block& out)
{
    // By axis; the last three lanes are not picked.
    FloatPoint p, u, w;
    for (int k = 0; k < 3; ++k) {
        const Doubles first =
            (four(corner[0][k], corner[1][k], corner[2][k], corner[3][k]) - here[k]) * scale;
        const Floats at(to_floats(first),
                        Floats::Half(static_cast<float>((corner[4][k] - here[k]) * scale)));
        const auto axis = static_cast<std::size_t>(k);
        // The bases of PrismTables, in an order of their own. The nearest corner comes first, an
        // inner one if there is one, for floats are relative to the vertex.
        p[axis] = pick<4, 4, 4, 2, 4, 3, 3, 4>(at);
        u[axis] = pick<3, 3, 1, 1, 3, 0, 1, 1>(at) - p[axis];
        w[axis] = pick<0, 1, 2, 0, 2, 2, 2, 0>(at) - p[axis];
    }
    const Floats x = u[1] * w[2] - u[2] * w[1], y = u[2] * w[0] - u[0] * w[2],
                 z = u[0] * w[1] - u[1] * w[0];
    const Floats squared = x * x + y * y + z * z, value = -(x * p[0] + y * p[1] + z * p[2]);
    // A base without area has no normal. The tiny number keeps its quotient finite; the value is
    // nought then, and the bound gets no weight.
    constexpr float kTiny = 1e-30F;
    const Floats zero(0.0F), one(1.0F), inverse = one / (square_root(squared) + kTiny);
    const auto counts = value > zero;
    store(x * inverse, out.x.data());
    store(y * inverse, out.y.data());
    store(z * inverse, out.z.data());
    store(select(counts, value * inverse, one), out.value.data());
    store(select(counts, one, zero), out.weight.data());
}

/// A direction across a block of bounds.
struct Normals {
    Floats x, y, z;
    HWY_INLINE explicit Normals(const Block& b)
        : x(Floats::load(b.x.data())), y(Floats::load(b.y.data())), z(Floats::load(b.z.data()))
    {
    }
    HWY_INLINE Floats dot(const Vec3s& d) const { return x * d[0] + y * d[1] + z * d[2]; }
};

HWY_INLINE double wide_sum(Floats x)
{
    return static_cast<double>(sum_of(x));
}

/// Adds gradient and curvature of the logarithms.
HWY_INLINE void add_logarithms(const Block* first, const Block* last, Vec3d& gradient, Symmetric& h)
{
    Floats gx(0.0F), gy(0.0F), gz(0.0F), xx(0.0F), xy(0.0F), xz(0.0F), yy(0.0F), yz(0.0F), zz(0.0F);
    for (const Block* b = first; b != last; ++b) {
        const Floats inverse = 1.0F / Floats::load(b->value.data());
        const Normals n(*b);
        const Floats x = n.x * inverse, y = n.y * inverse, z = n.z * inverse;
        const Floats weight = Floats::load(b->weight.data());
        const Floats wx = weight * x, wy = weight * y, wz = weight * z;
        gx += wx, gy += wy, gz += wz;
        xx += wx * x, xy += wx * y, xz += wx * z;
        yy += wy * y, yz += wy * z, zz += wz * z;
    }
    gradient -= Vec3d(wide_sum(gx), wide_sum(gy), wide_sum(gz));
    h = {wide_sum(xx), wide_sum(xy), wide_sum(xz), wide_sum(yy), wide_sum(yz), wide_sum(zz)};
}

/// How far along d the first bound is met.
HWY_INLINE double room_along(const Block* first, const Block* last, const Vec3s& d, double room)
{
    Floats least(std::numeric_limits<float>::max());
    for (const Block* b = first; b != last; ++b) {
        // A bound that d leads away from, and a lane that is not used, must not end the step: the
        // tiny slope makes their room too large to be the least.
        Floats down = -Normals(*b).dot(d);
        raise_to(down, Floats(1e-30F));
        lower_to(least, Floats::load(b->value.data()) / down);
    }
    alignas(kLanesAlignment) std::array<float, kLanes> rooms;
    store(least, rooms.data());
    for (const float of_lane : rooms)
        room = std::min(room, static_cast<double>(of_lane));
    return room;
}

HWY_INLINE void move_by(const Vec3s& d, Block* first, Block* last)
{
    const Floats zero(0.0F), one(1.0F);
    for (Block* b = first; b != last; ++b) {
        const Floats value = Floats::load(b->value.data()) + Normals(*b).dot(d);
        // A step of 1 / (1 + decrement) stays inside as long as all weights are 1 or more. Planes
        // may weigh less, and floats round: a bound that was overstepped no longer counts, and the
        // value of 1 keeps later quotients finite.
        const auto kept = value > zero;
        store(select(kept, Floats::load(b->weight.data()), zero), b->weight.data());
        store(select(kept, value, one), b->value.data());
    }
}

/// Newton's method in the bounds' own scale, from the origin; the position is held as values of the
/// bounds.
void newton_minimum(Block* first, Block* last, const Ball& ball, const Vec3d& gradient, Vec3d& x)
{
    x = Vec3d(0.0);
    for (int step = 0; step < kNewtonSteps; ++step) {
        Vec3d g = gradient, dx;
        Symmetric h{};
        add_logarithms(first, last, g, h);
        add_ball(ball, x, g, h);
        const double trace = h.xx + h.yy + h.zz;
        if (!(trace > 0))
            break;
        // The bounds may leave a direction free, in which the curvature is nought. So small a share
        // of the trace makes the matrix positive and hardly changes the step in the other
        // directions.
        h.xx += 1e-9 * trace, h.yy += 1e-9 * trace, h.zz += 1e-9 * trace;
        if (!solve_positive(h, -g, dx))
            break;
        const double decrement = std::sqrt(std::max(0.0, -g.dot(dx)));
        const double damped = decrement > kDamped ? 1 / (1 + decrement) : 1;
        // Far from the centre a longer step pays off, as long as it stays well inside every bound.
        const double room = room_along(first, last, Vec3s(dx), room_in_ball(ball, x, dx));
        const double share = std::max(damped, std::min(1.0, 0.7 * room));
        x += share * dx;
        if (decrement < kConverged)
            break;
        move_by(Vec3s(share * dx), first, last);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell::growth
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell::growth
{

HWY_EXPORT(bound_prism);
HWY_EXPORT(newton_minimum);

void LinearBounds::clear(const Vec3d& here, double scale)
{
    block_.clear();
    size_ = 0;
    here_ = here;
    scale_ = 1 / scale;
}

void LinearBounds::add(const Vec3d& n, const Vec3d& p)
{
    const double length = n.length();
    if (!(length > 0))
        return;
    const double inverse = 1 / length;
    add_unit(Vec3s(n * inverse), n.dot(here_ - p) * inverse);
}

void LinearBounds::add_unit(const Vec3s& n, double value)
{
    const float scaled = static_cast<float>(value * scale_);
    if (!(scaled > 0))
        return;
    const std::size_t lane = size_++ % kLanes;
    if (lane == 0) {
        Block& empty = block_.emplace_back();
        for (auto* of : {&empty.x, &empty.y, &empty.z, &empty.weight})
            of->fill(0.0F);
        empty.value.fill(1.0F);
    }
    Block& b = block_.back();
    b.x[lane] = n[0], b.y[lane] = n[1], b.z[lane] = n[2];
    b.value[lane] = scaled;
    b.weight[lane] = 1.0f;
}

void LinearBounds::add_prism(const std::array<Vec3d, 5>& corner)
{
    size_ += kLanes;
    VDB_SHELL_KERNEL(bound_prism)(corner, here_, scale_, block_.emplace_back());
}

void LinearBounds::weigh(std::size_t first, float weight)
{
    for (std::size_t i = first; i < size_; ++i)
        block_[i / kLanes].weight[i % kLanes] = weight;
}

Vec3d barrier_minimum(LinearBounds& bounds, const Ball& ball, const Vec3d& gradient, double weight)
{
    // In y = (x - here) scale the volume's gradient is gradient / scale. Dividing the whole problem
    // by the weight of the barrier moves no minimum and leaves each logarithm its own weight.
    const double scale = bounds.scale();
    const Ball scaled{(ball.centre - bounds.here()) * scale, ball.radius * scale};
    LinearBounds::Block* const first = bounds.blocks().data();
    Vec3d x;
    VDB_SHELL_KERNEL(newton_minimum)
    (first, first + bounds.blocks().size(), scaled, gradient / (weight * scale), x);
    return bounds.here() + x / scale;
}

} // namespace vdb_shell::growth
#endif

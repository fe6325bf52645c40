// SPDX-License-Identifier: Apache-2.0

// Takes: the half-spaces that a vertex is to stay in, and the direction in which volume is won.
// Gives: about where its convex problem has its minimum. In float32 and a few steps, because
// nothing rests on it: every move is tested exactly afterwards (docs/theory.md, "Barrier").

#include "growth/barrier.h"

#include "core/four_floats.h"
#include "core/lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

// More steps change neither fill nor time much: the neighbours move before the vertex's next turn.
constexpr int kNewtonSteps = 3;
// Newton decrements. Below the first full steps converge quadratically, as they do for every
// self-concordant function (Boyd and Vandenberghe 2004, "Convex Optimization", 9.6); below the
// second it has converged.
constexpr double kDamped = 0.25;
constexpr double kConverged = 0.05;

/// Symmetric, by columns of the lower triangle.
struct Curvature {
    double xx, xy, xz, yy, yz, zz;
};

/// Solves h dx = -g by Cholesky; false where h is not safely positive.
bool solve_positive(const Curvature& h, const Vec3d& g, Vec3d& dx)
{
    const double l00 = std::sqrt(h.xx);
    const double l10 = h.xy / l00, l20 = h.xz / l00;
    const double d1 = h.yy - l10 * l10;
    if (!(l00 > 0) || !(d1 > 0))
        return false;
    const double l11 = std::sqrt(d1), l21 = (h.yz - l20 * l10) / l11;
    const double d2 = h.zz - l20 * l20 - l21 * l21;
    if (!(d2 > 0))
        return false;
    const double l22 = std::sqrt(d2);
    const double y0 = -g[0] / l00, y1 = (-g[1] - l10 * y0) / l11;
    const double y2 = (-g[2] - l20 * y0 - l21 * y1) / l22;
    dx[2] = y2 / l22;
    dx[1] = (y1 - l21 * dx[2]) / l11;
    dx[0] = (y0 - l10 * dx[1] - l20 * dx[2]) / l00;
    return true;
}

/// Where x + t dx leaves the ball. Precondition: x lies in it.
double room_in_ball(const Ball& ball, const Vec3d& x, const Vec3d& dx)
{
    const Vec3d arm = x - ball.centre;
    const double a = dx.lengthSqr(), b = arm.dot(dx);
    const double c = ball.radius * ball.radius - arm.lengthSqr();
    if (!std::isfinite(c) || c <= 0 || !(a > 0))
        return std::numeric_limits<double>::max();
    const double root = std::sqrt(b * b + a * c);
    return b > 0 ? c / (root + b) : (root - b) / a;
}

void add_ball(const Ball& ball, const Vec3d& x, Vec3d& gradient, Curvature& h)
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

} // namespace

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
        empty.x = empty.y = empty.z = empty.weight = Lanes{};
        empty.value = Lanes{} + 1.0f;
    }
    Block& b = block_.back();
    b.x[lane] = n[0], b.y[lane] = n[1], b.z[lane] = n[2];
    b.value[lane] = scaled;
    b.weight[lane] = 1.0f;
}

VDB_SHELL_TWO_TARGETS void LinearBounds::add_prism(const std::array<Vec3d, 5>& corner)
{
    // By axis; the last three lanes are not read.
    std::array<Lanes, 3> at;
    for (int k = 0; k < 3; ++k) {
        const DoubleLanes four =
            (DoubleLanes{corner[0][k], corner[1][k], corner[2][k], corner[3][k]} - here_[k]) *
            scale_;
        const FourFloats first = __builtin_convertvector(four, FourFloats),
                         last = vdb_shell::four(
                             static_cast<float>((corner[4][k] - here_[k]) * scale_));
        at[k] = __builtin_shufflevector(first, last, 0, 1, 2, 3, 4, 5, 6, 7);
    }
    std::array<Lanes, 3> p, u, w;
    for (int k = 0; k < 3; ++k) {
        // The bases of PrismTables, in an order of their own. The nearest corner comes first, an
        // inner one if there is one, for floats are relative to the vertex.
        p[k] = __builtin_shufflevector(at[k], at[k], 4, 4, 4, 2, 4, 3, 3, 4);
        u[k] = __builtin_shufflevector(at[k], at[k], 3, 3, 1, 1, 3, 0, 1, 1) - p[k];
        w[k] = __builtin_shufflevector(at[k], at[k], 0, 1, 2, 0, 2, 2, 2, 0) - p[k];
    }
    const Lanes x = u[1] * w[2] - u[2] * w[1], y = u[2] * w[0] - u[0] * w[2],
                z = u[0] * w[1] - u[1] * w[0];
    const Lanes squared = x * x + y * y + z * z, value = -(x * p[0] + y * p[1] + z * p[2]);
    size_ += kLanes;
    Block& b = block_.emplace_back();
    // A base without area has no normal: its value is nought, and it does not count.
    constexpr float kTiny = 1e-30F;
    Lanes length;
    for (std::size_t i = 0; i < kLanes; ++i)
        length[i] = std::sqrt(squared[i]);
    const Lanes inverse = 1.0F / (length + kTiny);
    b.x = x * inverse, b.y = y * inverse, b.z = z * inverse;
    b.value = value > 0 ? value * inverse : Lanes{} + 1.0F;
    b.weight = value > 0 ? Lanes{} + 1.0F : Lanes{};
}

void LinearBounds::weigh(std::size_t first, float weight)
{
    for (std::size_t i = first; i < size_; ++i)
        block_[i / kLanes].weight[i % kLanes] = weight;
}

/// Newton's method in the bounds' own scale; the position is held as values of the bounds.
class Newton
{
public:
    Newton(LinearBounds& bounds, const Ball& ball, const Vec3d& gradient, double weight)
        : bounds_(bounds),
          gradient_(gradient / (weight * bounds.scale_)), ball_{(ball.centre - bounds.here_) *
                                                                    bounds.scale_,
                                                                ball.radius * bounds.scale_}
    {
    }

    Vec3d minimum()
    {
        for (int step = 0; step < kNewtonSteps; ++step) {
            Vec3d g, dx;
            Curvature h{};
            slope(g, h);
            const double trace = h.xx + h.yy + h.zz;
            if (!(trace > 0))
                break;
            // The bounds may leave a direction free.
            h.xx += 1e-9 * trace, h.yy += 1e-9 * trace, h.zz += 1e-9 * trace;
            if (!solve_positive(h, g, dx))
                break;
            const double decrement = std::sqrt(std::max(0.0, -g.dot(dx)));
            const double damped = decrement > kDamped ? 1 / (1 + decrement) : 1;
            // Far from the centre a longer step pays off, as long as it stays well inside every
            // bound.
            const double share = std::max(damped, std::min(1.0, 0.7 * room_along(dx)));
            x_ += share * dx;
            if (decrement < kConverged)
                break;
            move_by(share * dx);
        }
        return bounds_.here_ + x_ / bounds_.scale_;
    }

private:
    static double sum(const Lanes& lane)
    {
        std::array<float, 4> four;
        for (std::size_t i = 0; i < 4; ++i)
            four[i] = lane[i] + lane[i + 4];
        return static_cast<double>((four[0] + four[2]) + (four[1] + four[3]));
    }

    void slope(Vec3d& gradient, Curvature& h) const
    {
        Lanes gx{}, gy{}, gz{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
        for (const LinearBounds::Block& b : bounds_.block_) {
            const Lanes inverse = 1.0f / b.value;
            const Lanes x = b.x * inverse, y = b.y * inverse, z = b.z * inverse;
            const Lanes wx = b.weight * x, wy = b.weight * y, wz = b.weight * z;
            gx += wx, gy += wy, gz += wz;
            xx += wx * x, xy += wx * y, xz += wx * z;
            yy += wy * y, yz += wy * z, zz += wz * z;
        }
        gradient = gradient_ - Vec3d(sum(gx), sum(gy), sum(gz));
        h = {sum(xx), sum(xy), sum(xz), sum(yy), sum(yz), sum(zz)};
        add_ball(ball_, x_, gradient, h);
    }

    /// How far along dx the first bound is met.
    double room_along(const Vec3d& dx) const
    {
        const Vec3s d(dx);
        Lanes least = Lanes{} + std::numeric_limits<float>::max();
        for (const LinearBounds::Block& b : bounds_.block_) {
            // Of the values over the slopes only the positive ones are ahead.
            Lanes down = -(b.x * d[0] + b.y * d[1] + b.z * d[2]);
            raise_to(down, Lanes{} + 1e-30f);
            lower_to(least, b.value / down);
        }
        double room = room_in_ball(ball_, x_, dx);
        for (std::size_t i = 0; i < kLanes; ++i)
            room = std::min(room, static_cast<double>(least[i]));
        return room;
    }

    void move_by(const Vec3d& dx)
    {
        const Vec3s d(dx);
        for (LinearBounds::Block& b : bounds_.block_) {
            const Lanes value = b.value + (b.x * d[0] + b.y * d[1] + b.z * d[2]);
            // A bound overstepped by a damped step no longer counts.
            b.weight = value > 0 ? b.weight : Lanes{};
            b.value = value > 0 ? value : Lanes{} + 1.0f;
        }
    }

    LinearBounds& bounds_;
    Vec3d gradient_, x_{0.0};
    Ball ball_;
};

VDB_SHELL_TWO_TARGETS Vec3d barrier_minimum(LinearBounds& bounds, const Ball& ball,
                                            const Vec3d& gradient, double weight)
{
    return Newton(bounds, ball, gradient, weight).minimum();
}

} // namespace vdb_shell::growth

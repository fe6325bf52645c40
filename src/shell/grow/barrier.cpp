// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/barrier.h"

#include <openvdb/math/Mat3.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

using openvdb::math::Mat3d;

constexpr int kNewtonSteps = 6;
// Newton decrements: above the first the damped step is needed, below the second it has converged.
constexpr double kDamped = 0.25;
constexpr double kConverged = 0.05;

/// Solves h dx = -g by Cholesky; false where h is not safely positive.
bool solve_positive(const Mat3d& h, const Vec3d& g, Vec3d& dx)
{
    const double l00 = std::sqrt(h[0][0]);
    const double l10 = h[1][0] / l00, l20 = h[2][0] / l00;
    const double d1 = h[1][1] - l10 * l10;
    if (!(l00 > 0) || !(d1 > 0))
        return false;
    const double l11 = std::sqrt(d1), l21 = (h[2][1] - l20 * l10) / l11;
    const double d2 = h[2][2] - l20 * l20 - l21 * l21;
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

struct Slope {
    Vec3d gradient;
    Mat3d curvature;
};

void add_ball(const Ball& ball, double softness, const Vec3d& x, Slope& s)
{
    const Vec3d arm = x - ball.centre;
    const double room = ball.radius * ball.radius - arm.lengthSqr();
    if (!std::isfinite(room) || room <= 0)
        return;
    const Vec3d n = arm * (2 / room);
    s.gradient += softness * n;
    for (int i = 0; i < 3; ++i) {
        s.curvature[i][i] += softness * 2 / room;
        for (int j = 0; j < 3; ++j)
            s.curvature[i][j] += softness * n[i] * n[j];
    }
}

Slope slope_at(const std::vector<HalfSpace>& bounds, const Ball& ball, const Vec3d& gradient,
               double softness, const Vec3d& x)
{
    Slope s{gradient, Mat3d(0, 0, 0, 0, 0, 0, 0, 0, 0)};
    for (const HalfSpace& bound : bounds) {
        const double value = bound.value(x);
        if (value <= 0)
            continue;
        const Vec3d n = bound.n / value;
        s.gradient -= softness * n;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                s.curvature[i][j] += softness * n[i] * n[j];
    }
    add_ball(ball, softness, x, s);
    return s;
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

/// How far along dx the first bound is met.
double room_along(const std::vector<HalfSpace>& bounds, const Ball& ball, const Vec3d& x,
                  const Vec3d& dx)
{
    double room = room_in_ball(ball, x, dx);
    for (const HalfSpace& bound : bounds) {
        const double down = -bound.n.dot(dx), value = bound.value(x);
        if (down > 0 && value > 0)
            room = std::min(room, value / down);
    }
    return room;
}

} // namespace

Vec3d barrier_minimum(const std::vector<HalfSpace>& bounds, const Ball& ball, const Vec3d& gradient,
                      double softness, const Vec3d& start)
{
    Vec3d x = start;
    for (int step = 0; step < kNewtonSteps; ++step) {
        Slope s = slope_at(bounds, ball, gradient, softness, x);
        const double trace = s.curvature[0][0] + s.curvature[1][1] + s.curvature[2][2];
        if (!(trace > 0))
            break;
        for (int i = 0; i < 3; ++i)
            s.curvature[i][i] += 1e-9 * trace; // bounds may leave a direction free
        Vec3d dx;
        if (!solve_positive(s.curvature, s.gradient, dx))
            break;
        const double decrement = std::sqrt(std::max(0.0, -s.gradient.dot(dx) / softness));
        const double damped = decrement > kDamped ? 1 / (1 + decrement) : 1;
        // Far from the centre a longer step pays off, as long as it stays well inside every bound.
        x += std::max(damped, std::min(1.0, 0.7 * room_along(bounds, ball, x, dx))) * dx;
        if (decrement < kConverged)
            break;
    }
    return x;
}

} // namespace vdb_shell::growth

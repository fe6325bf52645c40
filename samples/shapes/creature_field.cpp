// SPDX-License-Identifier: Apache-2.0
#include "shapes/creature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

namespace vdb_shell::samples
{

namespace
{

using openvdb::Vec3d;

// Parts within these distances of their middles. Further off, beyond the width of any seam, the
// distance to that ball stands in for the part, to save time.
constexpr double kLegReach = 0.5;
constexpr double kHeadReach = 0.95;

/// Union and difference that round the seam over a width of about k.
double join(double a, double b, double k)
{
    const double h = std::max(k - std::abs(a - b), 0.0) / k;
    return std::min(a, b) - 0.25 * h * h * k;
}
double carve(double a, double tool, double k)
{
    return -join(-a, tool, k);
}

/// First-order distance: exact enough near the surface, which is all that meshing looks at.
double ellipsoid(const Vec3d& p, const Vec3d& centre, const Vec3d& radii)
{
    const Vec3d q = p - centre;
    const double k0 = (q / radii).length(), k1 = (q / (radii * radii)).length();
    return k1 > 0.0 ? k0 * (k0 - 1.0) / k1 : -std::min({radii[0], radii[1], radii[2]});
}

/// A rod whose radius changes linearly from one end to the other.
double limb(const Vec3d& p, const Vec3d& a, const Vec3d& b, double radius_a, double radius_b)
{
    const Vec3d along = b - a;
    const double t = std::clamp((p - a).dot(along) / along.dot(along), 0.0, 1.0);
    return (p - a - along * t).length() - (radius_a + (radius_b - radius_a) * t);
}

/// 1 at 0, falling smoothly to 0 at +-1.
double bump(double x)
{
    const double s = std::max(1.0 - x * x, 0.0);
    return s * s;
}

double torso(const Vec3d& p)
{
    double d = ellipsoid(p, {0, 0.64, 0.24}, {0.33, 0.34, 0.42});
    d = join(d, ellipsoid(p, {0.01, 0.58, -0.20}, {0.36, 0.35, 0.44}), 0.2);
    d = join(d, ellipsoid(p, {0.01, 0.60, -0.52}, {0.27, 0.28, 0.28}), 0.15);
    return join(d, limb(p, {0, 0.78, 0.46}, {0, 1.04, 0.68}, 0.24, 0.20), 0.15);
}

/// `side` is +1 for the creature's left (+x). The two sides stand a step apart.
double leg(const Vec3d& p, double side, bool front)
{
    const double step = front ? 0.07 * side : -0.06 * side;
    const double z = (front ? 0.40 : -0.46) + step;
    if (const double away = (p - Vec3d(0.3 * side, 0.3, z)).length(); away > 0.75)
        return away - kLegReach;
    const Vec3d hip(0.25 * side, front ? 0.52 : 0.50, front ? 0.34 : -0.44);
    const Vec3d knee(0.33 * side, 0.30, z + (front ? -0.05 : 0.07));
    const Vec3d ankle(0.32 * side, 0.13, z);
    double d = limb(p, hip, knee, front ? 0.18 : 0.22, 0.125);
    d = join(d, limb(p, knee, ankle, 0.125, 0.095), 0.06);
    d = join(d, ellipsoid(p, {0.33 * side, 0.085, z + 0.06}, {0.125, 0.085, 0.16}), 0.05);
    for (const double toe : {-1.0, 0.0, 1.0}) {
        const Vec3d tip((0.33 + 0.085 * toe) * side, 0.062, z + 0.205 - 0.03 * toe * toe);
        d = join(d, ellipsoid(p, tip, {0.052, 0.06, 0.085}), 0.025);
    }
    return d;
}

double tail(const Vec3d& p)
{
    struct Knot {
        Vec3d at;
        double radius;
    };
    static const std::array<Knot, 7> knots{{{{0.00, 0.56, -0.60}, 0.20},
                                            {{0.03, 0.47, -0.86}, 0.145},
                                            {{0.10, 0.46, -1.10}, 0.105},
                                            {{0.19, 0.55, -1.30}, 0.08},
                                            {{0.26, 0.71, -1.41}, 0.066},
                                            {{0.29, 0.89, -1.43}, 0.056},
                                            {{0.27, 1.04, -1.37}, 0.048}}};
    double d = 1e3;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
        d = join(d, limb(p, knots[i].at, knots[i + 1].at, knots[i].radius, knots[i + 1].radius),
                 0.04);
    // A leaf at the end: two blades.
    d = join(d, ellipsoid(p, {0.26, 1.16, -1.37}, {0.035, 0.14, 0.09}), 0.04);
    return join(d, ellipsoid(p, {0.25, 1.22, -1.27}, {0.033, 0.08, 0.12}), 0.03);
}

/// A thin sail along the back, scalloped between its four rays.
double fin(const Vec3d& p)
{
    double d = ellipsoid(p, {0.005, 0.84, -0.14}, {0.046, 0.38, 0.54});
    struct Scallop {
        double y, z, radius;
    };
    static const std::array<Scallop, 4> scallops{
        {{1.25, 0.20, 0.13}, {1.34, -0.09, 0.15}, {1.27, -0.38, 0.14}, {1.10, -0.62, 0.13}}};
    for (const Scallop& s : scallops) {
        const double dy = p[1] - s.y, dz = p[2] - s.z;
        d = carve(d, std::sqrt(dy * dy + dz * dz) - s.radius, 0.05);
    }
    return d;
}

/// A cupped leaf. The right one droops.
double ear(const Vec3d& p, double side)
{
    const Vec3d root(0.25 * side, 1.40, 0.72);
    const Vec3d along =
        Vec3d((side > 0 ? 0.72 : 0.88) * side, side > 0 ? 0.62 : 0.34, -0.18).unit();
    const Vec3d across = Vec3d(0.1 * side, 0.2, 1.0).cross(along).unit();
    const Vec3d facing = along.cross(across) * (across[1] > 0 ? side : -side);
    const Vec3d q = p - root;
    const Vec3d local(q.dot(along), q.dot(across), q.dot(facing));
    const double leaf = ellipsoid(local, {0.27, 0, 0}, {0.36, 0.19, 0.085});
    const double hollow = ellipsoid(local, {0.30, 0, 0.085}, {0.31, 0.15, 0.10});
    return carve(leaf, hollow, 0.03);
}

/// Bulging eyes, each with a heavy upper lid that leaves a fold on the ball.
double eyes(double d, const Vec3d& p)
{
    for (const double side : {-1.0, 1.0}) {
        const Vec3d centre(0.19 * side, 1.30, 1.03);
        const Vec3d up = Vec3d(-0.1 * side, 0.85, 0.1).unit();
        const double from_ball = (p - centre).length();
        d = join(d, from_ball - 0.115, 0.03);
        d = join(d, carve(from_ball - 0.140, (p - centre).dot(up) - 0.035, 0.02), 0.03);
    }
    return d;
}

double head(const Vec3d& p)
{
    if (const double away = (p - Vec3d(0, 1.3, 0.9)).length(); away > 1.1)
        return away - kHeadReach;
    double d = ellipsoid(p, {0, 1.22, 0.82}, {0.36, 0.30, 0.33});
    d = join(d, ellipsoid(p, {0, 1.10, 1.13}, {0.23, 0.155, 0.23}), 0.12);
    d = join(d, ellipsoid(p, {0, 0.985, 1.07}, {0.185, 0.085, 0.22}), 0.08);
    for (const double side : {-1.0, 1.0}) {
        d = join(d, ellipsoid(p, {0.2 * side, 1.10, 0.96}, {0.15, 0.12, 0.15}), 0.08);
        d = join(d, ear(p, side), 0.05);
    }
    // A slit that rises towards the cheeks: the creature smiles.
    const Vec3d mouth(p[0], p[1] - 1.06 - 0.9 * p[0] * p[0], p[2]);
    d = carve(d, ellipsoid(mouth, {0, 0, 1.20}, {0.285, 0.036, 0.22}), 0.07);
    for (const double side : {-1.0, 1.0})
        d = carve(d, ellipsoid(p, {0.075 * side, 1.185, 1.325}, {0.034, 0.028, 0.05}), 0.03);
    return eyes(d, p);
}

/// The head looks a little to its left (a 7-24-25 turn) about the neck.
Vec3d turned_head(const Vec3d& p)
{
    const double z = p[2] - 0.6;
    return {0.96 * p[0] - 0.28 * z, p[1], 0.28 * p[0] + 0.96 * z + 0.6};
}

/// Depth of the skin folds around neck and tail root: each is a ring across an axis.
double folds(const Vec3d& p)
{
    double depth = 0.0;
    const Vec3d neck = Vec3d(0.0, 0.76, 0.65);
    for (const double at : {0.955, 1.08})
        depth += 0.05 * bump((p.dot(neck) - at) / 0.075) * bump((p[1] - 0.86) / 0.42) *
                 bump((p[2] - 0.52) / 0.5);
    for (const double at : {-0.73, -0.85, -0.97})
        depth += 0.028 * bump((p[2] - at) / 0.06) * bump((p[1] - 0.5) / 0.35);
    return depth;
}

} // namespace

double creature_field(const Vec3d& position)
{
    double d = join(torso(position), tail(position), 0.1);
    for (const double side : {-1.0, 1.0})
        for (const bool front : {false, true})
            d = join(d, leg(position, side, front), 0.07);
    d += folds(position);
    d = join(d, head(turned_head(position)), 0.09);
    return join(d, fin(position), 0.05);
}

} // namespace vdb_shell::samples

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/shapes.h"

#include <cmath>
#include <functional>
#include <vector>

// Motions of surfaces, given by formula.

namespace vdb_shell::test
{

using Points = std::vector<openvdb::Vec3s>;

inline Points moved(const Points& rest, const std::function<openvdb::Vec3d(openvdb::Vec3d)>& move)
{
    Points posed;
    posed.reserve(rest.size());
    for (const openvdb::Vec3s& p : rest)
        posed.push_back(openvdb::Vec3s(move(openvdb::Vec3d(p))));
    return posed;
}

/// The part beyond z = 0 is turned about x, over a length of 2 `soft` to both sides.
inline openvdb::Vec3d elbow(const openvdb::Vec3d& p, double angle_radians, double soft)
{
    const double share = std::min(1.0, std::max(0.0, 0.5 + p[2] / (2 * soft)));
    const double angle = angle_radians * share * share * (3 - 2 * share);
    const double c = std::cos(angle), s = std::sin(angle);
    return {p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]};
}

/// About z, by so much for each unit of z.
inline openvdb::Vec3d twist(const openvdb::Vec3d& p, double radians_per_unit)
{
    const double angle = radians_per_unit * p[2], c = std::cos(angle), s = std::sin(angle);
    return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
}

/// A rod of round cross section along z, from -2 to 2.
inline TriangleMesh round_rod()
{
    std::vector<openvdb::Vec2d> polygon;
    for (int i = 0; i < 16; ++i)
        polygon.emplace_back(0.5 * std::cos(i * 0.39269908169872414),
                             0.5 * std::sin(i * 0.39269908169872414));
    std::vector<double> heights;
    for (int i = -10; i <= 10; ++i)
        heights.push_back(0.2 * i);
    return extruded(polygon, heights);
}

} // namespace vdb_shell::test

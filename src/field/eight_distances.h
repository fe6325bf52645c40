// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/lanes.h"

#include <openvdb/Types.h>

#include <array>

// Distances from eight points to a triangle at once, in floats, relative to a place nearby.

namespace vdb_shell
{

struct EightPoints {
    Lanes x, y, z;
};

/// A triangle made ready: corners, edges, the edges' normals in its plane (outward) and its own.
struct PreparedTriangle {
    struct Side {
        float x, y, z, ex, ey, ez, inverse, mx, my, mz;
    };
    std::array<Side, 3> side;
    float nx, ny, nz;
    float bias; ///< 1 for a triangle without a normal: no point projects into it
};

inline PreparedTriangle prepare_triangle(const std::array<openvdb::Vec3d, 3>& corner)
{
    PreparedTriangle t{};
    openvdb::Vec3d n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double area = n.length();
    t.bias = area > 0 ? 0.0F : 1.0F;
    n = area > 0 ? n / area : openvdb::Vec3d(0.0);
    t.nx = float(n[0]), t.ny = float(n[1]), t.nz = float(n[2]);
    for (std::size_t k = 0; k < 3; ++k) {
        const openvdb::Vec3d& a = corner[k];
        const openvdb::Vec3d e = corner[(k + 1) % 3] - a, m = e.cross(n);
        const double squared = e.lengthSqr();
        t.side[k] = {float(a[0]),
                     float(a[1]),
                     float(a[2]),
                     float(e[0]),
                     float(e[1]),
                     float(e[2]),
                     squared > 0 ? float(1 / squared) : 0.0F,
                     float(m[0]),
                     float(m[1]),
                     float(m[2])};
    }
    return t;
}

/// Squared distances of the points. `height` is over the triangle's plane, positive along its
/// normal, for points that project into the triangle; 0 for others.
VDB_SHELL_LANES_PART void eight_distances(const PreparedTriangle& t, const EightPoints& p,
                                          Lanes& squared, Lanes& height)
{
    const Lanes zero{}, one = zero + 1.0F;
    Lanes nearest = zero + 3e38F, outside = zero + t.bias, over = zero;
    for (const PreparedTriangle::Side& s : t.side) {
        const Lanes x = p.x - s.x, y = p.y - s.y, z = p.z - s.z;
        Lanes along = (x * s.ex + y * s.ey + z * s.ez) * s.inverse;
        raise_to(along, zero);
        lower_to(along, one);
        const Lanes dx = x - along * s.ex, dy = y - along * s.ey, dz = z - along * s.ez;
        lower_to(nearest, dx * dx + dy * dy + dz * dz);
        raise_to(outside, x * s.mx + y * s.my + z * s.mz);
        over = x * t.nx + y * t.ny + z * t.nz;
    }
    squared = outside > zero ? nearest : over * over;
    height = outside > zero ? zero : over;
}

} // namespace vdb_shell

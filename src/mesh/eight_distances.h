// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/simd.h"

#include <openvdb/Types.h>
#include <openvdb/math/Coord.h>

#include <array>
#include <cstdint>

// Distances from eight points to a triangle at once, in floats, relative to a place nearby.

namespace vdb_shell
{

struct alignas(kLanesAlignment) EightPoints {
    std::array<float, kLanes> x, y, z;
};

/// The first voxel of one of eight blocks, each so many voxels wide, the first at `corner`. A point
/// of each makes eight.
inline openvdb::Coord corner_of_block(const openvdb::Coord& corner, int side, std::size_t i)
{
    return corner.offsetBy(i & 4 ? side : 0, i & 2 ? side : 0, i & 1 ? side : 0);
}

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

/// The nearest of some triangles to each of eight points. `height` is over the triangle's plane,
/// positive along its normal, for a point that projects into the triangle; 0 for others.
struct alignas(kLanesAlignment) EightNearest {
    std::array<float, kLanes> squared, height;
    std::array<std::int32_t, kLanes> triangle;
};

/// Of the triangles that `list` picks, the first where several are as near. `squared`, where not
/// null, gets the squared distances of the eight points to each of the list.
void nearest_of(const PreparedTriangle* triangles, const std::uint32_t* list, std::size_t count,
                const EightPoints& points, float* squared, EightNearest& nearest);

/// For each eight of `squared` the bits of those that are not above their limit.
void list_within(const float* squared, std::size_t count, const std::array<float, kLanes>& limit,
                 std::uint8_t* bits);

} // namespace vdb_shell

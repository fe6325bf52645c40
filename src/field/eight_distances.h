// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstddef>
#include <cstdint>

// Distances from eight points to a triangle at once, in floats. They choose the nearest triangle;
// the distance that is stored is then computed in doubles.

namespace vdb_shell
{

inline constexpr std::size_t kLanes = 8;

/// GCC's and Clang's vectors: loops over arrays were left scalar by the compiler, at a quarter of
/// the speed.
using Four __attribute__((vector_size(16))) = float;
using FourIndices __attribute__((vector_size(16))) = std::int32_t;
template <typename Vector> using Pair = std::array<Vector, 2>;

struct EightPoints {
    Pair<Four> x, y, z;
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

/// Squared distances of four of the points.
inline Four four_distances(const PreparedTriangle& t, const Four& px, const Four& py,
                           const Four& pz)
{
    const Four zero{}, one = zero + 1.0F;
    Four nearest = zero + 3e38F, outside = zero + t.bias, height = zero;
    for (const PreparedTriangle::Side& s : t.side) {
        const Four x = px - s.x, y = py - s.y, z = pz - s.z;
        Four along = (x * s.ex + y * s.ey + z * s.ez) * s.inverse;
        along = along > zero ? along : zero;
        along = along < one ? along : one;
        const Four dx = x - along * s.ex, dy = y - along * s.ey, dz = z - along * s.ez;
        const Four d = dx * dx + dy * dy + dz * dz;
        const Four beyond = x * s.mx + y * s.my + z * s.mz;
        nearest = d < nearest ? d : nearest;
        outside = beyond > outside ? beyond : outside;
        height = x * t.nx + y * t.ny + z * t.nz;
    }
    return outside > zero ? nearest : height * height;
}

/// Squared distances of the points.
inline Pair<Four> eight_distances(const PreparedTriangle& t, const EightPoints& p)
{
    return {four_distances(t, p.x[0], p.y[0], p.z[0]), four_distances(t, p.x[1], p.y[1], p.z[1])};
}

} // namespace vdb_shell

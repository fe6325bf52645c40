// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

namespace vdb_shell
{

/// The longest side of a triangle, the first of equal ones. Side k runs from corner k to the next.
inline int longest_side(const TriangleMesh& mesh, const openvdb::Vec3I& t)
{
    using openvdb::Vec3d;
    int best = 0;
    double longest = -1;
    for (int k = 0; k < 3; ++k) {
        const double length =
            (Vec3d(mesh.points[t[(k + 1) % 3]]) - Vec3d(mesh.points[t[k]])).lengthSqr();
        if (length > longest) {
            longest = length;
            best = k;
        }
    }
    return best;
}

/// Over side k; 0 where that has no length. All three sides give the same area with their heights,
/// so the longest has the smallest one.
inline double height_over(const TriangleMesh& mesh, const openvdb::Vec3I& t, int k)
{
    using openvdb::Vec3d;
    const Vec3d a(mesh.points[t[k]]), b(mesh.points[t[(k + 1) % 3]]),
        c(mesh.points[t[(k + 2) % 3]]);
    const double length = (b - a).length();
    return length > 0 ? (b - a).cross(c - a).length() / length : 0.0;
}

} // namespace vdb_shell

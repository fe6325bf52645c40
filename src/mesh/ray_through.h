// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <cmath>

namespace vdb_shell
{

struct Ray {
    openvdb::Vec3d from, along; ///< along: unit length, or zero where there is no direction
};

/// Where the ray leaves a solid through a triangle of its surface; infinite where it does not. In
/// doubles: a hint, not a proof.
inline double leaves_through(const TriangleMesh& mesh, const openvdb::Vec3I& t, const Ray& ray)
{
    using openvdb::Vec3d;
    const Vec3d a(mesh.points[t[0]]);
    const Vec3d ab = Vec3d(mesh.points[t[1]]) - a, ac = Vec3d(mesh.points[t[2]]) - a;
    const Vec3d across = ray.along.cross(ac);
    const double det = ab.dot(across);
    if (!(det < 0)) // parallel to it, or entering
        return HUGE_VAL;
    const Vec3d from_a = ray.from - a;
    const double u = from_a.dot(across) / det;
    const Vec3d q = from_a.cross(ab);
    const double v = ray.along.dot(q) / det;
    const double distance = ac.dot(q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && distance >= 0 ? distance : HUGE_VAL;
}

} // namespace vdb_shell

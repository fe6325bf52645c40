// SPDX-License-Identifier: Apache-2.0

// Extents and the volume of a mesh, in doubles. The volume is the sum of signed tets over the
// triangles (the divergence theorem): positive when corners run counter-clockwise seen from
// outside. Sums are in the order of the triangles, so their bits are the same each time. The sign
// is no proof; where it decides validity, the certificate computes its own with a bound on the
// error.

#include "vdb_shell/mesh/triangle_mesh.h"

#include "core/parallel.h"

namespace vdb_shell
{

Bounds bounds_of(const std::vector<openvdb::Vec3s>& points)
{
    // Precondition: there are points.
    Bounds bounds{openvdb::Vec3d(points.front()), openvdb::Vec3d(points.front())};
    for (const openvdb::Vec3s& p : points) {
        bounds.low = openvdb::math::minComponent(bounds.low, openvdb::Vec3d(p));
        bounds.high = openvdb::math::maxComponent(bounds.high, openvdb::Vec3d(p));
    }
    return bounds;
}

double diagonal_of(const Bounds& bounds)
{
    return (bounds.high - bounds.low).length();
}

double signed_volume(const std::vector<openvdb::Vec3s>& points,
                     const std::vector<openvdb::Vec3I>& triangles)
{
    if (points.empty())
        return 0.0;
    const Bounds bounds = bounds_of(points);
    // About the middle the terms are as small as they can be, so least is lost where they cancel.
    const openvdb::Vec3d centre = 0.5 * (bounds.low + bounds.high);
    const double six_volumes = sum_in_order(triangles.size(), [&](std::size_t i) {
        const openvdb::Vec3I& t = triangles[i];
        const openvdb::Vec3d a = openvdb::Vec3d(points[t[0]]) - centre;
        const openvdb::Vec3d b = openvdb::Vec3d(points[t[1]]) - centre;
        const openvdb::Vec3d c = openvdb::Vec3d(points[t[2]]) - centre;
        return a.dot(b.cross(c));
    });
    return six_volumes / 6.0;
}

} // namespace vdb_shell

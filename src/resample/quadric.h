// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

namespace vdb_shell
{

/// Squared distances from planes, weighted by area: x'Ax + 2 b'x + c, relative to an origin.
struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, x = 0, y = 0, z = 0, one = 0;
    double area = 0;

    void add_plane(const openvdb::Vec3d& n, double offset, double weight)
    {
        xx += weight * n[0] * n[0], xy += weight * n[0] * n[1], xz += weight * n[0] * n[2];
        yy += weight * n[1] * n[1], yz += weight * n[1] * n[2], zz += weight * n[2] * n[2];
        x += weight * n[0] * offset, y += weight * n[1] * offset, z += weight * n[2] * offset;
        one += weight * offset * offset;
        area += weight;
    }
    Quadric& operator+=(const Quadric& q)
    {
        xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
        x += q.x, y += q.y, z += q.z, one += q.one, area += q.area;
        return *this;
    }
    double at(const openvdb::Vec3d& p) const
    {
        return p[0] * (xx * p[0] + 2 * (xy * p[1] + xz * p[2] + x)) +
               p[1] * (yy * p[1] + 2 * (yz * p[2] + y)) + p[2] * (zz * p[2] + 2 * z) + one;
    }
};

} // namespace vdb_shell

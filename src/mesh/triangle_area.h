// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <vector>

namespace vdb_shell
{

inline double triangle_area(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& t)
{
    using openvdb::Vec3d;
    const Vec3d a(points[t[0]]);
    return 0.5 * (Vec3d(points[t[1]]) - a).cross(Vec3d(points[t[2]]) - a).length();
}

/// Summed in the order of the triangles.
inline double surface_area(const std::vector<openvdb::Vec3s>& points,
                           const std::vector<openvdb::Vec3I>& triangles)
{
    double area = 0;
    for (const openvdb::Vec3I& t : triangles)
        area += triangle_area(points, t);
    return area;
}

} // namespace vdb_shell

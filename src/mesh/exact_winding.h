// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which side of closed surfaces a point is on, decided exactly.

#include "core/exact.h"

#include <cstddef>
#include <vector>

namespace vdb_shell
{

struct ExactWinding {
    int number = 0;          ///< how often the surface goes round the point
    bool on_surface = false; ///< the number means nothing then
};

/// A triangle that the upward ray from `point` cannot meet. The comparisons are exact and strict,
/// so nothing that the ray touches is excluded.
inline bool misses_upward_ray(const openvdb::Vec3s& point, const exact::Triangle& t)
{
    for (int k = 0; k < 2; ++k)
        if ((t[0][k] < point[k] && t[1][k] < point[k] && t[2][k] < point[k]) ||
            (t[0][k] > point[k] && t[1][k] > point[k] && t[2][k] > point[k]))
            return true;
    return t[0][2] < point[2] && t[1][2] < point[2] && t[2][2] < point[2];
}

/// Of the closed surface of `count` triangles, the corners of each being corners_of(i), by the
/// crossings of the upward ray. The half-open rule of crossing_above counts a ray through an edge
/// or a corner once, so no ray has to be tried again in another direction.
template <class CornersOf>
ExactWinding exact_winding(const openvdb::Vec3s& point, std::size_t count,
                           const CornersOf& corners_of)
{
    ExactWinding winding;
    for (std::size_t i = 0; i < count; ++i) {
        const exact::Triangle t = corners_of(i);
        if (!misses_upward_ray(point, t))
            winding.number += exact::crossing_above(point, t[0], t[1], t[2], winding.on_surface);
    }
    return winding;
}

inline ExactWinding exact_winding(const openvdb::Vec3s& point,
                                  const std::vector<openvdb::Vec3s>& points,
                                  const std::vector<openvdb::Vec3I>& triangles)
{
    return exact_winding(point, triangles.size(), [&](std::size_t i) {
        const openvdb::Vec3I& t = triangles[i];
        return exact::Triangle{points[t[0]], points[t[1]], points[t[2]]};
    });
}

} // namespace vdb_shell

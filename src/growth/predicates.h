// SPDX-License-Identifier: Apache-2.0
#pragma once

// The exact tests of core/exact.h behind a double filter that inlines into the loops of growth.
// All points are float32 values held as doubles, so that the same numbers serve the barrier too.

#include "core/exact.h"
#include "core/orient3d_filter.h"

#include <openvdb/Types.h>

#include <array>

namespace vdb_shell::growth
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using Corners = std::array<Vec3d, 3>;
using CornerIds = std::array<int, 3>;

/// The nearest float32 value. Volatile on purpose: g++ 12 -O2 drops the double-float-double round
/// trip of neighbouring lanes when it vectorises straight-line code (gone with
/// -fno-tree-slp-vectorize), and then what is tested is not what is stored.
inline double rounded(double x)
{
    volatile const float f = static_cast<float>(x);
    return static_cast<double>(f);
}
inline Vec3d rounded(const Vec3d& p)
{
    return {rounded(p[0]), rounded(p[1]), rounded(p[2])};
}

/// Sign of det(q-p, r-p, s-p), always right.
inline int orient(const Vec3d& p, const Vec3d& q, const Vec3d& r, const Vec3d& s)
{
    if (const int sign = exact::orient3d_filter(p, q, r, s))
        return sign;
    return exact::orient3d(Vec3s(p), Vec3s(q), Vec3s(r), Vec3s(s));
}

/// Whether the closed segment pq and the closed triangle have a common point.
bool segment_touches_triangle(const Vec3d& p, const Vec3d& q, const Corners& triangle);

/// Whether two triangles of one mesh meet anywhere but in the corners and edges that they share by
/// id. Two names for one triangle (all corners shared) are no contact: a triangle whose corners are
/// all pinned lies on its outer one.
bool improper_contact(const Corners& s, const CornerIds& s_id, const Corners& t,
                      const CornerIds& t_id);

} // namespace vdb_shell::growth

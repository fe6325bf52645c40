// SPDX-License-Identifier: Apache-2.0
#pragma once

// Predicates whose sign is always right: CGAL's filtered kernel on the float32 coordinates
// themselves.

#include <openvdb/Types.h>

#include <array>
#include <vector>

namespace vdb_shell::exact
{

/// Sign (-1, 0, 1) of det(b-a, c-a, d-a).
int orient3d(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c,
             const openvdb::Vec3s& d);

/// Whether the three points lie on one line.
bool collinear(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c);

/// Whether two triangles touch anywhere but in the corners and edges that they share *by index*:
/// no shared corner - any common point; one - a common point besides it; two - one folded flat onto
/// the other; three - always. Precondition: neither triangle is degenerate.
bool triangles_touch(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& first,
                     const openvdb::Vec3I& second);

/// Whether doubles show for certain that the two meet in shared corners and edges only: seen along
/// an axis, the line of an edge of one has them on different sides. Cheap, and made for neighbours
/// that lie in one plane, or nearly, where signs in space need exact arithmetic. Corners are shared
/// by index. False tells nothing.
bool apart_in_projection(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& first,
                         const openvdb::Vec3I& second);

/// The corners of a triangle by value, for callers whose points stand in no list.
using Triangle = std::array<openvdb::Vec3s, 3>;

/// Whether two triangles without a shared corner have a common point. A degenerate triangle, which
/// has no place in a surface, counts as touching whatever it is compared with.
bool triangles_touch(const Triangle& first, const Triangle& second);

/// Whether the closed segment and the closed triangle have a common point; degenerate ones as
/// above.
bool segment_touches_triangle(const openvdb::Vec3s& p, const openvdb::Vec3s& q,
                              const Triangle& triangle);

/// The corners of a tet by value, in any order.
using Tet = std::array<openvdb::Vec3s, 4>;

/// Whether the interiors of two tets have a common point. Tets that share corners, edges or faces,
/// or touch from outside, do not. Precondition: neither tet is flat.
bool tets_overlap(const Tet& first, const Tet& second);

/// Which way three points turn, seen along that axis (0 to 2): 1 as the other two axes do, in their
/// cyclic order; -1 the other way; 0 on one line.
int turn_along(int axis, const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& c);

/// Of four points in one plane: whether p and q are not strictly on opposite sides of the line a b.
bool on_one_side(const openvdb::Vec3s& a, const openvdb::Vec3s& b, const openvdb::Vec3s& p,
                 const openvdb::Vec3s& q);

/// Whether the segment is longer than `length`, without any rounding, or by the double measure
/// (Vec3d(to) - Vec3d(from)).length() that callers see.
bool longer_than(const openvdb::Vec3s& from, const openvdb::Vec3s& to, double length);

/// Whether the vertical line through `point` (parallel to z) crosses the triangle above it, with
/// the half-open rule that counts a shared edge or corner for exactly one of its triangles. 0: no
/// crossing above; +1 / -1: crossed, the triangle's normal pointing up / down. `on_surface` is set
/// when the point lies on the triangle.
int crossing_above(const openvdb::Vec3s& point, const openvdb::Vec3s& a, const openvdb::Vec3s& b,
                   const openvdb::Vec3s& c, bool& on_surface);

} // namespace vdb_shell::exact

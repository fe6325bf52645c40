// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>
#include <openvdb/math/Mat3.h>

#include <array>
#include <optional>

namespace vdb_shell
{

/// Coordinates in a prism: weights of the triangle's corners 1 and 2, and the share of the way from
/// the outer to the inner triangle.
using WedgePlace = openvdb::Vec3d;

/// A prism with curved sides: X(u, v, t), linear in u and v and linear in t, between the triangles
/// `outer` (t = 0) and `inner` (t = 1). Its sides are bilinear, so neighbours share them whatever
/// the diagonals of their tets.
struct Wedge {
    std::array<openvdb::Vec3d, 3> outer, inner;
};

/// Whether the Jacobian of the map is positive inside the prism (docs/theory.md, "Coordinates of a
/// shell"): its nine Bernstein coefficients are none negative and not all zero, up to a rounding of
/// 1e-12 of the lengths that they are products of.
bool has_positive_jacobian(const Wedge& wedge);

openvdb::Vec3d point_of(const Wedge& wedge, const WedgePlace& place);

/// Columns: the derivatives by u, v and t.
openvdb::Mat3d jacobian_of(const Wedge& wedge, const WedgePlace& place);

/// The place of a point, by Newton's method from a guess; nothing where that does not settle within
/// a prism's length of the prism. Precondition: has_positive_jacobian.
std::optional<WedgePlace> place_of(const Wedge& wedge, const openvdb::Vec3d& point,
                                   const WedgePlace& guess);

/// The largest amount by which a coordinate leaves the prism; negative inside.
double outside_of(const WedgePlace& place);

} // namespace vdb_shell

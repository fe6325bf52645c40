// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>

namespace vdb_shell
{

/// Halves a triangle at its longest edge until none is longer than `longest`, and hands each piece
/// to visit(a, b, c) in a fixed order. Slivers need few pieces that way. Precondition: longest > 0.
template <typename Visit>
void for_each_piece(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c,
                    double longest, const Visit& visit)
{
    const double ab = (b - a).lengthSqr(), bc = (c - b).lengthSqr(), ca = (a - c).lengthSqr();
    if (!(ab > longest * longest || bc > longest * longest || ca > longest * longest)) {
        visit(a, b, c);
    } else if (ab >= bc && ab >= ca) {
        const openvdb::Vec3d middle = 0.5 * (a + b);
        for_each_piece(a, middle, c, longest, visit);
        for_each_piece(middle, b, c, longest, visit);
    } else if (bc >= ca) {
        for_each_piece(b, c, a, longest, visit);
    } else {
        for_each_piece(c, a, b, longest, visit);
    }
}

} // namespace vdb_shell

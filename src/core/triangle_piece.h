// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"
#include "core/crowded_pairs.h"
#include "core/layered_pairs.h"
#include "core/unit_vector.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace vdb_shell
{

/// Whether all of one lie farther along the axis than all of the other. The axis need not be exact,
/// for any that tells them apart proves it; `pad` covers the rounding of what is compared.
inline bool apart_along(const openvdb::Vec3d& axis, const FlatCorners& a, const FlatCorners& b,
                        double pad)
{
    constexpr double kFar = std::numeric_limits<double>::infinity();
    const auto range = [&](const FlatCorners& corners) {
        double low = kFar, high = -kFar;
        for (const openvdb::Vec3d& p : corners) {
            const double at = axis.dot(p - a[0]);
            low = std::min(low, at), high = std::max(high, at);
        }
        return std::array<double, 2>{low, high};
    };
    const auto [low_a, high_a] = range(a);
    const auto [low_b, high_b] = range(b);
    return low_b - high_a > pad || low_a - high_b > pad;
}

/// A convex part with four corners, in their order around it. It is cut across, in the middle of
/// the longer two of opposite sides, so a long one becomes shorter and not thinner.
struct TrianglePiece {
    FlatCorners corner;
    openvdb::Vec3d normal, along; ///< of length 1, or 0
    double pad;
    std::uint32_t item;
    BoxTree::Marks marks;

    /// All of a triangle: the corner between its longer sides is there twice.
    TrianglePiece(const std::vector<openvdb::Vec3s>& points, const openvdb::Vec3I& t,
                  std::uint32_t i, BoxTree::Marks m)
        : pad(0), item(i), marks(m)
    {
        std::array<openvdb::Vec3d, 3> p;
        for (int k = 0; k < 3; ++k) {
            p[std::size_t(k)] = openvdb::Vec3d(points[t[k]]);
            for (int axis = 0; axis < 3; ++axis)
                pad = std::max(pad, std::abs(p[std::size_t(k)][axis]));
        }
        // Each of at most forty middles is off by half a unit in the last place: 5e-15 of it.
        pad *= 1e-13;
        std::size_t shortest = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if ((p[(k + 1) % 3] - p[k]).lengthSqr() <
                (p[(shortest + 1) % 3] - p[shortest]).lengthSqr())
                shortest = k;
        corner = {p[(shortest + 2) % 3], p[shortest], p[(shortest + 1) % 3], p[(shortest + 2) % 3]};
        along = unit_vector(corner[1] - corner[0]);
        normal = normal_of(corner);
    }
    const FlatCorners& corners() const { return corner; }
    /// Whether one is on one side of the other, or they are like two sticks apart.
    bool surely_apart(const TrianglePiece& o) const
    {
        const auto apart = [&](const openvdb::Vec3d& axis) {
            return apart_along(axis, corner, o.corner, pad + o.pad);
        };
        return apart(along.cross(o.along)) || apart(normal) || apart(o.normal);
    }
    FloatBox box() const
    {
        PaddedBox box;
        for (const openvdb::Vec3d& p : corner)
            box.add(p);
        return box.padded(pad);
    }
    bool divisible() const { return longer_of_opposite(longer_side()) > 1e6 * pad * pad; }
    TrianglePiece halve()
    {
        // From side k to the opposite one.
        const std::size_t k = longer_side();
        TrianglePiece other = *this;
        corner[(k + 1) % 4] = other.corner[k] = 0.5 * (corner[k] + corner[(k + 1) % 4]);
        corner[(k + 2) % 4] = other.corner[(k + 3) % 4] =
            0.5 * (corner[(k + 2) % 4] + corner[(k + 3) % 4]);
        return other;
    }

private:
    /// The squared length of side k, from corner k to the next, or of the opposite one.
    double longer_of_opposite(std::size_t k) const
    {
        return std::max((corner[k + 1] - corner[k]).lengthSqr(),
                        (corner[(k + 3) % 4] - corner[k + 2]).lengthSqr());
    }
    std::size_t longer_side() const
    {
        return longer_of_opposite(0) > longer_of_opposite(1) ? 0 : 1;
    }
};

/// Boxes that cover triangles, more than one for those that are long and thin and lie askew, whose
/// own box is nearly empty.
struct PartBoxes {
    std::vector<FloatBox> boxes;
    std::vector<std::uint32_t> triangle; ///< of each box, ascending
};
PartBoxes part_boxes(const std::vector<openvdb::Vec3s>& points,
                     const std::vector<openvdb::Vec3I>& triangles);

} // namespace vdb_shell

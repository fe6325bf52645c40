// SPDX-License-Identifier: Apache-2.0
#pragma once

// Boxes in float32: one, and four that are compared by one group of vector instructions.

#include "core/four_floats.h"

#include <openvdb/Types.h>

#include <array>
#include <cstddef>
#include <limits>

namespace vdb_shell
{

/// A closed box; the fourth lane is always within.
struct FloatBox {
    FourFloats lo, hi;

    static FloatBox around(const openvdb::Vec3s& p)
    {
        const FourFloats at{p[0], p[1], p[2], 0};
        return {at, at};
    }
    void add(const openvdb::Vec3s& p) { add(around(p)); }
    void add(const FloatBox& o) { lo = least_of(lo, o.lo), hi = most_of(hi, o.hi); }
    bool overlaps(const FloatBox& o) const
    {
        using TwoWords __attribute__((vector_size(16))) = long long;
        const auto within = (TwoWords)((lo <= o.hi) & (o.lo <= hi));
        return (within[0] & within[1]) == -1;
    }
    bool contains(const openvdb::Vec3s& p) const { return overlaps(around(p)); }
};

/// Four boxes, by axis.
struct FourBoxes {
    std::array<FourFloats, 3> lo, hi;

    /// Four that overlap nothing.
    static FourBoxes none()
    {
        constexpr float kFar = std::numeric_limits<float>::infinity();
        return {{four(kFar), four(kFar), four(kFar)}, {four(-kFar), four(-kFar), four(-kFar)}};
    }
    static FourBoxes same(const FloatBox& box)
    {
        return {{four(box.lo[0]), four(box.lo[1]), four(box.lo[2])},
                {four(box.hi[0]), four(box.hi[1]), four(box.hi[2])}};
    }
    void set(std::size_t lane, const FloatBox& box)
    {
        for (std::size_t k = 0; k < 3; ++k)
            lo[k][lane] = box.lo[k], hi[k][lane] = box.hi[k];
    }
    FloatBox get(std::size_t lane) const
    {
        FloatBox box{};
        for (std::size_t k = 0; k < 3; ++k)
            box.lo[k] = lo[k][lane], box.hi[k] = hi[k][lane];
        return box;
    }
    /// A bit for each that overlaps the other's.
    unsigned overlaps(const FourBoxes& o) const
    {
        auto within = (lo[0] <= o.hi[0]) & (o.lo[0] <= hi[0]);
        for (std::size_t k = 1; k < 3; ++k)
            within &= (lo[k] <= o.hi[k]) & (o.lo[k] <= hi[k]);
        return bits_of(within);
    }
};

} // namespace vdb_shell

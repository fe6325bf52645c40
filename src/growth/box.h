// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/box_tree.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell::growth
{

using openvdb::Vec3d;

struct Box {
    Vec3d lo{1e300}, hi{-1e300};
    void add(const Vec3d& p)
    {
        for (int k = 0; k < 3; ++k)
            lo[k] = std::min(lo[k], p[k]), hi[k] = std::max(hi[k], p[k]);
    }
    void add(const Box& o) { add(o.lo), add(o.hi); }
    void inflate(double r) { lo -= Vec3d(r), hi += Vec3d(r); }
    bool contains(const Vec3d& p) const
    {
        return lo[0] <= p[0] && p[0] <= hi[0] && lo[1] <= p[1] && p[1] <= hi[1] && lo[2] <= p[2] &&
               p[2] <= hi[2];
    }
};

/// Rounded outwards.
inline FloatBox float_box(const Box& box)
{
    constexpr float kMost = std::numeric_limits<float>::max();
    FloatBox out{};
    for (int k = 0; k < 3; ++k) {
        const auto lo = static_cast<float>(box.lo[k]), hi = static_cast<float>(box.hi[k]);
        out.lo[k] = double(lo) <= box.lo[k] ? lo : std::nextafter(lo, -kMost);
        out.hi[k] = double(hi) >= box.hi[k] ? hi : std::nextafter(hi, kMost);
    }
    return out;
}

} // namespace vdb_shell::growth

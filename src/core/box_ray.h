// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/float_box.h"

#include <openvdb/Types.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vdb_shell
{

/// A ray p + t d, t >= 0, made ready to be held against boxes four at a time: by the slabs between
/// their faces (Kay and Kajiya, "Ray Tracing Complex Scenes", 1986).
class BoxRay
{
public:
    BoxRay(const openvdb::Vec3d& from, const openvdb::Vec3d& along)
    {
        for (std::size_t k = 0; k < 3; ++k) {
            from_[k] = from[int(k)];
            inverse_[k] = 1 / along[int(k)];
            kind_[k] = along[int(k)] == 0           ? Kind::within_slab
                       : std::isfinite(inverse_[k]) ? Kind::crossing
                                                    : Kind::unknown;
        }
    }

    /// A bit for each box that it may meet where t <= limit: never none where it does. `entry`: the
    /// t at which it comes into each of these, 0 where it begins inside.
    unsigned meets(const FourBoxes& boxes, double limit, std::array<double, 4>& entry) const
    {
        std::array<double, 4> leaving;
        entry.fill(0);
        leaving.fill(limit);
        for (std::size_t k = 0; k < 3; ++k) {
            if (kind_[k] == Kind::unknown)
                continue; // it takes longer than a double can tell to cross the slab
            std::array<double, 4> low, high;
            for (std::size_t i = 0; i < 4; ++i)
                low[i] = double(boxes.lo[k][i]), high[i] = double(boxes.hi[k][i]);
            if (kind_[k] == Kind::within_slab) {
                for (std::size_t i = 0; i < 4; ++i)
                    if (from_[k] < low[i] || from_[k] > high[i])
                        entry[i] = std::numeric_limits<double>::infinity();
                continue;
            }
            for (std::size_t i = 0; i < 4; ++i) {
                const double a = (low[i] - from_[k]) * inverse_[k],
                             b = (high[i] - from_[k]) * inverse_[k];
                entry[i] = std::max(entry[i], std::min(a, b));
                leaving[i] = std::min(leaving[i], std::max(a, b));
            }
        }
        unsigned met = 0;
        for (std::size_t i = 0; i < 4; ++i)
            met |= unsigned(entry[i] <= no_less(leaving[i])) << i;
        return met;
    }

    /// What is not less than t, as computed, before rounding. A difference, an inverse and a
    /// product of doubles have a relative error of about 3e-16 together, so the factor is far above
    /// what can turn a hit into a miss; the absolute term serves rays that begin on a box, where
    /// both ends are about 0.
    static double no_less(double t)
    {
        constexpr double kAboveRounding = 1 + 1e-9, kLeast = 1e-300;
        return t * kAboveRounding + kLeast;
    }

private:
    enum class Kind : char { crossing, within_slab, unknown };
    std::array<double, 3> from_, inverse_;
    std::array<Kind, 3> kind_;
};

} // namespace vdb_shell

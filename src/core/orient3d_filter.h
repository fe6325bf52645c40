// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cmath>

namespace vdb_shell::exact
{

/// Sign of det(b-a, c-a, d-a) where doubles decide it for certain, else 0. The points are float32
/// values held as doubles.
inline int orient3d_filter(const openvdb::Vec3d& a, const openvdb::Vec3d& b,
                           const openvdb::Vec3d& c, const openvdb::Vec3d& d)
{
    // The differences are rounded once each; 7.8e-16 times the permanent bounds the error of the
    // determinant (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
    // Geometric Predicates", bound A of ORIENT3D).
    const double bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
    const double cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
    const double dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];
    const double xy = bx * cy, yx = by * cx, yz = by * cz, zy = bz * cy, zx = bz * cx, xz = bx * cz;
    const double det = dz * (xy - yx) + dx * (yz - zy) + dy * (zx - xz);
    const double permanent = std::abs(dz) * (std::abs(xy) + std::abs(yx)) +
                             std::abs(dx) * (std::abs(yz) + std::abs(zy)) +
                             std::abs(dy) * (std::abs(zx) + std::abs(xz));
    constexpr double kErrorBound = 7.8e-16;
    // Products of float32 differences cannot underflow in double unless they are subnormal squares;
    // the tiny absolute term leaves those open.
    constexpr double kUnderflowGuard = 1e-280;
    const double bound = kErrorBound * permanent + kUnderflowGuard;
    return (det > bound) - (det < -bound);
}

} // namespace vdb_shell::exact

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cmath>

namespace vdb_shell::exact
{

// The differences are rounded once each; this times the permanent bounds the error of the
// determinant (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates", bound A of ORIENT3D).
inline constexpr double kOrientError = 7.8e-16;
// Products of float32 differences cannot underflow in double unless they are subnormal squares; the
// tiny absolute term leaves those open.
inline constexpr double kUnderflowGuard = 1e-280;

/// Sign of det(b-a, c-a, d-a) where doubles decide it for certain, else 0. The points are float32
/// values held as doubles.
inline int orient3d_filter(const openvdb::Vec3d& a, const openvdb::Vec3d& b,
                           const openvdb::Vec3d& c, const openvdb::Vec3d& d)
{
    const double bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
    const double cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
    const double dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];
    const double xy = bx * cy, yx = by * cx, yz = by * cz, zy = bz * cy, zx = bz * cx, xz = bx * cz;
    const double det = dz * (xy - yx) + dx * (yz - zy) + dy * (zx - xz);
    const double permanent = std::abs(dz) * (std::abs(xy) + std::abs(yx)) +
                             std::abs(dx) * (std::abs(yz) + std::abs(zy)) +
                             std::abs(dy) * (std::abs(zx) + std::abs(xz));
    const double bound = kOrientError * permanent + kUnderflowGuard;
    return (det > bound) - (det < -bound);
}

/// orient3d_filter for many points against one triangle: what depends on the triangle alone is done
/// once.
class PlaneFilter
{
public:
    PlaneFilter(const openvdb::Vec3d& a, const openvdb::Vec3d& b, const openvdb::Vec3d& c) : a_(a)
    {
        const openvdb::Vec3d u = b - a, w = c - a;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            normal_[i] = u[j] * w[k] - u[k] * w[j];
            size_[i] = std::abs(u[j] * w[k]) + std::abs(u[k] * w[j]);
        }
    }

    /// Sign of det(b-a, c-a, p-a) where doubles decide it for certain, else 0.
    int side(const openvdb::Vec3d& p) const
    {
        const double x = p[0] - a_[0], y = p[1] - a_[1], z = p[2] - a_[2];
        const double det = z * normal_[2] + x * normal_[0] + y * normal_[1];
        const double permanent =
            std::abs(z) * size_[2] + std::abs(x) * size_[0] + std::abs(y) * size_[1];
        const double bound = kOrientError * permanent + kUnderflowGuard;
        return (det > bound) - (det < -bound);
    }

private:
    openvdb::Vec3d a_, normal_, size_;
};

} // namespace vdb_shell::exact

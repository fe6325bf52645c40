// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cmath>

// The floating-point filter before exact orientation: one form here for one determinant, one in
// core/orient3d_filter-inl.h for four at a time.

namespace vdb_shell::exact
{

// The differences are rounded once each; this times the permanent bounds the error of the
// determinant (Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates", bound A of ORIENT3D).
inline constexpr double kOrientError = 7.8e-16;
// Products of float32 differences cannot underflow in double unless they are subnormal squares; the
// tiny absolute term leaves those open.
inline constexpr double kUnderflowGuard = 1e-280;

/// Sign of a determinant where doubles decide it for certain, else 0. `permanent` is the sum of the
/// sizes of its products, `error` the bound for it.
inline int certain_sign(double det, double permanent, double error = kOrientError)
{
    const double bound = error * permanent + kUnderflowGuard;
    return (det > bound) - (det < -bound);
}

/// Sign of d . (u x w) where doubles decide it for certain, else 0: d counts as given, so
/// differences and products are rounded as in an orientation, or less.
inline int certain_triple_sign(const openvdb::Vec3d& d, const openvdb::Vec3d& u,
                               const openvdb::Vec3d& w, double error = kOrientError)
{
    double det = 0, permanent = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        const double left = u[a] * w[b], right = u[b] * w[a];
        det += d[axis] * (left - right);
        permanent += std::abs(d[axis]) * (std::abs(left) + std::abs(right));
    }
    return certain_sign(det, permanent, error);
}

/// The plane of a triangle, and the sides of it that points lie on. Points are float32 values held
/// as doubles.
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
        return certain_sign(det, permanent);
    }

private:
    openvdb::Vec3d a_, normal_, size_;
};

/// Sign of det(b-a, c-a, d-a) where doubles decide it for certain, else 0.
inline int orient3d_filter(const openvdb::Vec3d& a, const openvdb::Vec3d& b,
                           const openvdb::Vec3d& c, const openvdb::Vec3d& d)
{
    return PlaneFilter(a, b, c).side(d);
}

} // namespace vdb_shell::exact

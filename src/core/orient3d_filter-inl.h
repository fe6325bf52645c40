// SPDX-License-Identifier: Apache-2.0

// core/orient3d_filter.h for kernels (core/simd.h), four determinants at a time.
#if defined(VDB_SHELL_CORE_ORIENT3D_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VDB_SHELL_CORE_ORIENT3D_FILTER_INL_H
#undef VDB_SHELL_CORE_ORIENT3D_FILTER_INL_H
#else
#define VDB_SHELL_CORE_ORIENT3D_FILTER_INL_H
#endif

#include "core/orient3d_filter.h"
#include "core/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vdb_shell::simd::HWY_NAMESPACE
{

/// Positive where exact::certain_sign of the same is 1.
HWY_INLINE Doubles certain_margin(Doubles det, Doubles permanent, double error)
{
    return det - (error * permanent + exact::kUnderflowGuard);
}

/// Positive where doubles show for certain that det(p, u, w) is: the corners of tets relative to
/// their fourth.
HWY_INLINE Doubles orient3d_margin(const DoublePoint& p, const DoublePoint& u, const DoublePoint& w)
{
    Doubles det(0.0), permanent(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const Doubles left = u[i] * w[j], right = u[j] * w[i];
        det += p[k] * (left - right);
        permanent += absolute(p[k]) * (absolute(left) + absolute(right));
    }
    return certain_margin(det, permanent, exact::kOrientError);
}

} // namespace vdb_shell::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace vdb_shell
{

/// GCC's and Clang's vectors, which every x86-64 and 64-bit ARM processor has: loops over arrays
/// are too often left scalar by the compiler, at a quarter of the speed. Not Highway (core/simd.h):
/// one box takes less than a call that is decided at run time, and these are in traversals that
/// call back.
using FourFloats __attribute__((vector_size(16))) = float;

inline FourFloats four(float x)
{
    return FourFloats{x, x, x, x};
}
/// What comparing two of them gives.
using FourTruths __attribute__((vector_size(16))) = std::int32_t;
/// A bit for each lane that is true, the first lane's the lowest.
inline unsigned bits_of(const FourTruths& truths)
{
#ifdef __SSE__
    return unsigned(_mm_movemask_ps((FourFloats)truths));
#else
    return (truths[0] & 1U) | (truths[1] & 2U) | (truths[2] & 4U) | (truths[3] & 8U);
#endif
}
/// x < y ? x : y in each lane, which compilers leave as three instructions.
inline FourFloats least_of(const FourFloats& x, const FourFloats& y)
{
#ifdef __SSE__
    return _mm_min_ps(x, y);
#else
    return x < y ? x : y;
#endif
}
/// x > y ? x : y.
inline FourFloats most_of(const FourFloats& x, const FourFloats& y)
{
#ifdef __SSE__
    return _mm_max_ps(x, y);
#else
    return x > y ? x : y;
#endif
}

} // namespace vdb_shell

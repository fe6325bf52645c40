// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// How this project uses Highway (https://github.com/google/highway) for several numbers at a time.
///
/// A source whose loops gain by it is compiled once for each target below; the processor at hand
/// decides which of them runs (core/dispatch.h). Such a source holds kernels over plain arrays
/// and little else: what it instantiates of the standard library could otherwise be linked into
/// code for processors that do not have the instructions. It is laid out as Highway's guide has it,
/// with this header first and core/simd-inl.h, the operations, after foreach_target.h.
///
/// The bits of a result are the same on every target, as tests/pipeline/simd_test.cpp holds: work
/// is divided into groups of fixed size whatever the width of the processor's vectors, lanes do not
/// depend on each other, sums over lanes have one order, and products and sums are not contracted
/// (no hn::MulAdd here, -ffp-contract=off in CMakeLists.txt).

// The others cost time to compile and gain nothing: wider vectors than a group have no use.
#define HWY_DISABLED_TARGETS                                                                       \
    (HWY_SSSE3 | HWY_AVX3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)

namespace vdb_shell
{

/// Lanes of a group of floats, and of doubles: a vector of AVX2 each.
inline constexpr std::size_t kLanes = 8, kDoubleLanes = 4;
/// For arrays of groups, so that none lies across two cache lines.
inline constexpr std::size_t kLanesAlignment = 32;

} // namespace vdb_shell

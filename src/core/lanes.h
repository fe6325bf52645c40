// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/two_targets.h"

#include <array>
#include <cstddef>
#include <cstdint>

// Eight floats at a time, by GCC's and Clang's vectors: loops over arrays were left scalar by the
// compiler, at a quarter of the speed. Products and sums are not contracted (CMakeLists.txt), so
// the bits are the same whatever the processor has.

/// For what functions of VDB_SHELL_TWO_TARGETS (core/two_targets.h) call, which has to become part
/// of both. Takes and returns no lanes by value: how these are passed depends on the processor.
#define VDB_SHELL_LANES_PART __attribute__((always_inline)) inline

namespace vdb_shell
{

inline constexpr std::size_t kLanes = 8;

using Lanes __attribute__((vector_size(4 * kLanes))) = float;
using LaneIndices __attribute__((vector_size(4 * kLanes))) = std::int32_t;

// Four doubles, not eight: what the processor does not have in one piece goes through memory.
inline constexpr std::size_t kDoubleLanes = 4;
using DoubleLanes __attribute__((vector_size(8 * kDoubleLanes))) = double;
using DoublePoint = std::array<DoubleLanes, 3>; ///< by axis

/// Memory for lanes is aligned by hand: without AVX the compiler takes less for enough.
inline constexpr std::size_t kLanesAlignment = 4 * kLanes;

// Not by memcpy: GCC makes two halves of it that go through the stack, and the processor waits for
// them there.
using LanesAnywhere __attribute__((vector_size(4 * kLanes), aligned(4), may_alias)) = float;
using DoubleLanesAnywhere __attribute__((vector_size(8 * kDoubleLanes), aligned(8), may_alias)) =
    double;

/// From memory of any alignment.
VDB_SHELL_LANES_PART void load_lanes(const float* from, Lanes& lanes)
{
    lanes = *reinterpret_cast<const LanesAnywhere*>(from);
}
VDB_SHELL_LANES_PART void load_lanes(const double* from, DoubleLanes& lanes)
{
    lanes = *reinterpret_cast<const DoubleLanesAnywhere*>(from);
}
/// To memory of any alignment.
VDB_SHELL_LANES_PART void store_lanes(const Lanes& lanes, float* to)
{
    *reinterpret_cast<LanesAnywhere*>(to) = lanes;
}
VDB_SHELL_LANES_PART void store_lanes(const DoubleLanes& lanes, double* to)
{
    *reinterpret_cast<DoubleLanesAnywhere*>(to) = lanes;
}

VDB_SHELL_LANES_PART void lower_to(Lanes& least, const Lanes& other)
{
    least = other < least ? other : least;
}
VDB_SHELL_LANES_PART void raise_to(Lanes& most, const Lanes& other)
{
    most = other > most ? other : most;
}

/// A bit for each lane of a comparison that is true, the first lane's the lowest.
VDB_SHELL_LANES_PART unsigned bits_of(const LaneIndices& comparison)
{
    LaneIndices bits = comparison & LaneIndices{1, 2, 4, 8, 16, 32, 64, 128};
    bits |= __builtin_shufflevector(bits, bits, 4, 5, 6, 7, 0, 1, 2, 3);
    bits |= __builtin_shufflevector(bits, bits, 2, 3, 0, 1, 6, 7, 4, 5);
    bits |= __builtin_shufflevector(bits, bits, 1, 0, 3, 2, 5, 4, 7, 6);
    return static_cast<unsigned>(bits[0]);
}

/// What comparing doubles gives.
using DoubleTruths = decltype(DoubleLanes{} < DoubleLanes{});

/// The same for doubles.
VDB_SHELL_LANES_PART unsigned bits_of(const DoubleTruths& comparison)
{
    const DoubleTruths bits = comparison & DoubleTruths{1, 2, 4, 8};
    return static_cast<unsigned>((bits[0] | bits[1]) | (bits[2] | bits[3]));
}

} // namespace vdb_shell

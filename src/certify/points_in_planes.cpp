// SPDX-License-Identifier: Apache-2.0

// Takes: points in one array for each axis, runs of them, and four planes. Gives: the places of the
// points that no plane excludes. It is the inner loop of coverage, so it is compiled once for each
// kind of processor (core/simd.h), and eight points are looked at together. Floats decide nothing
// here but what may be left out: the planes have been moved outward by more than the rounding of
// this very expression, term by term without contraction, so the result has the same bits on every
// processor.

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "certify/points_in_planes.cpp"
#include <hwy/foreach_target.h>

#include "certify/points_in_planes.h"
#include "core/dispatch.h"
#include "core/simd-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vdb_shell
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;

std::size_t points_in_planes(const std::array<const float*, 3>& points, const PointRun* runs,
                             std::size_t count, const FloatPlanes& planes, std::uint32_t* inside)
{
    const std::uint32_t* const first = inside;
    for (const PointRun* run = runs; run != runs + count; ++run)
        for (std::uint32_t k = run->begin; k < run->end; k += kLanes) {
            const Floats x = Floats::load(points[0] + k), y = Floats::load(points[1] + k),
                         z = Floats::load(points[2] + k);
            const auto beyond = [&](std::size_t face) HWY_ATTR {
                const auto& [nx, ny, nz] = planes.outward[face];
                // A comparison with something that is not a number is false: a plane that was lost
                // in the rounding excludes no point.
                return nx * x + ny * y + nz * z > planes.most[face];
            };
            const unsigned outside = bits_of((beyond(0) | beyond(1)) | (beyond(2) | beyond(3)));
            // The last group of a run reads points of the next run, or the room behind the last of
            // them. Those lanes are masked, so what stands there is of no consequence.
            const std::uint32_t left = run->end - k;
            const unsigned valid = left < kLanes ? (1U << left) - 1 : 0xFFU;
            for (unsigned bits = ~outside & valid; bits != 0; bits &= bits - 1)
                *inside++ = k + unsigned(__builtin_ctz(bits));
        }
    return static_cast<std::size_t>(inside - first);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell
{

HWY_EXPORT(points_in_planes);

std::size_t points_in_planes(const std::array<const float*, 3>& points, const PointRun* runs,
                             std::size_t count, const FloatPlanes& planes, std::uint32_t* inside)
{
    return VDB_SHELL_KERNEL(points_in_planes)(points, runs, count, planes, inside);
}

} // namespace vdb_shell
#endif

// SPDX-License-Identifier: Apache-2.0
#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "certify/points_in_planes.cpp"
#include <hwy/foreach_target.h>

#include "certify/points_in_planes.h"
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
                return nx * x + ny * y + nz * z > planes.most[face];
            };
            const unsigned outside = bits_of((beyond(0) | beyond(1)) | (beyond(2) | beyond(3)));
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
    return HWY_DYNAMIC_DISPATCH(points_in_planes)(points, runs, count, planes, inside);
}

} // namespace vdb_shell
#endif

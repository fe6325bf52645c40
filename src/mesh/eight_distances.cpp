// SPDX-License-Identifier: Apache-2.0
// Distances from eight points at a time to triangles that were prepared beforehand, in float32,
// with Highway (core/simd.h says how sources like this are laid out). Each lane computes what it
// would compute alone, so the results have the same bits for vectors of any width. Where several
// triangles are equally near, the first of the list is chosen. Coordinates have to be relative to a
// place nearby: the error of floats is in proportion to them.

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/eight_distances.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/simd-inl.h"
#include "mesh/eight_distances.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace vdb_shell
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;

/// Both answers are computed in all lanes, without a branch: the distance to the three sides, and
/// the height over the plane for a point that projects into the triangle. A point exactly over a
/// side gets the same distance from both, so rounding in the choice between them does no harm.
HWY_INLINE void distances(const PreparedTriangle& t, const FloatPoint& p, Floats& squared,
                          Floats& height)
{
    const Floats zero(0.0F), one(1.0F);
    Floats nearest(3e38F), outside(t.bias), over = zero;
    for (const PreparedTriangle::Side& s : t.side) {
        const Floats x = p[0] - s.x, y = p[1] - s.y, z = p[2] - s.z;
        const Floats along = clamped((x * s.ex + y * s.ey + z * s.ez) * s.inverse, zero, one);
        const Floats dx = x - along * s.ex, dy = y - along * s.ey, dz = z - along * s.ez;
        lower_to(nearest, dx * dx + dy * dy + dz * dz);
        // The normals of the sides are not of unit length, since only the sign of the largest
        // product matters.
        raise_to(outside, x * s.mx + y * s.my + z * s.mz);
        // Any corner will do for the height over the plane; the last one's stays.
        over = x * t.nx + y * t.ny + z * t.nz;
    }
    const auto beside = outside > zero;
    squared = select(beside, nearest, over * over);
    height = select(beside, zero, over);
}

void nearest_of(const PreparedTriangle* triangles, const std::uint32_t* list, std::size_t count,
                const EightPoints& points, float* squared, EightNearest& nearest)
{
    const FloatPoint p{Floats::load(points.x.data()), Floats::load(points.y.data()),
                       Floats::load(points.z.data())};
    Floats least(std::numeric_limits<float>::max()), height(0.0F);
    Integers triangle(0);
    for (std::size_t i = 0; i < count; ++i) {
        Floats d, over;
        distances(triangles[list[i]], p, d, over);
        if (squared != nullptr)
            store(d, squared + i * kLanes);
        // The comparison is strict, so that of equally near triangles the first one stays.
        const auto nearer = d < least;
        triangle =
            select(for_integers(nearer), Integers(static_cast<std::int32_t>(list[i])), triangle);
        height = select(nearer, over, height);
        lower_to(least, d);
    }
    store(least, nearest.squared.data());
    store(height, nearest.height.data());
    store(triangle, nearest.triangle.data());
}

void list_within(const float* squared, std::size_t count, const std::array<float, kLanes>& limit,
                 std::uint8_t* bits)
{
    const Floats most = Floats::load(limit.data());
    for (std::size_t i = 0; i < count; ++i)
        bits[i] = static_cast<std::uint8_t>(bits_of(Floats::load(squared + i * kLanes) <= most));
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell
{

HWY_EXPORT(nearest_of);
HWY_EXPORT(list_within);

void nearest_of(const PreparedTriangle* triangles, const std::uint32_t* list, std::size_t count,
                const EightPoints& points, float* squared, EightNearest& nearest)
{
    VDB_SHELL_KERNEL(nearest_of)(triangles, list, count, points, squared, nearest);
}

void list_within(const float* squared, std::size_t count, const std::array<float, kLanes>& limit,
                 std::uint8_t* bits)
{
    VDB_SHELL_KERNEL(list_within)(squared, count, limit, bits);
}

} // namespace vdb_shell
#endif

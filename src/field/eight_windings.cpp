// SPDX-License-Identifier: Apache-2.0
// The winding number of near triangles and far clusters around eight points at a time, in float32,
// with Highway (core/simd.h says how sources like this are laid out). The solid angle of a triangle
// is twice the argument of a complex number (A. van Oosterom and J. Strackee, 1983). The sum of
// arguments is the argument of the product, and the full turns that the product's argument leaves
// out are counted where it passes the negative real axis. So there is one arc tangent for a point,
// not one for a triangle and point.

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "field/eight_windings.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/simd-inl.h"
#include "field/eight_windings.h"

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace vdb_shell
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;

HWY_INLINE FloatPoint to(const std::array<float, 3>& a, const FloatPoint& from)
{
    return {Floats(a[0]) - from[0], Floats(a[1]) - from[1], Floats(a[2]) - from[2]};
}

/// A sum of half solid angles: the argument of re + i im, and 2 pi for each of `laps`.
struct HalfAngles {
    Floats re, im, laps;
};

HWY_INLINE void add(const NearTriangle& triangle, const FloatPoint& p, HalfAngles& sum)
{
    const Floats zero(0.0F), one(1.0F);
    const FloatPoint a = to(triangle.corners[0], p), b = to(triangle.corners[1], p),
                     c = to(triangle.corners[2], p);
    const Floats la = square_root(dot(a, a)), lb = square_root(dot(b, b)),
                 lc = square_root(dot(c, c));
    const Floats y = dot(a, cross(b, c));
    const Floats x = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    // In the triangle's plane the angle is 0, and on the triangle itself the mean of both sides.
    const auto flat = absolute(y) <= zero;
    const Floats tx = select(flat, one, x);
    const Floats re = sum.re * tx - sum.im * y, im = sum.re * y + sum.im * tx;
    const auto above = sum.im >= zero, turned = im < zero;
    sum.laps += select(above & turned & (y > zero), one, zero);
    sum.laps -= select((sum.im < zero) & (im >= zero) & (y < zero), one, zero);
    // Only the argument counts; the size is kept from leaving the range of floats. It is 0 where
    // both numbers underflow, for a point on a corner: such a triangle is left out.
    const Floats size = greater(absolute(re), absolute(im));
    const auto sound = size > zero;
    const Floats scale = one / select(sound, size, one);
    sum.re = select(sound, re * scale, sum.re);
    sum.im = select(sound, im * scale, sum.im);
}

/// The solid angle of a far small area is its area vector times the direction over the distance
/// cubed. `way`: to it; `squared`: of its length.
HWY_INLINE Floats solid_angle(const FarCluster& cluster, const FloatPoint& way, Floats squared)
{
    const std::array<float, 3>& n = cluster.area_normal;
    return (Floats(n[0]) * way[0] + Floats(n[1]) * way[1] + Floats(n[2]) * way[2]) *
           (Floats(1.0F) / (squared * square_root(squared)));
}

void sum_up(const FarCluster* clusters, std::size_t cluster_count, const NearTriangle* triangles,
            std::size_t triangle_count, const EightPoints& points, float* dipoles, float* re,
            float* im, float* laps)
{
    const FloatPoint p{Floats::load(points.x.data()), Floats::load(points.y.data()),
                       Floats::load(points.z.data())};
    Floats far(0.0F);
    for (std::size_t i = 0; i < cluster_count; ++i) {
        const FloatPoint way = to(clusters[i].centre, p);
        far += solid_angle(clusters[i], way, dot(way, way));
    }
    HalfAngles near{Floats(1.0F), Floats(0.0F), Floats(0.0F)};
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const NearTriangle& triangle = triangles[i];
        const FloatPoint way = to(triangle.from_afar.centre, p);
        const Floats squared = dot(way, way);
        if (bits_of(squared <= Floats(triangle.squared_far)) == 0)
            far += solid_angle(triangle.from_afar, way, squared);
        else
            add(triangle, p, near);
    }
    store(far, dipoles);
    store(near.re, re);
    store(near.im, im);
    store(near.laps, laps);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell
{

HWY_EXPORT(sum_up);

void turns_around(const FarCluster* clusters, std::size_t cluster_count,
                  const NearTriangle* triangles, std::size_t triangle_count,
                  const EightPoints& points, std::array<float, kLanes>& turns)
{
    constexpr float kFullTurn = 6.28318530717958648F;
    alignas(kLanesAlignment) std::array<float, kLanes> far, re, im, laps;
    VDB_SHELL_KERNEL(sum_up)
    (clusters, cluster_count, triangles, triangle_count, points, far.data(), re.data(), im.data(),
     laps.data());
    // A turn is a solid angle of 4 pi, which is a half angle of 2 pi.
    for (std::size_t i = 0; i < kLanes; ++i)
        turns[i] = far[i] / (2 * kFullTurn) + std::atan2(im[i], re[i]) / kFullTurn + laps[i];
}

} // namespace vdb_shell
#endif

// SPDX-License-Identifier: Apache-2.0

// Takes: the prisms around the inner point of one vertex. Gives: whether the eight tets of a prism
// that hold the point are surely positive with it at x, or the half-spaces that they keep it in, or
// the slopes of what it is short of these. Four tets make a group of lanes, two groups a prism. A
// yes of surely_positive is a proof, by the error bound of core/orient3d_filter.h; a no means that
// the exact predicates have to decide. The half-spaces are a hint in plain doubles. The layout of
// the file is that of all kernels, and the bits are the same on every processor: core/simd.h.

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "growth/prism_lanes.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/orient3d_filter-inl.h"
#include "core/simd-inl.h"
#include "growth/prism_lanes.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace vdb_shell::growth
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;

// A pick reaches the four corners of one group only. Where these are 0 the fifth corner takes its
// place.
alignas(kLanesAlignment) constexpr double kFourth[kDoubleLanes] = {0, 0, 0, 1};
alignas(kLanesAlignment) constexpr double kMiddle[kDoubleLanes] = {0, 1, 1, 0};

/// Bases of four tets, by corner and relative to their apex: the apex lies where p.(u x w) is
/// negative if they are positive.
struct Bases {
    DoublePoint p, u, w;
};

/// As PrismTables has them, in an order of their own: those of half 0 belong to the pillars of the
/// vertex, the next one, the last and the vertex, those of half 1 to the last, the vertex, the next
/// and the vertex.
HWY_INLINE void bases_around(const PrismAround& prism, const double* apex,
                             std::array<Bases, 2>& half)
{
    for (std::size_t k = 0; k < 3; ++k) {
        const Doubles corners =
            four(prism.outer[k], prism.outer_next[k], prism.outer_last[k], prism.inner_next[k]) -
            apex[k];
        const Doubles fifth(prism.inner_last[k] - apex[k]);
        const auto fourth = Doubles::load(kFourth) > 0.0, middle = Doubles::load(kMiddle) > 0.0;
        half[0].p[k] = select(fourth, pick<2, 2, 2, 2>(corners), fifth);
        half[0].u[k] = pick<3, 3, 1, 1>(corners);
        half[0].w[k] = pick<0, 1, 2, 0>(corners);
        half[1].p[k] = select(middle, pick<3, 3, 3, 3>(corners), fifth);
        half[1].u[k] = pick<3, 0, 1, 1>(corners);
        half[1].w[k] = pick<2, 2, 2, 0>(corners);
    }
}

bool surely_positive(const PrismAround& prism, const double* x)
{
    std::array<Bases, 2> half;
    bases_around(prism, x, half);
    // A tet is positive when its apex is on the negative side of p, u, w; with u and w exchanged
    // the margin is that of the opposite sign.
    const Doubles first = orient3d_margin(half[0].p, half[0].w, half[0].u),
                  second = orient3d_margin(half[1].p, half[1].w, half[1].u);
    return bits_of(lesser(second, first) > 0.0) == 0xFU;
}

/// The bounds of four tets of a prism; `counts` is 0 for a tet that does not. Such a tet, and one
/// whose base has no area, come out with a normal of nought and an endless value, so that no sum
/// has to look at which lanes count.
HWY_INLINE Doubles bound(const Bases& bases, Doubles counts, TetBounds& out)
{
    constexpr double kEnough = std::numeric_limits<double>::infinity();
    const DoublePoint& p = bases.p;
    DoublePoint u, w;
    for (std::size_t k = 0; k < 3; ++k)
        u[k] = bases.u[k] - p[k], w[k] = bases.w[k] - p[k];
    const Doubles x = u[1] * w[2] - u[2] * w[1], y = u[2] * w[0] - u[0] * w[2],
                  z = u[0] * w[1] - u[1] * w[0], value = -(x * p[0] + y * p[1] + z * p[2]);
    const Doubles squared = (x * x + y * y + z * z) * counts;
    const auto some = squared > 0.0;
    const Doubles inverse = select(some, 1.0 / square_root(squared), Doubles(0.0));
    const Doubles scaled = select(some, value * inverse, Doubles(kEnough));
    store(x * inverse, out.x.data());
    store(y * inverse, out.y.data());
    store(z * inverse, out.z.data());
    store(scaled, out.value.data());
    return scaled;
}

double bound_tets(const CountedPrism* prisms, std::size_t count, const double* here,
                  TetBounds* bounds)
{
    Doubles least(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < count; ++i) {
        const auto& [prism, of_next, of_last] = prisms[i];
        std::array<Bases, 2> half;
        bases_around(prism, here, half);
        lower_to(least, bound(half[0], four(1, of_next, of_last, 1), bounds[2 * i]));
        lower_to(least, bound(half[1], four(of_last, 1, of_next, 1), bounds[2 * i + 1]));
    }
    alignas(kLanesAlignment) std::array<double, kDoubleLanes> lanes;
    store(least, lanes.data());
    double lowest = lanes[0];
    for (const double lane : lanes)
        lowest = lane < lowest ? lane : lowest;
    return lowest;
}

ShortfallSlopes sum_shortfalls(const TetBounds* bounds, std::size_t count, double room,
                               const double* x)
{
    const Doubles zero(0.0);
    Doubles gx(zero), gy(zero), gz(zero), xx(zero), xy(zero), xz(zero), yy(zero), yz(zero),
        zz(zero);
    for (const TetBounds* b = bounds; b != bounds + count; ++b) {
        Doubles nx = Doubles::load(b->x.data()), ny = Doubles::load(b->y.data()),
                nz = Doubles::load(b->z.data());
        // A bound that is met has no part: the sum is that of squares of what is missing, and the
        // step that it gives is zero where all bounds are met.
        const Doubles open =
            room - Doubles::load(b->value.data()) - (nx * x[0] + ny * x[1] + nz * x[2]);
        const auto is_short = open > zero;
        const Doubles by = select(is_short, open, zero);
        nx = select(is_short, nx, zero), ny = select(is_short, ny, zero),
        nz = select(is_short, nz, zero);
        gx += by * nx, gy += by * ny, gz += by * nz;
        xx += nx * nx, xy += nx * ny, xz += nx * nz;
        yy += ny * ny, yz += ny * nz, zz += nz * nz;
    }
    return {sum_of(gx), sum_of(gy), sum_of(gz), sum_of(xx), sum_of(xy),
            sum_of(xz), sum_of(yy), sum_of(yz), sum_of(zz)};
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell::growth
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell::growth
{

HWY_EXPORT(surely_positive);
HWY_EXPORT(bound_tets);
HWY_EXPORT(sum_shortfalls);

bool surely_positive(const PrismAround& prism, const double* x)
{
    return VDB_SHELL_KERNEL(surely_positive)(prism, x);
}

double bound_tets(const CountedPrism* prisms, std::size_t count, const double* here,
                  TetBounds* bounds)
{
    return VDB_SHELL_KERNEL(bound_tets)(prisms, count, here, bounds);
}

ShortfallSlopes sum_shortfalls(const TetBounds* bounds, std::size_t count, double room,
                               const double* x)
{
    return VDB_SHELL_KERNEL(sum_shortfalls)(bounds, count, room, x);
}

} // namespace vdb_shell::growth
#endif

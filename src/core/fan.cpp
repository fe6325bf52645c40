// SPDX-License-Identifier: Apache-2.0

// Shows quickly that the triangles around a vertex meet in common corners and edges only
// (docs/theory.md, "Fans", which has the proof). It takes the spokes of a closed fan in doubles; a
// yes is certain, a no tells nothing, and the caller then tests pairs exactly. All bounds are
// multiples of the rounding of the very expressions below, in the manner of Shewchuk (1997), so the
// operations must not be reordered or contracted. Traps: this source is compiled once for each kind
// of processor (core/simd.h), and answers are bits of 32-bit words, so a fan has at most Fan::kMost
// triangles.

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/fan.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/fan.h"
#include "core/orient3d_filter-inl.h"
#include "core/simd-inl.h"

#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace vdb_shell
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;

constexpr std::size_t kMostBlocks = Fan::kMost / kDoubleLanes;

HWY_INLINE std::size_t blocks_of(std::size_t count)
{
    return (count + kDoubleLanes - 1) / kDoubleLanes;
}

HWY_INLINE DoublePoint load(const Fan::Spokes& spokes, std::size_t first)
{
    return {Doubles::load(spokes[0].data() + first), Doubles::load(spokes[1].data() + first),
            Doubles::load(spokes[2].data() + first)};
}

/// Twice the area of each triangle as a vector, and what bounds its rounding.
struct Areas {
    std::array<DoublePoint, kMostBlocks> area, size;
    std::array<double, 3> sum;
};

/// The lanes in one fixed order, so that all processors get the same bits.
HWY_INLINE double sum_in_order(Doubles x)
{
    alignas(kLanesAlignment) double lane[kDoubleLanes];
    store(x, lane);
    return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

HWY_INLINE void find_areas(const Fan::Spokes& spokes, std::size_t blocks, Areas& out)
{
    DoublePoint sum{Doubles(0.0), Doubles(0.0), Doubles(0.0)};
    for (std::size_t block = 0; block < blocks; ++block) {
        // In the lanes behind the last triangle both are the first spoke. Both products are then
        // the same number and the area is exactly 0, so that the sum needs no mask.
        const DoublePoint u = load(spokes, block * kDoubleLanes),
                          w = load(spokes, block * kDoubleLanes + 1);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const Doubles left = u[i] * w[j], right = u[j] * w[i];
            out.area[block][k] = left - right;
            sum[k] += out.area[block][k];
            out.size[block][k] = absolute(left) + absolute(right);
        }
    }
    for (std::size_t k = 0; k < 3; ++k)
        out.sum[k] = sum_in_order(sum[k]);
}

/// A bit for each triangle that surely turns left, seen against `along`.
HWY_INLINE std::uint32_t turning_left(const Areas& areas, std::size_t blocks)
{
    // Three times the error bound of the determinant. The margin is there for below(), whose signs
    // are rounded: they are right for spokes that differ from the real ones by a few roundings, and
    // a change so small cannot bring a determinant of this size to 0.
    constexpr double kError = 3 * exact::kOrientError;
    std::uint32_t bits = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        Doubles det(0.0), permanent(0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            det += areas.sum[k] * areas.area[block][k];
            permanent += std::abs(areas.sum[k]) * areas.size[block][k];
        }
        bits |= bits_of(certain_margin(det, permanent, kError) > 0.0) << (block * kDoubleLanes);
    }
    return bits;
}

/// A bit for each spoke that lies below a line through the apex, seen along `along`. The vector
/// across the line is (along[k], -along[j]) on the axes j and k, which is exactly square to `along`
/// without any rounding. The largest axis is one of them, so that it is not nearly zero.
HWY_INLINE std::uint32_t below(const Fan::Spokes& spokes, std::size_t blocks,
                               const std::array<double, 3>& along)
{
    const std::array<double, 3> size{std::abs(along[0]), std::abs(along[1]), std::abs(along[2])};
    const std::size_t k = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    const std::size_t j = (k + 1) % 3;
    std::uint32_t bits = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        const DoublePoint spoke = load(spokes, block * kDoubleLanes);
        bits |= bits_of(spoke[j] * along[k] - spoke[k] * along[j] < 0.0) << (block * kDoubleLanes);
    }
    return bits;
}

bool side_by_side(const Fan::Spokes& spokes, std::size_t count)
{
    const std::size_t blocks = blocks_of(count);
    const std::uint32_t all = (1U << count) - 1;
    Areas areas;
    find_areas(spokes, blocks, areas);
    if ((turning_left(areas, blocks) & all) != all)
        return false;
    // Each turn around the apex, the spokes come once from below the line to above it. So exactly
    // one such step means exactly one turn, and the sectors have no inside in common. The bits of
    // `before` are those of the spoke before, in a ring.
    const std::uint32_t now = below(spokes, blocks, areas.sum) & all;
    const std::uint32_t before = (now << 1 | now >> (count - 1)) & all;
    const std::uint32_t risen = before & ~now;
    return risen != 0 && (risen & (risen - 1)) == 0;
}

HWY_INLINE std::uint32_t surely_above(const DoublePoint& across, const DoublePoint& arm,
                                      double sign)
{
    // One rounding of each difference, one of each product, two of sums: four times 1.1e-16. The
    // vector `across` counts as given, with whatever rounding it has.
    constexpr double kError = 6e-16;
    Doubles value(0.0), size(0.0);
    for (std::size_t k = 0; k < 3; ++k) {
        const Doubles product = across[k] * arm[k];
        value += product, size += absolute(product);
    }
    return bits_of(certain_margin(sign * value, size, kError) > 0.0);
}

/// Takes the plane through the apex that halves the angle between the middles of two triangles. If
/// both spokes of one triangle are strictly above it and both of the other strictly below, the two
/// share the apex only. Any plane that does so proves it, so the rounding of the plane itself does
/// not matter. Neighbours, and triangle i itself, have a spoke in common with triangle i, which
/// cannot be on both sides; their bits stay unset.
std::uint32_t apart_from(const Fan::Spokes& spokes, std::size_t count, std::size_t i)
{
    std::array<DoublePoint, 2> own;
    std::array<double, 3> own_middle;
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        own[0][k] = Doubles(spokes[k][i]);
        own[1][k] = Doubles(spokes[k][i + 1]);
        own_middle[k] = spokes[k][i] + spokes[k][i + 1];
        squared += own_middle[k] * own_middle[k];
    }
    const double own_length = std::sqrt(squared);
    std::uint32_t bits = 0;
    for (std::size_t block = 0; block < blocks_of(count); ++block) {
        const DoublePoint u = load(spokes, block * kDoubleLanes),
                          w = load(spokes, block * kDoubleLanes + 1);
        DoublePoint middle, across;
        Doubles length_squared(0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            middle[k] = u[k] + w[k];
            length_squared += middle[k] * middle[k];
        }
        const Doubles length = square_root(length_squared);
        for (std::size_t k = 0; k < 3; ++k)
            across[k] = own_middle[k] * length - middle[k] * own_length;
        const std::uint32_t apart = surely_above(across, own[0], 1) &
                                    surely_above(across, own[1], 1) & surely_above(across, u, -1) &
                                    surely_above(across, w, -1);
        bits |= apart << (block * kDoubleLanes);
    }
    return bits & ((1U << count) - 1);
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell
{

HWY_EXPORT(side_by_side);
HWY_EXPORT(apart_from);

bool Fan::surely_embedded() const
{
    return VDB_SHELL_KERNEL(side_by_side)(spoke_, count_);
}

std::uint32_t Fan::surely_apart_from(std::size_t i) const
{
    return VDB_SHELL_KERNEL(apart_from)(spoke_, count_, i);
}

} // namespace vdb_shell
#endif

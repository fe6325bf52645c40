// SPDX-License-Identifier: Apache-2.0
#include "core/fan.h"

#include "core/lanes.h"
#include "core/orient3d_filter.h"

#include <cmath>

namespace vdb_shell
{
namespace
{

constexpr std::size_t kMostBlocks = Fan::kMost / kDoubleLanes;

VDB_SHELL_LANES_PART std::size_t blocks_of(std::size_t count)
{
    return (count + kDoubleLanes - 1) / kDoubleLanes;
}

VDB_SHELL_LANES_PART void load(const Fan::Spokes& spokes, std::size_t first, DoublePoint& out)
{
    for (std::size_t k = 0; k < 3; ++k)
        load_lanes(spokes[k].data() + first, out[k]);
}

VDB_SHELL_LANES_PART void magnitude(const DoubleLanes& x, DoubleLanes& out)
{
    out = x < 0 ? -x : x;
}

/// Twice the area of each triangle as a vector, and what bounds its rounding.
struct Areas {
    std::array<DoublePoint, kMostBlocks> area, size;
    std::array<double, 3> sum;
};

VDB_SHELL_LANES_PART void find_areas(const Fan::Spokes& spokes, std::size_t blocks, Areas& out)
{
    DoublePoint sum;
    for (DoubleLanes& x : sum)
        x = DoubleLanes{};
    for (std::size_t block = 0; block < blocks; ++block) {
        DoublePoint u, w;
        load(spokes, block * kDoubleLanes, u);
        load(spokes, block * kDoubleLanes + 1, w);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const DoubleLanes left = u[i] * w[j], right = u[j] * w[i];
            out.area[block][k] = left - right;
            sum[k] += out.area[block][k];
            DoubleLanes other;
            magnitude(left, out.size[block][k]), magnitude(right, other);
            out.size[block][k] += other;
        }
    }
    for (std::size_t k = 0; k < 3; ++k)
        out.sum[k] = (sum[k][0] + sum[k][1]) + (sum[k][2] + sum[k][3]);
}

/// A bit for each triangle that surely turns left, seen against `along`.
VDB_SHELL_LANES_PART std::uint32_t turning_left(const Areas& areas, std::size_t blocks)
{
    // Beyond the error of a determinant, so much that below() may be off in its last bits.
    constexpr double kError = 3 * exact::kOrientError;
    std::uint32_t bits = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        DoubleLanes det{}, permanent{};
        for (std::size_t k = 0; k < 3; ++k) {
            det += areas.sum[k] * areas.area[block][k];
            permanent += std::abs(areas.sum[k]) * areas.size[block][k];
        }
        bits |= bits_of(det > kError * permanent + exact::kUnderflowGuard)
                << (block * kDoubleLanes);
    }
    return bits;
}

/// A bit for each spoke that lies below a line through the apex, seen along `along`.
VDB_SHELL_LANES_PART std::uint32_t below(const Fan::Spokes& spokes, std::size_t blocks,
                                         const std::array<double, 3>& along)
{
    const std::array<double, 3> size{std::abs(along[0]), std::abs(along[1]), std::abs(along[2])};
    const std::size_t k = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    const std::size_t j = (k + 1) % 3;
    std::uint32_t bits = 0;
    for (std::size_t block = 0; block < blocks; ++block) {
        DoublePoint spoke;
        load(spokes, block * kDoubleLanes, spoke);
        bits |= bits_of(spoke[j] * along[k] - spoke[k] * along[j] < 0) << (block * kDoubleLanes);
    }
    return bits;
}

VDB_SHELL_TWO_TARGETS bool side_by_side(const Fan::Spokes& spokes, std::size_t count)
{
    const std::size_t blocks = blocks_of(count);
    const std::uint32_t all = (1U << count) - 1;
    Areas areas;
    find_areas(spokes, blocks, areas);
    if ((turning_left(areas, blocks) & all) != all)
        return false;
    // Each time round, the spokes come once from below the line to above it.
    const std::uint32_t now = below(spokes, blocks, areas.sum) & all;
    const std::uint32_t before = (now << 1 | now >> (count - 1)) & all;
    const std::uint32_t risen = before & ~now;
    return risen != 0 && (risen & (risen - 1)) == 0;
}

VDB_SHELL_LANES_PART void surely_positive(const DoublePoint& across, const DoublePoint& arm,
                                          double sign, std::uint32_t& bits)
{
    // One rounding of each difference, one of each product, two of sums.
    constexpr double kError = 6e-16;
    DoubleLanes value{}, size{};
    for (std::size_t k = 0; k < 3; ++k) {
        const DoubleLanes product = across[k] * arm[k];
        DoubleLanes other;
        magnitude(product, other);
        value += product, size += other;
    }
    bits &= bits_of(sign * value > kError * size + exact::kUnderflowGuard);
}

/// Across the plane through the apex that halves the angle between two middles; whatever its
/// rounding, it is as good as any other if it has the two on its two sides.
VDB_SHELL_TWO_TARGETS std::uint32_t apart_from(const Fan::Spokes& spokes, std::size_t count,
                                               std::size_t i)
{
    std::array<DoublePoint, 2> own;
    DoublePoint own_middle;
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        own[0][k] = DoubleLanes{} + spokes[k][i];
        own[1][k] = DoubleLanes{} + spokes[k][i + 1];
        own_middle[k] = own[0][k] + own[1][k];
        squared += own_middle[k][0] * own_middle[k][0];
    }
    const double own_length = std::sqrt(squared);
    std::uint32_t bits = 0;
    for (std::size_t block = 0; block < blocks_of(count); ++block) {
        DoublePoint u, w, middle, across;
        load(spokes, block * kDoubleLanes, u);
        load(spokes, block * kDoubleLanes + 1, w);
        DoubleLanes length{};
        for (std::size_t k = 0; k < 3; ++k) {
            middle[k] = u[k] + w[k];
            length += middle[k] * middle[k];
        }
        for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
            length[lane] = std::sqrt(length[lane]);
        for (std::size_t k = 0; k < 3; ++k)
            across[k] = own_middle[k] * length - middle[k] * own_length;
        std::uint32_t apart = (1U << kDoubleLanes) - 1;
        surely_positive(across, own[0], 1, apart);
        surely_positive(across, own[1], 1, apart);
        surely_positive(across, u, -1, apart);
        surely_positive(across, w, -1, apart);
        bits |= apart << (block * kDoubleLanes);
    }
    return bits & ((1U << count) - 1);
}

} // namespace

bool Fan::surely_embedded() const
{
    return side_by_side(spoke_, count_);
}

std::uint32_t Fan::surely_apart_from(std::size_t i) const
{
    return apart_from(spoke_, count_, i);
}

} // namespace vdb_shell

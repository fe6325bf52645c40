// SPDX-License-Identifier: Apache-2.0
#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "write/depth_lines.cpp"
#include <hwy/foreach_target.h>

#include "core/simd-inl.h"
#include "write/depth_lines.h"

HWY_BEFORE_NAMESPACE();
namespace vdb_shell
{
namespace HWY_NAMESPACE
{
namespace
{

using namespace simd::HWY_NAMESPACE;

alignas(kLanesAlignment) constexpr double kUpToThree[kDoubleLanes] = {0, 1, 2, 3};
alignas(kLanesAlignment) constexpr float kUpToSeven[kLanes] = {0, 1, 2, 3, 4, 5, 6, 7};

HWY_INLINE void find_ends(const TetLines& tet, double dx, Doubles dy, std::int32_t* first,
                          std::int32_t* last)
{
    // Bounds outside of the tet's box stay next to it, where they are integers that exist.
    const Doubles least(tet.low_z - 1.0), most(tet.high_z + 1.0);
    Doubles low = least + 1.0, high = most - 1.0;
    for (std::size_t i = 0; i < tet.floors; ++i)
        raise_to(low, tet.floor[i].at + tet.floor[i].by_x * dx + tet.floor[i].by_y * dy);
    for (std::size_t i = 0; i < tet.ceilings; ++i)
        lower_to(high, tet.ceiling[i].at + tet.ceiling[i].by_x * dx + tet.ceiling[i].by_y * dy);
    for (std::size_t i = 0; i < tet.sides; ++i) {
        const Doubles weight =
            tet.side[i].at + tet.side[i].by_x * dx + tet.slack + tet.side[i].by_y * dy;
        high = select(weight < 0.0, least, high);
    }
    store(to_integers(rounded_up(lesser(low, most))), first);
    store(to_integers(rounded_down(greater(high, least))), last);
}

void find_line_ends(const TetLines& tet, int x, std::size_t count, int y, LineEnds* ends)
{
    const Doubles up_to_three = Doubles::load(kUpToThree);
    for (std::size_t i = 0; i < count; ++i) {
        const double dx = (x + static_cast<int>(i)) - tet.origin_x;
        for (std::size_t from = 0; from < std::size_t(kLeafSize); from += kDoubleLanes)
            find_ends(tet, dx, y + double(from) - tet.origin_y + up_to_three,
                      ends[i].first.data() + from, ends[i].last.data() + from);
    }
}

HWY_INLINE Group<float, kDoubleLanes> depth_from(const DepthRow& row, const DepthAlongZ& depth,
                                                 double from)
{
    const Doubles at = row.z + from - depth.origin + Doubles::load(kUpToThree);
    return to_floats(
        clamped(depth.value + (row.depth + depth.slope * at), Doubles(0.0), Doubles(1.0)));
}

void fill_depth_rows(const DepthRow* rows, std::size_t count, const DepthAlongZ& depth)
{
    const Floats place = Floats::load(kUpToSeven);
    for (const DepthRow* row = rows; row != rows + count; ++row) {
        const Floats depths(depth_from(*row, depth, 0.0), depth_from(*row, depth, 4.0));
        const auto inside =
            (place >= static_cast<float>(row->begin)) & (place < static_cast<float>(row->end));
        // All eight at a time are faster than a loop of few.
        store(select(inside, depths, Floats::load(row->value)), row->value);
    }
}

} // namespace
} // namespace HWY_NAMESPACE
} // namespace vdb_shell
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vdb_shell
{

HWY_EXPORT(find_line_ends);
HWY_EXPORT(fill_depth_rows);

void find_line_ends(const TetLines& tet, int x, std::size_t count, int y, LineEnds* ends)
{
    HWY_DYNAMIC_DISPATCH(find_line_ends)(tet, x, count, y, ends);
}

void fill_depth_rows(const DepthRow* rows, std::size_t count, const DepthAlongZ& depth)
{
    HWY_DYNAMIC_DISPATCH(fill_depth_rows)(rows, count, depth);
}

} // namespace vdb_shell
#endif

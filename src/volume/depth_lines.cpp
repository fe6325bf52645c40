// SPDX-License-Identifier: Apache-2.0

// The inner loops of tet_columns.cpp and tet_values_grid.cpp, for eight rows, lines or voxels at a
// time: which rows a tet's shadow meets, where lines along z enter and leave it, and the depths of
// a leaf's row. The file is compiled once for each instruction set that Highway knows, and the best
// one is chosen when the program runs. The groups have four doubles and eight floats on all of
// them, so the lines are always taken in the same groups. A trap: the includes above
// HWY_BEFORE_NAMESPACE are seen once, all that follows several times.

#include "core/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/depth_lines.cpp"
#include <hwy/foreach_target.h>

#include "core/dispatch.h"
#include "core/simd-inl.h"
#include "volume/depth_lines.h"

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

HWY_INLINE void find_rows_at(const TetShadow& shadow, Doubles x, std::int32_t* first,
                             std::int32_t* last)
{
    // Out of reach of every tet, and an integer.
    const Doubles far(double(1 << 30));
    Doubles low = far, high = -far;
    const auto add = [&](auto which, Doubles y) {
        lower_to(low, select(which, y, far));
        raise_to(high, select(which, y, -far));
    };
    // The shadow is convex, so it lies between the places where edges pass x.
    for (const TetShadow::Edge& edge : shadow.edge)
        add((x > edge.x) & (x <= edge.end_x), edge.y + edge.slope * (x - edge.x));
    // An edge that is nearly parallel to y passes x anywhere between its ends.
    for (const TetShadow::Corner& corner : shadow.corner)
        add((x >= corner.x - shadow.slack) & (x <= corner.x + shadow.slack), Doubles(corner.y));
    store(to_integers(rounded_up(low - shadow.slack)), first);
    store(to_integers(rounded_down(high + shadow.slack)), last);
}

void find_rows(const TetShadow& shadow, int x, Rows& rows)
{
    const Doubles up_to_three = Doubles::load(kUpToThree);
    for (std::size_t from = 0; from < std::size_t(kLeafSize); from += kDoubleLanes)
        find_rows_at(shadow, x + double(from) + up_to_three, rows.first.data() + from,
                     rows.last.data() + from);
}

HWY_INLINE void find_ends(const TetLines& tet, double dx, Doubles dy, std::int32_t* first,
                          std::int32_t* last)
{
    // Bounds may be huge where a side of the tet is nearly parallel to z, and converting those to
    // integers would be undefined. They are cut off one voxel outside of the tet's box, which is
    // far enough to leave the line empty and near enough to be an integer.
    const Doubles least(tet.low_z - 1.0), most(tet.high_z + 1.0);
    Doubles low = least + 1.0, high = most - 1.0;
    for (std::size_t i = 0; i < tet.floors; ++i)
        raise_to(low, tet.floor[i].at + tet.floor[i].by_x * dx + tet.floor[i].by_y * dy);
    for (std::size_t i = 0; i < tet.ceilings; ++i)
        lower_to(high, tet.ceiling[i].at + tet.ceiling[i].by_x * dx + tet.ceiling[i].by_y * dy);
    // A side that is parallel to z bounds no interval: it takes the line as a whole or not at all.
    // Putting the upper bound below the box empties the line without a branch.
    for (std::size_t i = 0; i < tet.sides; ++i) {
        const Doubles weight =
            tet.side[i].at + tet.side[i].by_x * dx + tet.slack + tet.side[i].by_y * dy;
        high = select(weight < 0.0, least, high);
    }
    store(to_integers(rounded_up(lesser(low, most))), first);
    store(to_integers(rounded_down(greater(high, least))), last);
}

void find_line_ends(const TetLines& tet, int x, int y, LineEnds& ends)
{
    const Doubles up_to_three = Doubles::load(kUpToThree);
    const double dx = x - tet.origin_x;
    for (std::size_t from = 0; from < std::size_t(kLeafSize); from += kDoubleLanes)
        find_ends(tet, dx, y + double(from) - tet.origin_y + up_to_three, ends.first.data() + from,
                  ends.last.data() + from);
}

/// The sum is made in double and rounded to float once, after the clamp. The clamp is needed
/// because voxels may lie outside of the tet by the slack, where the linear function leaves the
/// range.
HWY_INLINE Group<float, kDoubleLanes> depth_from(const DepthRow& row, const DepthAlongZ& depth,
                                                 double from)
{
    const Doubles at = row.z + from - depth.origin + Doubles::load(kUpToThree);
    return to_floats(clamped(depth.value + (row.depth + depth.slope * at), Doubles(depth.least),
                             Doubles(depth.most)));
}

void fill_depth_rows(const DepthRow* rows, std::size_t count, const DepthAlongZ& depth)
{
    const Floats place = Floats::load(kUpToSeven);
    for (const DepthRow* row = rows; row != rows + count; ++row) {
        const Floats depths(depth_from(*row, depth, 0.0), depth_from(*row, depth, 4.0));
        const auto inside =
            (place >= static_cast<float>(row->begin)) & (place < static_cast<float>(row->end));
        // All eight are computed and those outside are put back as they were: for so few voxels
        // that is faster than a loop over those inside. The row belongs to one leaf, which one
        // thread fills, so putting back races with nobody.
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

HWY_EXPORT(find_rows);
HWY_EXPORT(find_line_ends);
HWY_EXPORT(fill_depth_rows);

void find_rows(const TetShadow& shadow, int x, Rows& rows)
{
    VDB_SHELL_KERNEL(find_rows)(shadow, x, rows);
}

void find_line_ends(const TetLines& tet, int x, int y, LineEnds& ends)
{
    VDB_SHELL_KERNEL(find_line_ends)(tet, x, y, ends);
}

void fill_depth_rows(const DepthRow* rows, std::size_t count, const DepthAlongZ& depth)
{
    VDB_SHELL_KERNEL(fill_depth_rows)(rows, count, depth);
}

} // namespace vdb_shell
#endif

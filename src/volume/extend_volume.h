// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <type_traits>
#include <vector>

namespace vdb_shell
{

/// The inactive voxels next to active ones, also over edges and corners. Not of tiles.
std::vector<openvdb::Coord> rim_of(const openvdb::Int32Grid& inside);

/// A copy whose inactive voxels next to what is `inside` have the mean of their neighbours there,
/// so that samples just inside do not mix with the emptiness outside: a volume that reaches the
/// skin would lose half a voxel of it all around. Voxels stay inactive.
template <typename Grid>
typename Grid::Ptr extended_beyond(const Grid& source, const openvdb::Int32Grid& inside)
{
    using Value = typename Grid::ValueType;
    using Sum = std::conditional_t<std::is_same_v<Value, float>, double, openvdb::Vec3d>;
    typename Grid::Ptr extended = source.deepCopy();
    auto is_inside = inside.getConstAccessor();
    auto value_of = source.getConstAccessor();
    auto made = extended->getAccessor();
    for (const openvdb::Coord& place : rim_of(inside)) {
        if (value_of.isValueOn(place))
            continue;
        Sum sum(0.0);
        int count = 0;
        for (const openvdb::Coord& beside :
             openvdb::CoordBBox(place.offsetBy(-1), place.offsetBy(1)))
            if (is_inside.isValueOn(beside)) {
                sum += Sum(value_of.getValue(beside));
                ++count;
            }
        if (count > 0 && sum != Sum(0.0))
            made.setValueOff(place, Value(sum * (1.0 / count)));
    }
    return extended;
}

} // namespace vdb_shell

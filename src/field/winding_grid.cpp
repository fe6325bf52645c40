// SPDX-License-Identifier: Apache-2.0

// Takes: triangles, and voxels to be told of. Gives: the winding number at each. A wrap asks for
// the same voxels more than once, and a number takes microseconds.

#include "field/winding_grid.h"

#include "field/winding_field.h"

namespace vdb_shell
{

using openvdb::Coord;
using openvdb::Vec3d;

std::vector<float> WindingGrid::at(const std::vector<Coord>& voxels)
{
    auto turns = turns_.getAccessor();
    std::vector<Coord> missing;
    std::vector<Vec3d> points;
    for (const Coord& voxel : voxels)
        if (!turns.isValueOn(voxel)) {
            missing.push_back(voxel);
            points.push_back(voxel.asVec3d());
        }
    const std::vector<float> computed = turns_at(number_, points);
    for (std::size_t i = 0; i < missing.size(); ++i)
        turns.setValue(missing[i], computed[i]);
    std::vector<float> values;
    values.reserve(voxels.size());
    for (const Coord& voxel : voxels)
        values.push_back(turns.getValue(voxel));
    return values;
}

std::vector<Coord> active_voxels(const openvdb::MaskTree& tree)
{
    std::vector<Coord> voxels;
    voxels.reserve(tree.activeVoxelCount());
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
        for (auto value = leaf->cbeginValueOn(); value; ++value)
            voxels.push_back(value.getCoord());
    return voxels;
}

} // namespace vdb_shell

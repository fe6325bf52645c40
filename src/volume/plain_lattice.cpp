// SPDX-License-Identifier: Apache-2.0

#include "volume/plain_lattice.h"

#include "vdb_shell/core/error.h"

namespace vdb_shell
{

using openvdb::Vec3d;

VoxelLattice plain_lattice(const openvdb::GridBase& grid, const Vec3d& shift)
{
    const openvdb::math::Transform& transform = grid.transform();
    const Vec3d origin = transform.indexToWorld(Vec3d(0.0));
    const double size = transform.voxelSize()[0];
    bool plain = transform.isLinear() && size > 0.0;
    for (int axis = 0; plain && axis < 3; ++axis) {
        Vec3d unit(0.0), along(0.0);
        unit[axis] = 1.0;
        along[axis] = size;
        // A hundred-thousandth of a voxel over a voxel: what float matrices of other programs lose.
        constexpr double kExact = 1e-5;
        // The image of each unit vector is asked, not the type of the transform: a matrix that
        // happens to scale alike is as good as a scale, and one that turns is not.
        plain = (transform.indexToWorld(unit) - origin - along).length() <= kExact * size;
    }
    if (!plain)
        throw InvalidOption(
            "grid \"" + grid.getName() + "\": its transform is a " + transform.mapType() +
            " that does more than scale all axes alike and move; resample it first");
    return {size, origin - shift};
}

} // namespace vdb_shell

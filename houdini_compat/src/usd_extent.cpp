// SPDX-License-Identifier: Apache-2.0

// Boxes of points and of volumes as USD's attribute "extent" has them, by which viewers decide what
// to draw. A box may be larger than what it holds by a float, and is never smaller.

#include "usd_extent.h"

#include "usd_text.h"

#include <openvdb/openvdb.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

/// Rounding to float32 may go inwards, and an extent that is too small makes viewers cull what they
/// should show. So each side is moved to the next float outwards where rounding went the wrong way.
std::string extent_between(const Vec3d& low, const Vec3d& high)
{
    Vec3s corners[2];
    for (int axis = 0; axis < 3; ++axis) {
        corners[0][axis] = float(low[axis]);
        if (corners[0][axis] > low[axis])
            corners[0][axis] = std::nextafter(corners[0][axis], -HUGE_VALF);
        corners[1][axis] = float(high[axis]);
        if (corners[1][axis] < high[axis])
            corners[1][axis] = std::nextafter(corners[1][axis], HUGE_VALF);
    }
    return usd_array(std::vector<Vec3s>{corners[0], corners[1]});
}

} // namespace

std::string extent_of(const std::vector<Vec3s>& points)
{
    const Bounds bounds = points.empty() ? Bounds{} : bounds_of(points);
    return extent_between(bounds.low, bounds.high);
}

std::string extent_of_volume(const ShellFile& shell)
{
    Vec3d low(HUGE_VAL), high(-HUGE_VAL);
    for (const auto& grid : {shell.surface, shell.depth}) {
        const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
        if (box.empty())
            continue;
        // Voxels are taken as boxes and not as centres, hence the halves.
        const auto world = grid->transform().indexToWorld(
            openvdb::BBoxd(box.min().asVec3d() - 0.5, box.max().asVec3d() + 0.5));
        low = openvdb::math::minComponent(low, world.min());
        high = openvdb::math::maxComponent(high, world.max());
    }
    const Vec3d shift = shell.placement.shift();
    // No active voxel at all left the box at its start values, which are inverted.
    return low[0] > high[0] ? extent_of({}) : extent_between(low + shift, high + shift);
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
// The values of voxels that are deeper inside than the narrow band, computed from the nearest
// triangle when a line reads them. A value is a function of mesh and voxel alone: what queries keep
// from each other makes them faster and changes no answer, so it does not matter which thread asks,
// nor in which order. The sign is not computed. The voxels are known to be inside, since
// signedFloodFill has given what lies beyond the narrow band its sign.

#include "field/deep_field.h"

#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"

#include <cmath>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

// How much longer than the nearest distance a probed one may be, voxels. Lines that skip ahead
// round their lengths down to whole steps, so they need no more.
constexpr float kProbeTolerance = 0.05F;
// The farthest voxel of a stencil is 1.66 voxels from the middle of the cell: one and a half along
// one axis and a half along the two others.
constexpr double kNearbyVoxels = 1.7;

} // namespace

float DeepField::value(const openvdb::Coord& at, const openvdb::Coord& base,
                       TriangleTree::Nearby& nearby) const
{
    const Vec3d world = voxel_ * at.asVec3d();
    // One list of candidates serves all voxels of a stencil. It is made around the middle of the
    // cell and not around the first voxel that was read, so that the next voxels are in its ball as
    // well. A list that is not made yet has a radius below zero, and no voxel is in its ball.
    if (!((world - nearby.centre).length() <= nearby.radius))
        tree_.gather(voxel_ * (base.asVec3d() + Vec3d(0.5)), kNearbyVoxels * voxel_, nearby);
    return -static_cast<float>(voxel_) * std::sqrt(tree_.squared_distance(world, nearby));
}

Vec3d DeepField::nearest_point(const Vec3d& world, TriangleTree::Seed& seed) const
{
    const std::uint32_t triangle = tree_.nearest(world, kProbeTolerance, seed).triangle;
    return nearest_on_triangle(triangle_corners(mesh_, triangle), world).point;
}

} // namespace vdb_shell

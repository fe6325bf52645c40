// SPDX-License-Identifier: Apache-2.0
#include "field/deep_field.h"

#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"

#include <cmath>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

// What a probed distance may be too long by, voxels.
constexpr float kProbeTolerance = 0.05F;
// A stencil reaches 1.66 voxels from the middle of its cell.
constexpr double kNearbyVoxels = 1.7;

} // namespace

float DeepField::value(const openvdb::Coord& at, const openvdb::Coord& base,
                       TriangleTree::Nearby& nearby) const
{
    const Vec3d world = voxel_ * at.asVec3d();
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

// SPDX-License-Identifier: Apache-2.0
#include "field/deep_field.h"

#include "field/nearest_on_triangle.h"

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

// What a distance may be too long by, voxels: central differences then err by a hundredth.
constexpr float kValueTolerance = 0.01F;
constexpr float kProbeTolerance = 0.05F;

} // namespace

float DeepField::value(const openvdb::Coord& at) const
{
    const Vec3d world = voxel_ * at.asVec3d();
    return -static_cast<float>((world - nearest_point(world, kValueTolerance)).length());
}

Vec3d DeepField::nearest_point(const Vec3d& world) const
{
    return nearest_point(world, kProbeTolerance);
}

Vec3d DeepField::nearest_point(const Vec3d& world, float tolerance_voxels) const
{
    const openvdb::Vec3I& t = mesh_.triangles[tree_.nearest(world, tolerance_voxels)];
    return nearest_on_triangle(
               {Vec3d(mesh_.points[t[0]]), Vec3d(mesh_.points[t[1]]), Vec3d(mesh_.points[t[2]])},
               world)
        .point;
}

} // namespace vdb_shell

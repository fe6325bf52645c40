// SPDX-License-Identifier: Apache-2.0

// Takes triangles; gives OpenVDB's grid of the distances to them. In one place, because OpenVDB's
// header of this tool takes a source ten seconds (GCC 12, OpenVDB 10.0.1).

#include "field/mesh_distances.h"

#include "core/latched_interrupter.h"
#include "vdb_shell/core/error.h"

#include <openvdb/tools/MeshToVolume.h>

#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

FloatGridPtr convert(const TriangleMesh& mesh, const openvdb::math::Transform& transform,
                     double exterior, double interior, int flags, Interrupter* interrupter)
{
    if (mesh.triangles.empty()) {
        FloatGridPtr grid =
            openvdb::FloatGrid::create(static_cast<float>(exterior * transform.voxelSize()[0]));
        grid->setTransform(transform.copy());
        return grid;
    }
    std::vector<Vec3s> points;
    points.reserve(mesh.points.size());
    for (const Vec3s& p : mesh.points)
        points.emplace_back(transform.worldToIndex(openvdb::Vec3d(p)));
    LatchedInterrupter latched(interrupter);
    openvdb::util::NullInterrupter& tool = latched;
    auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        tool, openvdb::tools::QuadAndTriangleDataAdapter<Vec3s, Vec3I>(points, mesh.triangles),
        transform, static_cast<float>(exterior), static_cast<float>(interior), flags);
    // OpenVDB returns an unfinished grid when it is stopped and does not say that it did.
    if (latched.stopped())
        throw Cancelled();
    return grid;
}

} // namespace

FloatGridPtr signed_distances(const TriangleMesh& mesh, const openvdb::math::Transform& transform,
                              double exterior_voxels, double interior_voxels,
                              Interrupter* interrupter)
{
    return convert(mesh, transform, exterior_voxels, interior_voxels, 0, interrupter);
}

FloatGridPtr unsigned_distances(const TriangleMesh& mesh, const openvdb::math::Transform& transform,
                                double band_voxels, Interrupter* interrupter)
{
    return convert(mesh, transform, band_voxels, band_voxels,
                   openvdb::tools::UNSIGNED_DISTANCE_FIELD, interrupter);
}

} // namespace vdb_shell

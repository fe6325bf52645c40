// SPDX-License-Identifier: Apache-2.0

// Takes: triangles in voxels. Gives: a grid of the distances to them, asked of a tree of triangles
// for each voxel. For soups in which many sheets lie in each voxel.

#include "field/voxel_distances.h"

#include "core/parallel.h"
#include "core/stage_stop.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_area.h"
#include "mesh/triangle_corners.h"
#include "mesh/triangle_tree.h"

#include <openvdb/openvdb.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;

/// The voxels of the box around a mesh that is given in voxels, with a band around it.
openvdb::CoordBBox voxels_around(const TriangleMesh& mesh, double band)
{
    const Bounds bounds = bounds_of(mesh.points);
    return {Coord::floor(bounds.low - Vec3d(band)), Coord::ceil(bounds.high + Vec3d(band))};
}

} // namespace

bool fills_voxels(const TriangleMesh& mesh, double band)
{
    // A closed surface has six in all voxels of a cube's layer, and a few hundredths of this.
    constexpr double kCrowd = 8;
    return !mesh.triangles.empty() && surface_area(mesh.points, mesh.triangles) >
                                          kCrowd * double(voxels_around(mesh, band).volume());
}

FloatGridPtr unsigned_distances_by_voxels(const TriangleMesh& mesh, double band)
{
    const openvdb::CoordBBox box = voxels_around(mesh, band);
    const TriangleTree tree(mesh, diagonal_of(bounds_of(mesh.points)));
    const Coord size = box.dim();
    const auto rows = std::size_t(size[0]) * std::size_t(size[1]);
    std::vector<std::vector<float>> row(rows);
    const auto start_of = [&](std::size_t i) {
        return box.min().offsetBy(int(i / std::size_t(size[1])), int(i % std::size_t(size[1])), 0);
    };
    for_each_index(
        rows,
        [&](std::size_t i) {
            stop_if_stage_wants();
            // A row begins anew, so its values do not depend on which thread had the one before.
            TriangleTree::Seed seed = TriangleTree::kNoSeed;
            for (int z = 0; z < size[2]; ++z) {
                const Vec3d at = start_of(i).offsetBy(0, 0, z).asVec3d();
                const std::uint32_t t = tree.nearest(at, 0.0F, seed).triangle;
                row[i].push_back(static_cast<float>(
                    (nearest_on_triangle(triangle_corners(mesh, t), at).point - at).length()));
            }
        },
        1);
    auto grid = openvdb::FloatGrid::create(static_cast<float>(band));
    auto values = grid->getAccessor();
    for (std::size_t i = 0; i < rows; ++i)
        for (int z = 0; z < size[2]; ++z)
            if (double(row[i][std::size_t(z)]) < band)
                values.setValue(start_of(i).offsetBy(0, 0, z), row[i][std::size_t(z)]);
    return grid;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes posed tets and a vector for each of their points. Leaves one vector grid: three grids of
// numbers, which have the same active voxels, put together leaf by leaf.

#include "vdb_shell/volume/rest_volume.h"

#include "core/grid_instances.h"
#include "core/parallel.h"
#include "vdb_shell/volume/motion_volume.h"
#include "volume/tet_values_grid.h"

#include <array>
#include <cassert>

namespace vdb_shell
{

namespace
{

using openvdb::Vec3f;

openvdb::Vec3SGrid::Ptr vector_volume(const TetMesh& posed,
                                      const std::vector<openvdb::Vec3s>& vectors, double voxel_size,
                                      const char* what, const StageProgress& progress)
{
    assert(vectors.size() == posed.points.size());
    // One number after the other, by the same code that writes depths: so the active voxels of the
    // three, and of `depth` beside them in the file, are the same.
    std::array<openvdb::FloatGrid::Ptr, 3> part;
    std::array<std::vector<const openvdb::FloatTree::LeafNodeType*>, 3> leaves;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<double> value;
        value.reserve(vectors.size());
        for (const openvdb::Vec3s& p : vectors)
            value.push_back(p[static_cast<int>(axis)]);
        part[axis] = tet_values_grid(posed, value, voxel_size, what, progress);
        part[axis]->tree().getNodes(leaves[axis]);
    }
    auto grid = openvdb::Vec3SGrid::create();
    grid->setTransform(part[0]->transform().copy());
    using Leaf = openvdb::Vec3STree::LeafNodeType;
    std::vector<std::unique_ptr<Leaf>> made(leaves[0].size());
    for_each_index(made.size(), [&](std::size_t i) {
        made[i] = std::make_unique<Leaf>(leaves[0][i]->origin(), Vec3f(0.0f), false);
        for (auto voxel = leaves[0][i]->cbeginValueOn(); voxel; ++voxel)
            made[i]->setValueOn(voxel.pos(), Vec3f(*voxel, leaves[1][i]->getValue(voxel.pos()),
                                                   leaves[2][i]->getValue(voxel.pos())));
    });
    for (std::unique_ptr<Leaf>& leaf : made)
        grid->tree().addLeaf(leaf.release());
    return grid;
}

} // namespace

GridBasePtr rest_volume(const TetMesh& posed, const std::vector<openvdb::Vec3s>& rest,
                        double voxel_size, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "shell rest");
    const auto grid = vector_volume(posed, rest, voxel_size, "rest volume", progress);
    grid->setName("rest");
    return grid;
}

GridBasePtr velocity_volume(const TetMesh& posed, const std::vector<openvdb::Vec3s>& velocity,
                            double voxel_size, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "shell velocity");
    const auto grid = vector_volume(posed, velocity, voxel_size, "velocity volume", progress);
    grid->setName(kVelocityName);
    grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    return grid;
}

} // namespace vdb_shell

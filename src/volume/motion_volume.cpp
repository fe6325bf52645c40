// SPDX-License-Identifier: Apache-2.0

// Takes a volume in a posed shell and the velocities of the shell's points. Gives the velocity at
// each of its active voxels.

#include "vdb_shell/volume/motion_volume.h"

#include "io/volume_types.h"
#include "volume/plain_lattice.h"
#include "volume/tet_index_grid.h"
#include "volume/voxel_leaves.h"

#include <cassert>
#include <utility>

namespace vdb_shell
{

using openvdb::Vec3d;
using openvdb::Vec3s;

ShellMap velocity_map(ShellStack stack, TetMesh tets,
                      const std::vector<std::vector<Vec3s>>& by_surface,
                      std::vector<Vec3s> by_tet_point)
{
    assert(by_surface.size() == stack.surfaces());
    assert(by_tet_point.size() == tets.points.size());
    // Neighbouring layers share a surface, so there is one more of these than layers, and the
    // surface between is written twice.
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        stack.layers[k].outer = by_surface[k];
        stack.layers[k].inner = by_surface[k + 1];
    }
    tets.points = std::move(by_tet_point);
    return {stack, std::move(tets)};
}

GridBasePtr motion_volume(const openvdb::GridBase& volume, const ShellMap& posed,
                          const ShellMap& velocity, const Vec3d& shift, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "motion of a volume");
    const VoxelLattice lattice = plain_lattice(volume, shift);
    const openvdb::Int32Grid::Ptr tets = tet_index_grid(posed.tets(), lattice, "motion", progress);
    VoxelLeaves<openvdb::Vec3SGrid> leaves(kVelocityName, Vec3s(0.0f), tets->tree().leafCount());
    with_volume(volume, "deformed", [&](const auto& grid) {
        for_each_leaf(*tets, progress, [&](std::size_t i, const TetIndexLeaf& leaf) {
            const auto values = grid.getConstAccessor();
            leaves.begin(i, leaf, false);
            for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
                const openvdb::Coord at = voxel.getCoord();
                // Only where the volume is: motion blur asks for the velocity of what is there, and
                // a grid over the whole shell may be much larger.
                if (!values.isValueOn(at))
                    continue;
                const Vec3d point = lattice.origin + lattice.voxel_size * at.asVec3d();
                const ShellPlace place = posed.place_in(std::uint32_t(*voxel), point);
                leaves.set_on(i, voxel.pos(), Vec3s(velocity.point_of(place)));
            }
        });
    });
    const auto made = leaves.grid(volume.transform());
    // So that programs turn and stretch the velocities when the volume itself is turned or scaled.
    made->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    return made;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes a shell's tets, gives a fog volume of depth: 0 on the outermost surface, 1 on the
// innermost, each layer an equal share. It shows a shell and proves nothing about it.

#include "vdb_shell/write/vdb_file.h"

#include "core/grid_instances.h"
#include "volume/tet_values_grid.h"

#include <algorithm>
#include <vector>

namespace vdb_shell
{
namespace
{

/// Prism layers count from 0, so the number of layers is one more than the largest; a mesh without
/// tets gets 1, which keeps the division defined.
double layers_of(const TetMesh& tets)
{
    const auto deepest = std::max_element(tets.prism_layer.begin(), tets.prism_layer.end());
    return deepest == tets.prism_layer.end() ? 1.0 : 1.0 + *deepest;
}

} // namespace

openvdb::FloatGrid::Ptr shell_depth_grid(const TetMesh& tets, double voxel_size,
                                         Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "shell depth");
    const double layers = layers_of(tets);
    std::vector<double> depth;
    depth.reserve(tets.layer.size());
    for (const std::uint8_t layer : tets.layer)
        depth.push_back(layer / layers);
    auto grid = tet_values_grid(tets, depth, voxel_size, "depth grid", progress);
    grid->setName("depth");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

} // namespace vdb_shell

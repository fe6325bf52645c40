// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/volume/shell_map.h"

#include <openvdb/math/Vec2.h>

#include <array>
#include <string>
#include <vector>

namespace vdb_shell
{

/// What a voxel in a shell can be told of its place there.
enum class Coordinate {
    rest,  ///< "rest", vec3s: where it is in the shell at rest
    depth, ///< "depth", float: 0 on the outermost surface, 1 on the innermost; each layer the same
           ///< share. In a core 1
    thickness, ///< "thickness", float, a length: of the pillars around, all layers together
    uvw,       ///< "uvw", vec3s: texture coordinates of the surface above, and depth
    prism,   ///< "prism", int32: the triangle of its prism; "prism_weights", vec3s: of its corners
    nearest, ///< "nearest", int32: the triangle of the skin nearest to it; "nearest_weights", vec3s
    layer,   ///< "layer", int32, 0 the outermost, and for each layer k "layer_k", float, 1
    density, ///< "density", float: CoordinateOptions::density_ramp of depth
};
const NameTable<Coordinate>& names(Coordinate);

struct CoordinateOptions {
    std::string volumes = "rest,depth,thickness,prism,layer";
    double voxel_size = 0; ///< 0: as the caller finds right
    std::string density_ramp = "0:1,1:0";
};
OptionList describe(CoordinateOptions& options);

/// What is in a list of names. Throws InvalidOption for one that is unknown or comes twice.
std::vector<Coordinate> coordinates_of(const CoordinateOptions& options);

/// Texture coordinates of a triangle's corners.
using CornerTexture = std::array<openvdb::Vec2d, 3>;

struct CoordinateInputs {
    const ShellMap* map = nullptr;     ///< of the shell where voxels are wanted; not null
    const ShellStack* stack = nullptr; ///< of the same shell; not null
    const ShellMap* rest = nullptr;    ///< of the shell at rest; null: `map` is
    /// By triangle; null: Coordinate::uvw is refused.
    const std::vector<CornerTexture>* texture = nullptr;
};

/// Grids over the voxels whose centres lie in a tet, in the order of Coordinate and the masks of
/// layers last. All have the same active voxels, but for the masks, which have those of their
/// layer. Coordinates are those of ShellMap, so that no borders of tets show. Background 0,
/// of numbers of triangles and layers -1. In a core there is no prism: numbers are -1, weights and
/// thickness 0. Same bits for any number of threads. Throws InvalidOption for a voxel size
/// that is not positive, texture coordinates that are missing or of another number of triangles
/// than the shell has, a ramp that is none; GeometryError
/// for voxels that are larger than the shell, or more than free memory has room for; Cancelled.
std::vector<GridBasePtr> coordinate_grids(const CoordinateInputs& inputs,
                                          const CoordinateOptions& options,
                                          Interrupter* interrupter = nullptr);

} // namespace vdb_shell

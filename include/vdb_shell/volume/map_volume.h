// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/volume/shell_map.h"

#include <openvdb/math/Vec2.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace vdb_shell
{

struct MapOptions {
    /// Tiles for one unit of u, of v, and over the range of depths.
    double repeat_u = 1, repeat_v = 1, repeat_depth = 1;
    /// Depths between which the texture lies, 0 on the outermost surface and 1 on the innermost:
    /// its top (greatest z) is at the first, its foot at the second.
    double from_depth = 0, to_depth = 1;
    /// Floats that are no level set are multiplied by the volume in the texture over that in the
    /// shell, so that their sum times volume is that of the tiles.
    bool keep_mass = false;
    /// Along each axis of a voxel, where the map shrinks: what is beyond is sampled too thinly.
    std::size_t most_samples = 16;
    double voxel_size = 0; ///< 0: as the caller finds right
};
OptionList describe(MapOptions& options);

/// What became of one grid.
struct MapFigures {
    std::string grid;
    std::size_t active = 0;          ///< voxels
    std::size_t limited_samples = 0; ///< voxels that wanted more than MapOptions::most_samples
    /// Root of the mean, over the texture, of a third of the sum of the squared singular values of
    /// the map from texture to shell (Sander et al. 2001, "Texture mapping progressive meshes", in
    /// space), over the cube root of the volumes' ratio: 1 where the map is a similarity of one
    /// scale, more otherwise. 0: nothing was mapped.
    double stretch = 0;
    std::size_t mirrored = 0; ///< voxels where the texture is turned inside out, by its chart
    std::size_t singular = 0; ///< voxels left out: texture coordinates there have no extent
};

/// A shell map (Porumbescu, Budge, Feng and Joy 2005): a texture volume, tiled over the surface's
/// texture coordinates and pushed into the shell. The tile is the box of the texture's active
/// voxels, with u along its x, v along its y, and z outwards. Each voxel whose centre lies in a tet
/// takes the tiled volume's value at its place, trilinear, or nearest for whole numbers; where the
/// map shrinks the mean over what the voxel covers there, by samples no farther apart than voxels
/// of the texture. Vectors are turned and stretched with what they are in, unless their type is
/// invariant. Distances of level sets are scaled by the map's mean scale there and then made
/// distances again; what reaches the end of the shell, or of the range of depths, is closed there.
/// Name, class, half floats and metadata stay.
///
/// `corner`: texture coordinates of the corners of the shell's triangles. Voxels have the size of
/// the options and a centre at the origin. Same bits for any number of threads. Throws
/// InvalidOption: naming the grid, for a type that is none of FloatGrid, Vec3SGrid and Int32Grid, a
/// transform that is not linear, a grid without active voxels, and texture coordinates that lie
/// beyond 2^30 voxels of it; for numbers of the options that are out of their range; for
/// coordinates of another number of triangles than the shell has. GeometryError for voxels as
/// coordinate_grids. Cancelled.
GridBasePtr map_volume(const openvdb::GridBase& texture, const ShellMap& map,
                       const std::vector<std::array<openvdb::Vec2d, 3>>& corner,
                       const MapOptions& options, MapFigures& figures,
                       Interrupter* interrupter = nullptr);

} // namespace vdb_shell

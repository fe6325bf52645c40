// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

#include <optional>

namespace vdb_shell
{

/// OpenVDB's maps refuse a determinant under 3e-15.
inline constexpr double kSmallestVoxelSize = 1.5e-5;
/// Points are float32 in index space too while distances are computed: up to here they resolve a
/// quarter of a voxel. (Index coordinates end only at 2^31.)
inline constexpr double kLargestVoxelIndex = 4194304.0;

struct LevelSetOptions {
    /// Edge length of a voxel in world units. Unset: from `resolution`.
    std::optional<double> voxel_size;
    /// Voxels along the longest side of the bounding box (the paper: 256).
    int resolution = 256;
    /// Width of the band outside the surface, at least 3: the stencil of line stepping at a vertex.
    double exterior_voxels = 3.0;
    /// Depth of the band outside, in world units, for lines that go outward; with the same 3 voxels
    /// to spare as the interior band. Unset, or less than that: exterior_voxels alone.
    std::optional<double> exterior_depth;
    /// Depth of the band inside, in world units. Unset: half the diagonal of the bounding box, as
    /// deep as any line can go (the paper, section 3). The grid gets 3 voxels more than this, what
    /// the stencil of line stepping reads around a point of that depth.
    std::optional<double> interior_depth;
    /// Refuse a grid that is estimated to need more than this. Unset: what the machine has free.
    std::optional<double> max_memory_gib;
};
OptionList describe(LevelSetOptions& options);

/// Voxel size that the options mean for this mesh, in world units.
/// From `resolution`, an object so small that its voxels would be under 1.5e-5 (the least that
/// OpenVDB's transforms hold) gets voxels of that size, but at least eight along its longest side.
/// Throws InvalidOption for sizes that are not positive and finite.
double resolve_voxel_size(const TriangleMesh& mesh, const LevelSetOptions& options);

/// Upper estimate in bytes of the level set's memory, from the area, the bounding box and the band.
double estimate_level_set_bytes(const TriangleMesh& mesh, double voxel_size,
                                const LevelSetOptions& options);

/// The signed distance to a closed mesh: negative inside, name "surface", class level set, world
/// units, background = exterior band width; the interior band reaches as deep as the options say.
/// What lies in a cavity (a component of odd nesting depth) is outside.
/// Bodies that cross are one solid. Throws InvalidOption (see above); GeometryError for a mesh
/// without points or triangles, for voxels larger than the object, smaller than OpenVDB's
/// transforms can hold or too small for the coordinates' voxel indices, or when the estimated
/// memory is over the limit; Cancelled. Same bits for any number of threads.
FloatGridPtr mesh_to_level_set(const TriangleMesh& mesh, const LevelSetOptions& options,
                               Interrupter* interrupter = nullptr);

/// Whether a voxel centre lies inside. None need in a part that is thinner than a voxel: growth
/// makes a shell there all the same, but lines have nothing to step through.
bool has_inside(const openvdb::FloatGrid& level_set);

/// phi becomes -phi everywhere, inactive values and the background included. In place; done twice
/// it restores every bit.
void negate_level_set(openvdb::FloatGrid& level_set);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/volume/shell_map.h"

#include <cstddef>
#include <string>

namespace vdb_shell
{

/// Which grids keep their mass: the sum of values times volume, so that a density grows where its
/// volume shrinks.
enum class MassRule {
    fog,  ///< fog volumes by class, and grids of the name "density"
    all,  ///< every grid of floats that is no level set
    none, ///< values stay
};
const NameTable<MassRule>& names(MassRule);

/// What becomes of vectors.
enum class VectorRule {
    by_type,   ///< by the grid's vector type: invariant ones stay, covariant ones go with normals,
               ///< contravariant relative ones with what they are in
    transform, ///< turned and stretched with what they are in, as velocities
    rotate,    ///< turned only
    keep,      ///< stay
};
const NameTable<VectorRule>& names(VectorRule);

struct DeformOptions {
    MassRule mass = MassRule::fog;
    /// Of the factor by which a density grows, and of its inverse. Prisms that are pressed flat
    /// would make any density. 100: shells are seldom pressed more.
    double most_density = 100;
    VectorRule vectors = VectorRule::by_type;
    /// Along each axis of a voxel, where the map shrinks: what is beyond is sampled too thinly.
    std::size_t most_samples = 16;
    /// Share of the volume's content that may lie outside the shell at rest, and is left out; more
    /// is refused. Content: the sum of magnitudes; of a level set, voxels within one of the
    /// surface.
    double most_outside = 0.01;
};
OptionList describe(DeformOptions& options);

/// What became of one grid. Content as in DeformOptions; mass in value times world units cubed.
struct DeformFigures {
    std::string grid;
    std::size_t active_before = 0, active_after = 0; ///< voxels; of points, points
    double mass_before = 0, mass_after = 0;          ///< of grids of floats that are no level sets
    double outside = 0;                              ///< share of the content that was left out
    std::size_t limited_density = 0; ///< voxels whose density met DeformOptions::most_density
    std::size_t limited_samples = 0; ///< voxels that wanted more than DeformOptions::most_samples
};

/// A volume of a shell at rest carried to the shell in a pose: each voxel takes what was in its
/// place at rest, trilinear, or nearest for whole numbers; where the map shrinks the mean over what
/// the voxel covers there, by samples no farther apart than voxels of the source. Voxels have the
/// lattice of the source, only those near its active voxels are looked at, and name, class, half
/// floats and metadata stay. Level sets are made distance fields again. With `posed` equal to
/// `rest` values stay bit for bit. Same bits for any number of threads.
///
/// `shift` is added to the shells' coordinates to get the volume's. Preconditions: `rest` and
/// `posed` are of the same tets. They should have been made
/// linear alike (make_linear_alike), or a volume does not come back to where it was in some prisms.
/// Throws InvalidOption for options out of range, and, naming the grid, for a type that is none of
/// FloatGrid, Vec3SGrid, Int32Grid, a transform that does more than scale alike and move, a grid
/// without active voxels, vectors that are absolute places, and more outside than is allowed;
/// Cancelled.
GridBasePtr deform_volume(const openvdb::GridBase& source, const ShellMap& rest,
                          const ShellMap& posed, const openvdb::Vec3d& shift,
                          const DeformOptions& options, DeformFigures& figures,
                          Interrupter* interrupter = nullptr);

} // namespace vdb_shell

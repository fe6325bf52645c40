// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/name_table.h"
#include "vdb_shell/shell/shell_stack.h"

namespace vdb_shell
{

/// How far the scan conversion of tets is taken. The first two give an upper bound of the distance
/// and the triangle that it belongs to.
enum class TetDistanceMethod {
    own_prism,   ///< the distance to the triangle of the prism that the voxel lies in
    near_prisms, ///< the least of those to the prisms that voxels of the same leaf (8 x 8 x 8) lie
                 ///< in
    exact,       ///< the least of all: what can be nearer is looked for, bounded by near_prisms
};
const NameTable<TetDistanceMethod>& names(TetDistanceMethod);

struct TetDistanceOptions {
    /// Edge length of a voxel in world units; has to be given.
    double voxel_size = 0;
    TetDistanceMethod method = TetDistanceMethod::exact;
};

/// Two grids with the same active voxels: those whose centres lie in a tet.
struct TetDistances {
    /// "distance", in world units, from the voxel's centre to the surface (ShellStack::skin):
    /// negative in layers below it and in tets of a core, positive in those above. Background 0.
    FloatGridPtr distance;
    /// "nearest_triangle", an Int32Grid: the triangle of the stack that the distance belongs to.
    /// Background -1.
    GridBasePtr nearest;
};

/// The signed distance to a shell's surface by scan conversion of its tets (Erleben and Dohlmann
/// 2008, "Signed distance fields using single-pass GPU scan conversion of tetrahedra"): the tet
/// over a voxel gives sign and nearest candidate. `tets`: as make_tets gives them, or with those of
/// a core (joined_tets).
///
/// Values are distances in doubles to the named triangle, rounded once. Exact: no triangle is
/// nearer, of equally near ones the first is named. Signs are right where the shell is certified: a
/// voxel in a tet below the surface is inside (to 1e-9 of the tet at its faces). Where the shell
/// leaves a void, and beyond it, no tet says anything: voxels there are not active. So the grid is
/// no level set. Same bits for any number of threads.
/// Throws InvalidOption for a voxel size that is not positive and finite or too small for 32-bit
/// voxel coordinates, Cancelled. Precondition: stack and tets fit together.
TetDistances tet_distances(const ShellStack& stack, const TetMesh& tets,
                           const TetDistanceOptions& options, Interrupter* interrupter = nullptr);

/// The same of the next pose of the same tets. A voxel's candidate is the triangle that was nearest
/// where the tet has carried it from, instead of that of its prism. Exact, it gives the bits that
/// tet_distances gives. `previous`: the tets of the last pose and its TetDistances::nearest.
/// Throws InvalidOption also when the number of points differs, or the tets do, or a triangle that
/// the grid names is none of the stack.
TetDistances next_tet_distances(const ShellStack& stack, const TetMesh& tets,
                                const TetMesh& previous_tets,
                                const openvdb::GridBase& previous_nearest,
                                const TetDistanceOptions& options,
                                Interrupter* interrupter = nullptr);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// What a solver puts conditions on. The numbers are those of files.
enum class TetBoundary : std::uint8_t {
    outer = 1, ///< the outermost surface
    inner = 2, ///< where the shell ends further in, at a core as at a void
    hole = 3,  ///< of a core's tets, the holes in it
};
/// For files.
const NameTable<TetBoundary>& names(TetBoundary);

struct BoundaryTriangle {
    openvdb::Vec3I corners; ///< points of the tets, counter-clockwise seen from outside of the tet
    std::uint32_t tet;      ///< whose face it is; between shell and core the shell's
    TetBoundary boundary;
};

/// The faces of one tet alone, and those between a tet of the shell and one of a core, in the order
/// of their tets.
std::vector<BoundaryTriangle> boundary_of(const TetMesh& tets);

} // namespace vdb_shell

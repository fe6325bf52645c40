// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/tessellate.h"

#include <cstdint>

namespace vdb_shell
{

/// Orientation of every tet, decided exactly on the float32 coordinates.
struct TetSigns {
    std::size_t tets = 0;
    Defect<std::uint32_t> inverted; ///< det < 0
    Defect<std::uint32_t> flat;     ///< det = 0
};

TetSigns count_tet_signs(const TetMesh& tets);

} // namespace vdb_shell

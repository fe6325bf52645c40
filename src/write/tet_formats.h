// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/write/tet_file.h"

#include <algorithm>
#include <cstdint>
#include <iosfwd>
#include <vector>

namespace vdb_shell
{

/// Only then does a tet's layer say something: files of one layer do without it.
inline bool has_layers(const TetMesh& tets)
{
    return std::any_of(tets.prism_layer.begin(), tets.prism_layer.end(),
                       [](std::uint8_t layer) { return layer > 0; });
}

/// `certified` by tet, or empty.
void write_vtu(std::ostream& out, const TetMesh& tets, const std::vector<std::uint8_t>& certified,
               const Placement& placement, const PointExtras& extras);
void write_tetgen_node(std::ostream& out, const TetMesh& tets, const Placement& placement);
void write_tetgen_ele(std::ostream& out, const TetMesh& tets);
void write_tetgen_face(std::ostream& out, const TetMesh& tets);
void write_medit(std::ostream& out, const TetMesh& tets, const Placement& placement);
void write_gmsh(std::ostream& out, const TetMesh& tets, const Placement& placement);

} // namespace vdb_shell

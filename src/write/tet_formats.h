// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"

#include <iosfwd>

namespace vdb_shell
{

void write_vtu(std::ostream& out, const TetMesh& tets);
void write_tetgen_node(std::ostream& out, const TetMesh& tets);
void write_tetgen_ele(std::ostream& out, const TetMesh& tets);
void write_medit(std::ostream& out, const TetMesh& tets);
void write_gmsh(std::ostream& out, const TetMesh& tets);

} // namespace vdb_shell

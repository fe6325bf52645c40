// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <vector>

namespace vdb_shell
{

/// Per triangle, whether it has no area or touches another one other than in shared points and
/// edges; exact. Triangles without area touch nothing.
std::vector<char> spoiled_triangles(const TriangleMesh& mesh);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{

/// A surface as every report of the project has it: sizes, whether it is closed and manifold, how
/// many defects there are of each kind, and the first self-intersections.
nlohmann::ordered_json mesh_check_json(const MeshCheck& check);

} // namespace vdb_shell

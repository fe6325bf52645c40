// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{

/// The components as every report of the project lists them.
nlohmann::ordered_json components_json(const std::vector<Component>& components);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/placement.h"

#include <nlohmann/json.hpp>

#include <string>

namespace vdb_shell
{

nlohmann::ordered_json placement_json(const Placement& placement);
/// "read about the origin (x, y, z), in units of u"
std::string placement_text(const Placement& placement);

} // namespace vdb_shell

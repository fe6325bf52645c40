// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/report/report.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{

/// What was measured of the tets and proven of them.
void add_checks(nlohmann::ordered_json& json, const ShellReport& report);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/obstacles/core_feet.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace vdb_shell
{

nlohmann::ordered_json cores_json(const CoreReport& cores);
void cores_line(std::ostringstream& out, const CoreReport& cores);

} // namespace vdb_shell

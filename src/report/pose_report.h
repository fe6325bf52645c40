// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pose/pose_shell.h"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace vdb_shell
{

nlohmann::ordered_json pose_json(const PoseReport& pose);
void pose_lines(std::ostringstream& out, const PoseReport& pose);

} // namespace vdb_shell

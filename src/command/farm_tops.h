// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/farm_job.h"

#include <string>

namespace vdb_shell::command
{

/// The tasks as JSON, for the task network of houdini_compat (vdb_shell_tops.create_farm).
std::string tops_list(const FarmJob& job);

} // namespace vdb_shell::command

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/farm_job.h"

#include <filesystem>
#include <string>

namespace vdb_shell::command
{

/// A job template of Open Job Description, jobtemplate-2023-09, as JSON; `file`: where it will
/// stand, for its folders are relative to it. With `task_chunking` the scheduler parts the frames
/// of the one call itself (extension TASK_CHUNKING). Throws InvalidOption for names that a template
/// cannot hold, and for more than it may have.
std::string openjd_template(const FarmJob& job, const std::filesystem::path& file,
                            bool task_chunking);

} // namespace vdb_shell::command

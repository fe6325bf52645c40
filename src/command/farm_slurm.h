// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/farm_job.h"

#include <string>

namespace vdb_shell::command
{

/// A script for bash that is at once the job that sbatch takes: it submits itself, does a task,
/// joins the manifests. `file`: what it will be called.
std::string slurm_script(const FarmJob& job, const std::string& file);

} // namespace vdb_shell::command

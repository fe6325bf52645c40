// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/name_table.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/farm_job.h"
#include "command/file_plan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell::command
{

/// What gives tasks to machines.
enum class Engine { slurm, openjd, tops };
const NameTable<Engine>& names(Engine);

struct FarmArguments {
    Engine engine = Engine::slurm;
    std::filesystem::path job;     ///< the file to write
    std::filesystem::path calls;   ///< a list of them, one a line
    std::vector<std::string> call; ///< or one, behind --
    std::filesystem::path folder;
    std::string name, program;
    int chunk = 0; ///< 0: chosen
    FarmLimits limits;
    bool no_clobber = false, submit = false;
    bool task_chunking = false; ///< of Open Job Description
};

BoundOptions add_farm_command(CLI::App& app, FarmArguments& arguments);
/// Plans the call behind -- as well, with all its frames.
FilePlan plan_farm(const FarmArguments& arguments);
int run_farm(const FarmArguments& arguments, Context& context);

} // namespace vdb_shell::command

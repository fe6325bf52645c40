// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/options/section.h"

#include "command/context.h"
#include "command/file_plan.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>
#include <vector>

// Of the commands that take volumes and leave volumes and figures: deform, map.

namespace vdb_shell::command
{

struct VolumeCall {
    std::filesystem::path volume, output, report;
    std::vector<std::string> grids; ///< empty: all
    bool quiet = false, no_clobber = false;
};

/// Where results go. `help`: what the output is.
OptionSection output_options(VolumeCall& call, const std::string& help);

/// Throws InvalidOption where the output is no .vdb, and what FilePlan throws.
FilePlan plan_volume_call(const VolumeCall& call, const std::vector<std::filesystem::path>& inputs);

/// Writes volumes and report, all or none, and prints what is wanted.
void write_results(const VolumeCall& call, const std::vector<GridBasePtr>& volumes,
                   const nlohmann::json& report, const std::string& text, Context& context);

} // namespace vdb_shell::command

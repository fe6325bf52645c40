// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/picture.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"

#include <filesystem>

namespace CLI
{
class App;
}

namespace vdb_shell::command
{

struct CompareArguments {
    std::filesystem::path first, second;
    std::filesystem::path picture; ///< .png: the two side by side
    PictureOptions drawing = {PictureKind::cut_away, {}, {}, PictureColours::prism};
    bool json = false, no_clobber = false;
};

BoundOptions add_compare_command(CLI::App& app, CompareArguments& arguments);
FilePlan plan_compare(const CompareArguments& arguments);

/// Prints figures of both shells and where they differ; success whatever they are.
int run_compare(const CompareArguments& arguments, Context& context);

} // namespace vdb_shell::command

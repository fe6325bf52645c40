// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/vdb_file.h"

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI
{
class App;
}

// Of the commands that make one file of all frames: page, usd. --frames gives them all frames at
// once (sequence.cpp).

namespace vdb_shell::command
{

struct FrameFiles {
    std::vector<std::filesystem::path> files; ///< of one shell, frame by frame
    std::filesystem::path output;
    bool no_clobber = false;
};

/// `more`: the options of the output's format.
BoundOptions add_frame_files(CLI::App& app, FrameFiles& arguments, const std::string& output_help,
                             OptionSections more = {});

/// Throws InvalidOption where the output has not this extension.
FilePlan plan_frame_files(const FrameFiles& arguments, const std::string& extension);

/// Reads one file after the other. Throws what readers throw, Cancelled.
void for_each_frame(const FrameFiles& arguments, FilePlan plan, Context& context,
                    const std::function<void(std::size_t, ShellFile)>& use);

} // namespace vdb_shell::command

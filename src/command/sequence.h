// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/call.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell::command
{

/// One run of a command: all of a call, or one frame of it.
struct Step {
    std::optional<int> frame;
    std::vector<std::string> words; ///< with the frame's number in place of tokens
    std::vector<std::filesystem::path> inputs, outputs;
    std::vector<std::filesystem::path> missing; ///< inputs that are not there
    std::vector<int> gathered{};                ///< the frames of a step that has all of them
    std::string command{};                      ///< what the words call; the same for all frames
};

/// All runs of a call, held against each other and against what is known before any work. Throws
/// InvalidOption and what plans of files throw, with the frame's number.
std::vector<Step> plan_steps(const std::vector<std::string>& words, const GlobalArguments& global,
                             const Context& context);

/// Prints the steps and their files.
void print_steps(const std::vector<Step>& steps, std::ostream& out);

} // namespace vdb_shell::command

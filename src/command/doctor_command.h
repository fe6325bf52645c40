// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "command/bound_options.h"
#include "command/context.h"
#include "command/file_plan.h"

#include <filesystem>

namespace vdb_shell::command
{

struct DoctorArguments {
    std::filesystem::path file; ///< empty: the machine alone
};

BoundOptions add_doctor_command(CLI::App& app, DoctorArguments& arguments);

/// Prints what is installed, and what the file needs; read_error where no command can read it.
int run_doctor(const DoctorArguments& arguments, Context& context);

} // namespace vdb_shell::command

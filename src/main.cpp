// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"

#include "command/build_command.h"
#include "command/exit_code.h"
#include "command/file_commands.h"
#include "command/inspect_command.h"
#include "command/repair_command.h"
#include "command/signals.h"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <functional>
#include <iostream>
#include <memory>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::command;

int run(int argc, char** argv)
{
    CLI::App app{"Thick shells of prisms and tets from triangle surfaces, as OpenVDB volumes.",
                 "vdb_shell"};
    app.set_version_flag("--version", "vdb_shell " VDB_SHELL_VERSION);
    app.require_subcommand(1);
    app.fallthrough();
    int threads = 0;
    app.add_option("--threads", threads, "Threads to use; 0 is all. Results do not depend on it")
        ->capture_default_str()
        ->check(CLI::NonNegativeNumber);

    BuildArguments build;
    InspectArguments inspect;
    RepairArguments repair;
    FileArguments info, convert, check;
    CLI::App& build_app = *app.add_subcommand("build", "Build a shell from a triangle surface");
    CLI::App& inspect_app =
        *app.add_subcommand("inspect", "Say what stands in the way of a shell, and what mends it");
    CLI::App& repair_app =
        *app.add_subcommand("repair", "Close and mend a surface, keeping what is sound");
    CLI::App& info_app = *app.add_subcommand("info", "Print what a shell's file holds");
    CLI::App& convert_app =
        *app.add_subcommand("convert", "Write other formats from a shell's file");
    CLI::App& check_app =
        *app.add_subcommand("check", "Verify that a shell's file is what it claims");
    add_build_command(build_app, build);
    add_inspect_command(inspect_app, inspect);
    add_repair_command(repair_app, repair);
    add_info_command(info_app, info);
    add_convert_command(convert_app, convert);
    add_check_command(check_app, check);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? success : usage_error;
    }

    std::unique_ptr<tbb::global_control> limit;
    if (threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      static_cast<std::size_t>(threads));
    catch_signals();
    if (build_app.parsed())
        return run_build(build);
    if (inspect_app.parsed())
        return run_inspect(inspect);
    if (repair_app.parsed())
        return run_repair(repair);
    if (info_app.parsed())
        return run_info(info);
    if (convert_app.parsed())
        return run_convert(convert);
    return run_check(check);
}

int status_of(const std::exception& error)
{
    if (dynamic_cast<const Cancelled*>(&error))
        return caught_signal() ? signal_base + caught_signal() : internal_error;
    if (dynamic_cast<const InvalidOption*>(&error))
        return usage_error;
    if (dynamic_cast<const ReadError*>(&error))
        return read_error;
    if (dynamic_cast<const GeometryError*>(&error))
        return geometry_error;
    if (dynamic_cast<const WriteError*>(&error))
        return write_error;
    return internal_error;
}

} // namespace

int main(int argc, char** argv)
{
    try {
        return run(argc, argv);
    } catch (const std::exception& error) {
        std::cerr << "vdb_shell: " << error.what() << '\n';
        return status_of(error);
    }
}

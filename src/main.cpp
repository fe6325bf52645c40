// SPDX-License-Identifier: Apache-2.0

// The program: commands to option structs, exceptions to exit statuses, and nothing else. Parsing
// changes no field; apply() does, for the global options and for the one command that was given.
// The number of threads is limited by TBB for the whole process, which changes the time and no byte
// of any result. Messages go to standard error, so that figures on standard output can be piped.

#include "vdb_shell/core/error.h"
#include "vdb_shell/fill/fill_core.h"

#include "command/build_command.h"
#include "command/exit_code.h"
#include "command/file_commands.h"
#include "command/inspect_command.h"
#include "command/options_command.h"
#include "command/pose_command.h"
#include "command/repair_command.h"
#include "command/signals.h"

#include <CLI/CLI.hpp>
#include <tbb/global_control.h>

#include <cerrno>
#include <cstring>
#include <functional>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::command;

struct Arguments {
    int threads = 0;
    BuildArguments build;
    InspectArguments inspect;
    RepairArguments repair;
    PoseArguments pose;
    FileArguments info, convert, check;
    OptionsArguments options;
};

/// A subcommand with its options, and what it does.
struct Subcommand {
    CLI::App* app = nullptr;
    BoundOptions bound;
    std::function<int()> run;
};

BoundOptions add_threads(CLI::App& app, int& threads)
{
    Option option = vdb_shell::option("", threads, "--threads",
                                      "Threads to use; 0 is all. Results do not depend on it")
                        .in(Unit::count)
                        .within(at_least(0));
    return bind(app, {{"", in_group("Options", {option})}});
}

std::vector<CommandEntry> entries_of(const BoundOptions& global,
                                     const std::vector<Subcommand>& commands)
{
    std::vector<CommandEntry> entries{{"", "", &global}};
    for (const Subcommand& command : commands)
        entries.push_back(
            {command.app->get_name(), command.app->get_description(), &command.bound});
    return entries;
}

/// The actions refer to `a` and to `commands`, both of which outlive them in run(). Pointers into
/// `commands` are made only when `options` runs, when the vector no longer grows.
void add_commands(CLI::App& app, Arguments& a, const BoundOptions& global,
                  std::vector<Subcommand>& commands)
{
    const auto add = [&](const char* name, const char* help, auto add_options, auto& arguments,
                         std::function<int()> run) {
        CLI::App* subcommand = app.add_subcommand(name, help);
        commands.push_back({subcommand, add_options(*subcommand, arguments), std::move(run)});
    };
    add("build", "Build a shell from a triangle surface", add_build_command, a.build,
        [&a] { return run_build(a.build); });
    add("inspect", "Say what stands in the way of a shell, and what mends it", add_inspect_command,
        a.inspect, [&a] { return run_inspect(a.inspect); });
    add("repair", "Close and mend a surface, keeping what is sound", add_repair_command, a.repair,
        [&a] { return run_repair(a.repair); });
    add("pose", "Put a shell onto its surface in another pose", add_pose_command, a.pose,
        [&a] { return run_pose(a.pose); });
    add("info", "Print what a shell's file holds", add_info_command, a.info,
        [&a] { return run_info(a.info); });
    add("convert", "Write other formats from a shell's file", add_convert_command, a.convert,
        [&a] { return run_convert(a.convert); });
    add("check", "Verify that a shell's file is what it claims", add_check_command, a.check,
        [&a] { return run_check(a.check); });
    add("options", "List the options, for people, programs and shells", add_options_command,
        a.options, [&] { return run_options(a.options, entries_of(global, commands)); });
}

int run(int argc, char** argv)
{
    CLI::App app{"Thick shells of prisms and tets from triangle surfaces, as OpenVDB volumes.",
                 "vdb_shell"};
    app.set_version_flag("--version", "vdb_shell " VDB_SHELL_VERSION);
    app.require_subcommand(1);
    // Global options may stand behind the command as well, where people tend to add them.
    app.fallthrough();
    Arguments arguments;
    BoundOptions global = add_threads(app, arguments.threads);
    std::vector<Subcommand> commands;
    add_commands(app, arguments, global, commands);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        // Help and version are thrown as well, with status 0; CLI11's other numbers are its own and
        // are replaced by ours.
        return app.exit(error) == 0 ? success : usage_error;
    }

    apply(global);
    // The limit holds as long as this object lives, that is until run() returns.
    std::unique_ptr<tbb::global_control> limit;
    if (arguments.threads > 0)
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      std::size_t(arguments.threads));
    // Not earlier: while words are parsed there is nothing to stop or to tidy up, and the default
    // action is right.
    catch_signals();
    for (Subcommand& command : commands)
        if (command.app->parsed()) {
            apply(command.bound);
            return command.run();
        }
    return internal_error; // the parser wants a command
}

/// Each kind of error has its own status (docs/command_line.md), so that a script can tell a wrong
/// option from a surface that has no shell. The kinds do not derive from one another, so the order
/// of the tests does not matter.
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
    if (dynamic_cast<const ProgramError*>(&error))
        return program_failed;
    if (dynamic_cast<const std::bad_alloc*>(&error))
        return out_of_memory;
    return internal_error;
}

/// What was printed has to have arrived: a full disk or a closed stream shows here at the latest. A
/// status that tells something already stays as it is.
int finished(int status)
{
    errno = 0;
    std::cout.flush();
    if (!std::cout) {
        std::cerr << "vdb_shell: standard output cannot be written"
                  << (errno != 0 ? std::string(": ") + std::strerror(errno) : "") << '\n';
        return status == success ? write_error : status;
    }
    // It came while files were put in their places, and had to wait.
    return caught_signal() ? signal_base + caught_signal() : status;
}

} // namespace

int main(int argc, char** argv)
{
    end_uncaught_exceptions();
    occupy_standard_streams();
    try {
        return finished(run(argc, argv));
        // Everything that is thrown ends here, so that temporary files are removed while the stack
        // unwinds; an exception that leaves main may end the process without doing so.
    } catch (const std::exception& error) {
        const int status = status_of(error);
        std::cerr << "vdb_shell: " << (status == out_of_memory ? "out of memory" : error.what())
                  << '\n';
        return status;
    }
}

// SPDX-License-Identifier: Apache-2.0
#include "command/repair_command.h"

#include "vdb_shell/core/error.h"

#include "command/exit_code.h"
#include "command/placement_options.h"
#include "command/signals.h"
#include "vdb_shell/core/atomic_file.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace vdb_shell::command
{

void add_repair_options(CLI::App& app, RepairOptions& options, const std::string& group)
{
    app.add_option("--weld-tolerance", options.weld_tolerance,
                   "Repair: merge points nearer than this, world units; 0 is equal ones only")
        ->capture_default_str()
        ->group(group);
    app.add_option("--sliver-height", options.sliver_height,
                   "Repair: remove triangles lower than this, world units; 0 is those of no area")
        ->capture_default_str()
        ->group(group);
    app.add_flag("--cut-crossings", options.cut_crossings,
                 "Repair: cut out triangles that cross others, and close the holes")
        ->group(group);
}

void add_repair_command(CLI::App& app, RepairArguments& arguments)
{
    app.add_option("mesh", arguments.mesh, "Triangle surface: .obj .ply .off .stl")->required();
    app.add_option("-o,--output", arguments.output, "Repaired surface: .obj .ply .off .stl")
        ->required();
    app.add_flag("--json", arguments.json, "Print one JSON object");
    app.add_flag("--keep-crossing-fills", arguments.repair.keep_crossing_fills,
                 "Close holes also where every fill tried crosses the surface");
    add_placement_options(app, arguments.read, "Options");
    add_repair_options(app, arguments.repair, "Options");
}

int run_repair(const RepairArguments& arguments)
{
    std::error_code ignored;
    if (std::filesystem::equivalent(arguments.output, arguments.mesh, ignored))
        throw InvalidOption(arguments.output.string() + ": is the input; it is not overwritten");
    require_writable(arguments.output);
    SignalInterrupter interrupter(false);
    const ReadResult read = read_mesh(arguments.mesh, arguments.read);
    warn_of_lost_digits(arguments.mesh, read);
    const Placement& placement = read.report.placement;
    const RepairResult result =
        repair_mesh(read.mesh, in_unit(arguments.repair, placement.unit), &interrupter);
    write_mesh(arguments.output, result.mesh, placement);
    const std::string name = arguments.mesh.filename().string();
    std::cout << (arguments.json ? repair_json(result.report) + '\n'
                                 : name + ":\n" + repair_text(result.report));
    try {
        require_usable(result.report.after, {}, name);
    } catch (const GeometryError& left) {
        std::cerr << "vdb_shell: after the repair, " << left.what() << '\n';
        return check_failed;
    }
    return success;
}

} // namespace vdb_shell::command

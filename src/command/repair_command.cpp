// SPDX-License-Identifier: Apache-2.0

// The command `repair`: reads a surface, mends it, writes it in the coordinates of the input, and
// prints every change. The mended surface is written even if something is left that no repair can
// mend: the status says so (check_failed), and what was mended may be of use to another program.
// The input is never overwritten, because a repair may remove things that somebody wanted.

#include "command/repair_command.h"

#include "io/mesh_formats.h"
#include "vdb_shell/core/error.h"

#include "command/exit_code.h"
#include "command/signals.h"

#include <CLI/CLI.hpp>

namespace vdb_shell::command
{

namespace
{

OptionSections describe(RepairArguments& a)
{
    Option output = option("", a.output, "--output", "Repaired surface: .obj .ply .off .stl")
                        .with_names({"-o"});
    output.required = true;
    OptionSections sections{
        {"",
         {preset_option(a.preset), output, no_clobber_option(a.no_clobber),
          input_format_option(a.format), option("", a.json, "--json", "Print one JSON object"),
          option("", a.quiet, "--quiet", "Print no figures").with_names({"-q"})}},
        {"read", describe(a.read)},
        {"repair", describe(a.repair)}};
    for (OptionSection& section : sections)
        for (Option& o : section.options) {
            o.group = "Options";
            // The key stays, for a file of options may serve `build` as well.
            if (o.key == "weld")
                o.flag.clear(); // a repair welds in any case
        }
    return sections;
}

} // namespace

BoundOptions add_repair_command(CLI::App& app, RepairArguments& arguments)
{
    app.add_option("mesh", arguments.mesh, std::string("Triangle surface: ") + kSurfaceExtensions)
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_repair(const RepairArguments& arguments)
{
    require_format(arguments.mesh, arguments.format);
    if (!mesh_format_of(arguments.output))
        throw InvalidOption(arguments.output.string() + ": " + no_mesh_format(arguments.output));
    FilePlan plan(existing_files(arguments.no_clobber));
    plan.add_input(arguments.mesh);
    plan.add_input(arguments.preset);
    plan.add_output(arguments.output);
    return plan;
}

int run_repair(const RepairArguments& arguments, Context& context)
{
    SignalInterrupter interrupter(context);
    const ReadResult read = read_surface(arguments.mesh, arguments.read, arguments.format);
    warn_of_lost_digits(arguments.mesh, read, context);
    const Placement& placement = read.report.placement;
    // Before the work, as soon as it is known that the object is moved.
    require_place_for(arguments.output, placement);
    const RepairResult result =
        repair_mesh(read.mesh, in_unit(arguments.repair, placement.unit), &interrupter);
    // The placement is undone here, so the output lies where the input lay, also with --recentre
    // and --rescale.
    OutputSet files(existing_files(arguments.no_clobber));
    write_mesh(arguments.output, result.mesh, placement, &files);
    files.commit();
    const std::string name = arguments.mesh.filename().string();
    if (arguments.json)
        context.out << repair_json(result.report) << '\n';
    else if (!arguments.quiet)
        context.out << name << ":\n" << repair_text(result.report);
    try {
        // The test that `build` makes of its input, so success here means that a shell can be
        // tried.
        require_usable(result.report.after, {}, name);
    } catch (const GeometryError& left) {
        context.say(LogLevel::error, std::string("after the repair, ") + left.what());
        return check_failed;
    }
    return success;
}

} // namespace vdb_shell::command

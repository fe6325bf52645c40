// SPDX-License-Identifier: Apache-2.0

// The command `inspect`: reads a surface as `build` would, says what stands in the way of a shell,
// and can paint it. The status is a result: 0 when a shell can be built, check_failed when
// something has to be mended first, so that scripts need not read the text.

#include "command/inspect_command.h"

#include "vdb_shell/core/error.h"

#include "command/exit_code.h"

#include <CLI/CLI.hpp>

namespace vdb_shell::command
{

namespace
{

OptionSections describe(InspectArguments& a)
{
    OptionSections sections{
        {"",
         {preset_option(a.preset), option("", a.json, "--json", "Print one JSON object"),
          option("", a.picture, "--output", "Write the mesh coloured by its defects: .ply")
              .with_names({"-o"}),
          no_clobber_option(a.no_clobber), input_format_option(a.format)}},
        {"read", describe(a.read)},
        {"level_set", describe(a.inspect)}};
    // The help of so few options reads better as one group than as the groups of `build`.
    for (OptionSection& section : sections)
        for (Option& o : section.options)
            o.group = "Options";
    return sections;
}

} // namespace

BoundOptions add_inspect_command(CLI::App& app, InspectArguments& arguments)
{
    app.add_option("mesh", arguments.mesh, std::string("Triangle surface: ") + kSurfaceExtensions)
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_inspect(const InspectArguments& arguments)
{
    require_format(arguments.mesh, arguments.format);
    FilePlan plan(existing_files(arguments.no_clobber));
    plan.add_input(arguments.mesh);
    plan.add_input(arguments.preset);
    if (!arguments.picture.empty()) {
        // First what it would destroy, and then that no writer takes it.
        plan.add_output(arguments.picture);
        require_extension(arguments.picture, ".ply");
    }
    return plan;
}

int run_inspect(const InspectArguments& arguments, Context& context)
{
    const ReadResult read = read_surface(arguments.mesh, arguments.read, arguments.format);
    InspectOptions options = in_unit(arguments.inspect, read.report.placement.unit);
    // What rounding to float32 moved is known to the reader alone, and decides whether --recentre
    // is advised.
    options.largest_rounding = read.report.largest_rounding;
    const MeshInspection inspection = inspect_mesh(read.mesh, options);
    if (!arguments.picture.empty()) {
        OutputSet files(existing_files(arguments.no_clobber));
        write_defect_picture(arguments.picture, read.mesh, options, &files);
        files.commit();
    }
    const std::string name = arguments.mesh.filename().string();
    if (arguments.json)
        context.out << inspection_json(name, read.report, inspection) << '\n';
    else
        context.out << inspection_text(name, read.report, inspection);
    // The picture and the text are made in any case; a surface that is not usable is what they are
    // made for.
    return usable(inspection) ? success : check_failed;
}

} // namespace vdb_shell::command

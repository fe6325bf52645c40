// SPDX-License-Identifier: Apache-2.0

// The command `inspect`: reads a surface as `build` would, says what stands in the way of a shell,
// and can paint it. The status is a result: 0 when a shell can be built, check_failed when
// something has to be mended first, so that scripts need not read the text.

#include "command/inspect_command.h"

#include "vdb_shell/core/error.h"

#include "command/exit_code.h"
#include "command/signals.h"
#include "command/surface_input.h"
#include "vdb_shell/core/atomic_file.h"

#include <CLI/CLI.hpp>

#include <iostream>

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
              .with_names({"-o"})}},
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

int run_inspect(const InspectArguments& arguments)
{
    if (!arguments.picture.empty()) {
        // The picture need not exist yet, in which case the comparison fails and says no; that is
        // the answer wanted here.
        std::error_code ignored;
        if (std::filesystem::equivalent(arguments.picture, arguments.mesh, ignored))
            throw InvalidOption(arguments.picture.string() +
                                ": is the input; it is not overwritten");
        require_writable(arguments.picture);
    }
    const ReadResult read = read_surface(arguments.mesh, arguments.read);
    InspectOptions options = in_unit(arguments.inspect, read.report.placement.unit);
    // What rounding to float32 moved is known to the reader alone, and decides whether --recentre
    // is advised.
    options.largest_rounding = read.report.largest_rounding;
    SignalInterrupter interrupter(false);
    const MeshInspection inspection = inspect_mesh(read.mesh, options, &interrupter);
    if (!arguments.picture.empty())
        write_defect_picture(arguments.picture, read.mesh, options);
    const std::string name = arguments.mesh.filename().string();
    if (arguments.json)
        std::cout << inspection_json(name, read.report, inspection) << '\n';
    else
        std::cout << inspection_text(name, read.report, inspection);
    return usable(inspection) ? success : check_failed;
}

} // namespace vdb_shell::command

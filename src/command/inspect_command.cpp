// SPDX-License-Identifier: Apache-2.0
#include "command/inspect_command.h"

#include "vdb_shell/core/error.h"

#include "command/exit_code.h"
#include "command/placement_options.h"
#include "vdb_shell/core/atomic_file.h"

#include <CLI/CLI.hpp>

#include <iostream>

namespace vdb_shell::command
{

void add_inspect_command(CLI::App& app, InspectArguments& arguments)
{
    app.add_option("mesh", arguments.mesh, "Triangle surface: .obj .ply .off .stl")->required();
    app.add_flag("--json", arguments.json, "Print one JSON object");
    app.add_option("-o,--output", arguments.picture,
                   "Write the mesh coloured by its defects: .ply");
    app.add_flag("--weld,!--no-weld", arguments.read.weld,
                 "Merge vertices of equal position (the default) or keep them apart");
    add_placement_options(app, arguments.read, "Options");
    LevelSetOptions& level_set = arguments.inspect.level_set;
    CLI::Option* voxel = app.add_option("--voxel-size", level_set.voxel_size,
                                        "Voxel that features are measured against, world units");
    app.add_option("--resolution", level_set.resolution,
                   "Voxels along the longest side of the bounding box")
        ->capture_default_str()
        ->excludes(voxel);
}

int run_inspect(const InspectArguments& arguments)
{
    if (!arguments.picture.empty()) {
        std::error_code ignored;
        if (std::filesystem::equivalent(arguments.picture, arguments.mesh, ignored))
            throw InvalidOption(arguments.picture.string() +
                                ": is the input; it is not overwritten");
        require_writable(arguments.picture);
    }
    const ReadResult read = read_mesh(arguments.mesh, arguments.read);
    InspectOptions options = arguments.inspect;
    options.level_set = in_unit(options.level_set, read.report.placement.unit);
    options.largest_rounding = read.report.largest_rounding;
    const MeshInspection inspection = inspect_mesh(read.mesh, options);
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

// SPDX-License-Identifier: Apache-2.0

// The command `volumes`: a shell's file in, grids of its coordinates out.

#include "command/volumes_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/io/volume_file.h"

#include "command/exit_code.h"
#include "command/mapped_shell.h"
#include "command/signals.h"

#include <CLI/CLI.hpp>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <memory>

namespace vdb_shell::command
{
namespace
{

OptionSections describe(VolumesArguments& a)
{
    Option output = option("", a.output, "--output", "The volumes: .vdb").with_names({"-o"});
    output.required = true;
    const Option half = option("", a.half, "--half", "Save floats and vectors as half floats");
    const Option texture =
        option("", a.texture, "--texture-from",
               "The shell's surface at rest with texture coordinates, for uvw: .obj, .ply, "
               ".geo, .bgeo, .bgeo.sc");
    return {{"", in_group("Volumes", {texture})},
            {"", in_group("Output", {output, half, no_clobber_option(a.no_clobber)})},
            {"volumes", vdb_shell::describe(a.coordinates)}};
}

} // namespace

BoundOptions add_volumes_command(CLI::App& app, VolumesArguments& arguments)
{
    app.add_option("shell", arguments.shell,
                   "The shell, at rest or posed: a .vdb, .geo, .bgeo or .bgeo.sc that vdb_shell "
                   "wrote")
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_volumes(const VolumesArguments& arguments)
{
    require_extension(arguments.output, ".vdb");
    const std::vector<Coordinate> wanted = coordinates_of(arguments.coordinates);
    const bool uvw = std::find(wanted.begin(), wanted.end(), Coordinate::uvw) != wanted.end();
    // Both ways round: a surface that is not asked for would be read and thrown away, and its
    // author thinks that it counts.
    if (uvw == arguments.texture.empty())
        throw InvalidOption(uvw ? "--volumes uvw: there are no texture coordinates; --texture-from "
                                  "names the surface that has them"
                                : "--texture-from is of use with --volumes uvw only");
    const bool density =
        std::find(wanted.begin(), wanted.end(), Coordinate::density) != wanted.end();
    if (!density && arguments.coordinates.density_ramp != CoordinateOptions().density_ramp)
        throw InvalidOption("--density-ramp is of use with --volumes density only");
    FilePlan plan(existing_files(arguments.no_clobber));
    plan.add_input(arguments.shell);
    plan.add_input(arguments.texture);
    plan.add_output(arguments.output);
    return plan;
}

int run_volumes(const VolumesArguments& arguments, Context& context)
{
    FilePlan plan = plan_volumes(arguments);
    SignalInterrupter interrupter(context);
    const MappedShell shell = map_shell(arguments.shell, plan);
    CoordinateOptions options = arguments.coordinates;
    options.voxel_size = voxel_size_of(shell, options.voxel_size);
    const std::unique_ptr<ShellMap> rest = map_at_rest(shell);
    CoordinateInputs inputs;
    inputs.map = shell.map.get();
    inputs.stack = &shell.file.stack;
    // Null for a shell that is at rest itself.
    inputs.rest = rest.get();
    // Outlives the grids, whose inputs point into it.
    SurfaceCoordinates texture;
    if (!arguments.texture.empty()) {
        texture = texture_of(arguments.texture, shell);
        inputs.texture = &texture.corner;
    }
    const std::vector<GridBasePtr> grids = coordinate_grids(inputs, options, &interrupter);
    // Values stay in the mesh's own frame, as those of "rest" in a posed shell's .vdb do.
    const openvdb::Vec3d shift = shell.file.placement.shift();
    for (const GridBasePtr& grid : grids) {
        if (shift != openvdb::Vec3d(0.0))
            grid->transform().postTranslate(shift);
        grid->setSaveFloatAsHalf(arguments.half);
    }
    OutputSet files(existing_files(arguments.no_clobber));
    write_volumes(arguments.output, grids, &files);
    files.commit();
    if (shell.map->linear_prisms() > 0)
        context.say(LogLevel::info,
                    std::to_string(shell.map->linear_prisms()) + " of " +
                        std::to_string(shell.map->prisms()) +
                        " prisms are linear in their tets: their own map would turn back");
    return success;
}

} // namespace vdb_shell::command

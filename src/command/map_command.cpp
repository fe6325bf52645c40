// SPDX-License-Identifier: Apache-2.0

// The command `map`: a texture volume, a shell and the textured surface that it was built of in;
// the texture in the shell out. Several grids are done one after the other, each on all threads.

#include "command/map_command.h"

#include "vdb_shell/io/volume_file.h"

#include "command/exit_code.h"
#include "command/mapped_shell.h"
#include "command/signals.h"
#include "options/shown_text.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <cstdio>
#include <string>

namespace vdb_shell::command
{
namespace
{

OptionSections describe(MapArguments& a)
{
    Option shell = option("", a.shell, "--shell", "The shell, at rest or posed");
    shell.required = true;
    Option mesh = option("", a.mesh, "--mesh",
                         "The surface that the shell was built of, with texture coordinates: .obj "
                         ".ply .geo .bgeo .bgeo.sc");
    mesh.required = true;
    return {{"", in_group("Map", {shell, mesh,
                                  option("", a.call.grids, "--grid",
                                         "A grid to map; all where none is named")})},
            {"map", vdb_shell::describe(a.map)},
            output_options(a.call, "The texture in the shell: .vdb")};
}

std::string figures_of_map(const MapFigures& f)
{
    char stretch[64];
    std::snprintf(stretch, sizeof stretch, "; stretch %.3f (1 is none)", f.stretch);
    // Names of grids are of any length, so they do not go through the buffer.
    std::string text = shown(f.grid) + ": " + std::to_string(f.active) + " voxels" + stretch;
    const auto add = [&](std::size_t count, const char* what) {
        if (count > 0)
            text += "; " + std::to_string(count) + " voxels " + what;
    };
    add(f.limited_samples, "with too few samples");
    add(f.mirrored, "where the texture is mirrored");
    add(f.singular, "left out, where texture coordinates have no extent");
    return text + '\n';
}

nlohmann::json json_of(const MapFigures& f)
{
    return {{"grid", f.grid},         {"active", f.active},
            {"stretch", f.stretch},   {"limited_samples", f.limited_samples},
            {"mirrored", f.mirrored}, {"singular", f.singular}};
}

} // namespace

BoundOptions add_map_command(CLI::App& app, MapArguments& arguments)
{
    app.add_option("volume", arguments.call.volume,
                   "The texture: a .vdb with grids of floats, vectors or whole numbers")
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_map(const MapArguments& arguments)
{
    return plan_volume_call(arguments.call, {arguments.shell, arguments.mesh});
}

int run_map(const MapArguments& arguments, Context& context)
{
    FilePlan plan = plan_map(arguments);
    SignalInterrupter interrupter(context);
    const MappedShell shell = map_shell(arguments.shell, plan);
    const SurfaceCoordinates texture = texture_of(arguments.mesh, shell);
    const double unit = shell.file.placement.unit;
    MapOptions options = arguments.map;
    options.voxel_size = voxel_size_of(shell, options.voxel_size);
    std::vector<GridBasePtr> made;
    nlohmann::json report = nlohmann::json::array();
    std::string text;
    for (const GridBasePtr& grid : read_volumes(arguments.call.volume, arguments.call.grids)) {
        MapFigures figures;
        made.push_back(with_file_of_grids(arguments.call.volume, [&] {
            return map_volume(*grid, *shell.map, texture.corner, options, figures, &interrupter);
        }));
        // The map works in the frame of the mesh; a .vdb has transforms that lead to where the
        // file's surface lies.
        made.back()->transform().postTranslate(shell.file.placement.shift());
        report.push_back(json_of(figures));
        text += figures_of_map(figures);
    }
    // Told and not refused: a repaired or remeshed surface has other triangles, and whether the
    // nearest coordinates will do is for the user to judge.
    const std::size_t others = texture.corner.size() - texture.same;
    if (others > 0)
        context.say(LogLevel::info,
                    std::to_string(others) + " of " + std::to_string(texture.corner.size()) +
                        " triangles are none of " + arguments.mesh.string() +
                        " and take the texture coordinates nearest to them, at most " +
                        std::to_string(texture.farthest * unit) + " away");
    write_results(arguments.call, made,
                  {{"grids", report},
                   {"triangles", texture.corner.size()},
                   {"triangles_of_the_mesh", texture.same},
                   {"farthest_triangle", texture.farthest * unit}},
                  text, context);
    return success;
}

} // namespace vdb_shell::command

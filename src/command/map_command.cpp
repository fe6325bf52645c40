// SPDX-License-Identifier: Apache-2.0

// The command `map`: a texture volume, a shell and the textured surface that it was built of in;
// the texture in the shell out. Several grids are done one after the other, each on all threads.

#include "command/map_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/houdini/polygon_mesh.h"
#include "vdb_shell/io/volume_file.h"
#include "vdb_shell/volume/surface_coordinates.h"

#include "command/exit_code.h"
#include "command/mapped_shell.h"
#include "command/signals.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <cstdio>
#include <ostream>

namespace vdb_shell::command
{
namespace
{

OptionSections describe(MapArguments& a)
{
    Option output =
        option("", a.output, "--output", "The texture in the shell: .vdb").with_names({"-o"});
    output.required = true;
    Option shell = option("", a.shell, "--shell", "The shell, at rest or posed");
    shell.required = true;
    Option mesh = option("", a.mesh, "--mesh",
                         "The surface that the shell was built of, with texture coordinates: .obj "
                         ".ply .geo .bgeo .bgeo.sc");
    mesh.required = true;
    return {{"", in_group("Map", {shell, mesh,
                                  option("", a.grids, "--grid",
                                         "A grid to map; all where none is named")})},
            {"map", vdb_shell::describe(a.map)},
            {"", in_group("Output",
                          {output,
                           option("", a.report, "--report",
                                  "Write all figures as JSON; - is standard output, in "
                                  "place of the text"),
                           option("", a.quiet, "--quiet", "Print no figures").with_names({"-q"}),
                           no_clobber_option(a.no_clobber)})}};
}

/// Of the shell's triangles, which are those of the mesh at rest.
SurfaceCoordinates coordinates_of(const std::filesystem::path& mesh, const MappedShell& shell)
{
    const Placement& placement = shell.file.placement;
    const TextureCoordinates textured = houdini::has_geometry_extension(mesh)
                                            ? houdini::read_polygon_texture(mesh, placement)
                                            : read_texture_coordinates(mesh, placement);
    const ShellStack rest = rest_stack(shell.file);
    return surface_coordinates(textured, {rest.surface(rest.skin), rest.triangles()});
}

std::string text_of(const MapFigures& f)
{
    char line[256];
    std::snprintf(line, sizeof line, "%s: %zu voxels; stretch %.3f (1 is none)", f.grid.c_str(),
                  f.active, f.stretch);
    std::string text = line;
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
    app.add_option("volume", arguments.volume,
                   "The texture: a .vdb with grids of floats, vectors or whole numbers")
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_map(const MapArguments& arguments)
{
    if (lower_case_extension(arguments.output) != ".vdb")
        throw InvalidOption(arguments.output.string() + ": the extension is not .vdb");
    FilePlan plan(existing_files(arguments.no_clobber));
    plan.add_input(arguments.volume);
    plan.add_input(arguments.shell);
    plan.add_input(arguments.mesh);
    plan.add_output(arguments.output);
    if (!arguments.report.empty() && !is_standard_output(arguments.report))
        plan.add_output(arguments.report);
    return plan;
}

int run_map(const MapArguments& arguments, Context& context)
{
    FilePlan plan = plan_map(arguments);
    SignalInterrupter interrupter(context);
    const MappedShell shell = map_shell(arguments.shell, plan);
    const SurfaceCoordinates texture = coordinates_of(arguments.mesh, shell);
    const double unit = shell.file.placement.unit;
    MapOptions options = arguments.map;
    options.voxel_size /= unit;
    if (options.voxel_size == 0) {
        if (!shell.file.surface)
            throw InvalidOption(arguments.shell.string() +
                                ": it has no level set, whose voxels these would have; give "
                                "--voxel-size");
        options.voxel_size = shell.file.surface->voxelSize()[0];
    }
    std::vector<GridBasePtr> made;
    nlohmann::json report = nlohmann::json::array();
    std::string text;
    for (const GridBasePtr& grid : read_volumes(arguments.volume, arguments.grids)) {
        MapFigures figures;
        made.push_back(
            map_volume(*grid, *shell.map, texture.corner, options, figures, &interrupter));
        made.back()->transform().postTranslate(shell.file.placement.shift());
        report.push_back(json_of(figures));
        text += text_of(figures);
    }
    const std::size_t others = texture.corner.size() - texture.same;
    if (others > 0)
        context.say(LogLevel::info,
                    std::to_string(others) + " of " + std::to_string(texture.corner.size()) +
                        " triangles are none of " + arguments.mesh.string() +
                        " and take the texture coordinates nearest to them, at most " +
                        std::to_string(texture.farthest * unit) + " away");
    OutputSet files(existing_files(arguments.no_clobber));
    write_volumes(arguments.output, made, &files);
    const std::string json = nlohmann::json{{"grids", report},
                                            {"triangles", texture.corner.size()},
                                            {"triangles_of_the_mesh", texture.same},
                                            {"farthest_triangle", texture.farthest * unit}}
                                 .dump(2) +
                             '\n';
    const bool to_output = is_standard_output(arguments.report);
    if (!arguments.report.empty() && !to_output)
        files.write_stream(arguments.report, [&](std::ostream& out) { out << json; });
    files.commit();
    if (to_output || !arguments.quiet)
        context.out << (to_output ? json : text);
    return success;
}

} // namespace vdb_shell::command

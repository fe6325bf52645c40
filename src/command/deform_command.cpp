// SPDX-License-Identifier: Apache-2.0

// The command `deform`: volumes inside a shell at rest, and the shell in a pose, in; the volumes in
// the pose out. Several grids are done one after the other, each on all threads.

#include "command/deform_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/io/volume_file.h"
#include "vdb_shell/volume/deform_points.h"
#include "vdb_shell/volume/motion_volume.h"

#include "command/exit_code.h"
#include "command/mapped_shell.h"
#include "command/signals.h"
#include "options/shown_text.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <utility>

namespace vdb_shell::command
{
namespace
{

OptionSections describe(DeformArguments& a)
{
    Option posed = option("", a.posed, "--posed", "The shell in the pose, as pose writes it");
    posed.required = true;
    return {
        {"",
         in_group(
             "Deform",
             {posed,
              option(
                  "", a.rest, "--rest",
                  "The shell where the volumes are; without it the points at rest that the posed "
                  "shell has"),
              option("", a.call.grids, "--grid", "A grid to deform; all where none is named"),
              option("", a.velocity, "--velocity",
                     "Also how fast the shell moves, as the posed shell's file has it: a grid "
                     "\"v\" over the voxels of the first volume, and attribute \"v\" of points")})},
        {"deform", vdb_shell::describe(a.deform)},
        output_options(a.call, "The volumes and points in the pose: .vdb")};
}

/// One line a grid. What is unusual is told only where it happened.
std::string figures_of_deform(const DeformFigures& f, bool points)
{
    // Names of grids are of any length, so only numbers go through the buffer.
    std::string text = shown(f.grid) + ": " + std::to_string(f.active_after) +
                       (points ? " points, " : " voxels, ") + std::to_string(f.active_before) +
                       " before";
    char line[256];
    // Vectors, whole numbers and level sets have no mass, and a change by per cent of nothing says
    // nothing.
    if (f.mass_before != 0) {
        std::snprintf(line, sizeof line, "; mass %.6g, %.6g before (%+.3f %%)", f.mass_after,
                      f.mass_before, 100 * (f.mass_after / f.mass_before - 1));
        text += line;
    }
    if (f.outside > 0) {
        std::snprintf(line, sizeof line, "; %.3f %% outside the shell left out", 100 * f.outside);
        text += line;
    }
    if (f.limited_density + f.limited_samples > 0)
        text += "; " + std::to_string(f.limited_density) + " voxels at the bound of densities, " +
                std::to_string(f.limited_samples) + " with too few samples";
    return text + '\n';
}

nlohmann::json json_of(const DeformFigures& f)
{
    return {{"grid", f.grid},
            {"active_before", f.active_before},
            {"active_after", f.active_after},
            {"mass_before", f.mass_before},
            {"mass_after", f.mass_after},
            {"outside", f.outside},
            {"limited_density", f.limited_density},
            {"limited_samples", f.limited_samples}};
}

/// The shell that the volume lies in as it is. Never null.
std::unique_ptr<ShellMap> map_before(const DeformArguments& arguments, const MappedShell& posed,
                                     FilePlan& plan)
{
    std::unique_ptr<ShellMap> from;
    if (!arguments.rest.empty()) {
        MappedShell rest = map_shell(arguments.rest, plan);
        require_same_tets(rest, posed);
        from = std::move(rest.map);
    } else {
        from = map_at_rest(posed);
    }
    if (!from)
        throw InvalidOption(arguments.posed.string() +
                            ": it is at rest; give --posed a shell that pose wrote, or --rest");
    return from;
}

} // namespace

BoundOptions add_deform_command(CLI::App& app, DeformArguments& arguments)
{
    app.add_option("volume", arguments.call.volume,
                   "Volumes in the shell at rest: a .vdb with grids of floats, vectors or whole "
                   "numbers, and of points")
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_deform(const DeformArguments& arguments)
{
    return plan_volume_call(arguments.call, {arguments.posed, arguments.rest});
}

/// Before the first volume, whose work would be lost.
void require_no_velocity(const std::filesystem::path& file, const std::vector<GridBasePtr>& grids)
{
    for (const GridBasePtr& grid : grids)
        if (grid->getName() == kVelocityName)
            throw InvalidOption(file.string() + ": has a grid \"" + kVelocityName +
                                "\", which --velocity makes; name the others with --grid");
}

int run_deform(const DeformArguments& arguments, Context& context)
{
    // Made anew: where a shell keeps its points is known only when it is opened.
    FilePlan plan = plan_deform(arguments);
    SignalInterrupter interrupter(context);
    MappedShell posed = map_shell(arguments.posed, plan);
    const std::unique_ptr<ShellMap> from = map_before(arguments, posed, plan);
    // Before any voxel is carried, so that what goes there and back comes back.
    make_linear_alike(*from, *posed.map);
    std::unique_ptr<ShellMap> velocity;
    // Before the first volume, whose work would be lost.
    if (arguments.velocity && !(velocity = map_of_velocities(posed)))
        throw InvalidOption(arguments.posed.string() +
                            ": it does not know how fast it moves, which --velocity asks for; "
                            "pose it with --mesh-before or --mesh-after");
    const openvdb::Vec3d shift = posed.file.placement.shift();
    std::vector<GridBasePtr> made;
    nlohmann::json report = nlohmann::json::array();
    std::string text;
    const auto deform = [&](const openvdb::GridBase& grid, DeformFigures& figures) {
        return is_point_grid(grid) ? deform_points(grid, *from, *posed.map, shift, arguments.deform,
                                                   figures, velocity.get(), &interrupter)
                                   : deform_volume(grid, *from, *posed.map, shift, arguments.deform,
                                                   figures, &interrupter);
    };
    const std::vector<GridBasePtr> grids =
        read_volumes(arguments.call.volume, arguments.call.grids, GridKinds::volumes_and_points);
    if (velocity)
        require_no_velocity(arguments.call.volume, grids);
    for (const GridBasePtr& grid : grids) {
        DeformFigures figures;
        made.push_back(
            with_file_of_grids(arguments.call.volume, [&] { return deform(*grid, figures); }));
        report.push_back(json_of(figures));
        text += figures_of_deform(figures, is_point_grid(*grid));
    }
    if (velocity) {
        // Points have theirs as an attribute already.
        const auto volume = std::find_if(made.begin(), made.end(), [](const GridBasePtr& grid) {
            return !is_point_grid(*grid);
        });
        if (volume != made.end())
            made.push_back(motion_volume(**volume, *posed.map, *velocity, shift, &interrupter));
    }
    write_results(arguments.call, made, {{"grids", report}}, text, context);
    return success;
}

} // namespace vdb_shell::command

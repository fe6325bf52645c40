// SPDX-License-Identifier: Apache-2.0
#include "command/build_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/polygon_mesh.h"

#include "command/bind.h"
#include "command/exit_code.h"
#include "command/placement_options.h"
#include "command/repair_command.h"
#include "command/signals.h"
#include "report/stage_clock.h"
#include "vdb_shell/core/atomic_file.h"

#include <iostream>
#include <utility>
#include <vector>

namespace vdb_shell::command
{
namespace
{

void add_surface_options(CLI::App& app, BuildArguments& arguments)
{
    app.add_flag("--weld,!--no-weld", arguments.read.weld,
                 "Merge vertices of equal position (the default) or keep them apart")
        ->group("Surface");
    add_placement_options(app, arguments.read, "Surface");
    app.add_flag("--repair", arguments.repair,
                 "Weld, orient, part and close the surface first; what is sound stays bit for bit")
        ->group("Surface");
    add_repair_options(app, arguments.repair_options, "Surface");
    for (const char* option : {"--weld-tolerance", "--sliver-height", "--cut-crossings"})
        app.get_option(option)->needs("--repair");
    app.add_flag("--turn-outward", arguments.shell.check.turn_inside_out,
                 "Turn closed components that are inside out instead of refusing them")
        ->group("Surface");
    app.add_flag("--allow-self-intersections", arguments.shell.check.allow_self_intersections,
                 "Accept a surface that crosses itself, copy vertices of several fans, and certify "
                 "prism by prism")
        ->group("Surface");
}

void add_wrap_options(CLI::App& app, ShellOptions& shell)
{
    app.add_flag("--wrap", shell.wrap.wanted,
                 "Build the shell of a new closed surface around the triangles, whatever they are")
        ->group("Wrap");
    CLI::Option* voxel = app.add_option("--wrap-voxel-size", shell.wrap.voxel_size,
                                        "Edge length of a voxel of the wrap, world units")
                             ->group("Wrap");
    app.add_option("--wrap-resolution", shell.wrap.resolution,
                   "Voxels of the wrap along the longest side of the bounding box")
        ->capture_default_str()
        ->excludes(voxel)
        ->group("Wrap");
    app.add_option("--wrap-adaptivity", shell.wrap.adaptivity,
                   "How far simplification may move the wrap, voxels")
        ->capture_default_str()
        ->group("Wrap");
    app.add_option("--wrap-sheet", shell.wrap.sheet_voxels,
                   "Half the thickness given to sheets and loose triangles, voxels")
        ->capture_default_str()
        ->group("Wrap");
    app.add_flag("--wrap-keep-voids", shell.wrap.keep_voids,
                 "Keep enclosed voids and what stands in them")
        ->group("Wrap");
    app.add_option("--contour-adaptivity", shell.contour.adaptivity,
                   "How far simplification may move the surface of a level set, voxels")
        ->capture_default_str()
        ->group("Wrap");
}

void add_resampling_options(CLI::App& app, ShellOptions& shell)
{
    CLI::Option* decimate = app.add_option("--decimate-to", shell.decimate.triangles,
                                           "Collapse edges down to this many triangles first")
                                ->group("Resampling");
    app.add_option("--decimate-tolerance", shell.decimate.tolerance,
                   "Farthest that decimation may part the surfaces, world units")
        ->needs(decimate)
        ->group("Resampling");
    app.add_option("--subdivide", shell.subdivide.levels,
                   "Cut every triangle into four, this many times over")
        ->capture_default_str()
        ->group("Resampling");
    CLI::Option* rounds =
        app.add_option("--refine-rounds", shell.refine.rounds,
                       "Rounds of cutting triangles where the shell is held back, and growing on")
            ->capture_default_str()
            ->group("Resampling");
    const auto refine = [&](const char* flag, auto& field, const char* help) {
        return app.add_option(flag, field, help)->needs(rounds)->group("Resampling");
    };
    bind_enum(app, "--refine-by", shell.refine.by, "What makes a triangle worth cutting")
        ->needs(rounds)
        ->group("Resampling");
    refine("--refine-share", shell.refine.share,
           "Share of that in the triangles cut in one round, those most worth it first")
        ->capture_default_str();
    refine("--max-tets", shell.refine.max_tets, "Refine to no more tets than this");
    refine("--target-fill", shell.refine.target_fill, "End refinement at this fill, 0 to 1");
    refine("--refine-min-gain", shell.refine.min_gain,
           "End refinement when a round gains less fill than this")
        ->capture_default_str();
}

void add_field_options(CLI::App& app, ShellOptions& shell)
{
    CLI::Option* voxel = app.add_option("--voxel-size", shell.level_set.voxel_size,
                                        "Edge length of a voxel, world units")
                             ->group("Level set");
    app.add_option("--resolution", shell.level_set.resolution,
                   "Voxels along the longest side of the bounding box")
        ->capture_default_str()
        ->excludes(voxel)
        ->group("Level set");
    app.add_option("--exterior-voxels", shell.level_set.exterior_voxels,
                   "Width of the band outside the surface")
        ->capture_default_str()
        ->group("Level set");
    app.add_option("--exterior-depth", shell.level_set.exterior_depth,
                   "Depth of the band outside, world units [outward: the thickness]")
        ->group("Level set");
    app.add_option("--interior-depth", shell.level_set.interior_depth,
                   "Depth of the band inside, world units [the thickness, else half the diagonal]")
        ->group("Level set");
    bind_enum(app, "--field", shell.field,
              "Deep voxels only where lines end, or all of them; auto takes what is less work")
        ->group("Level set");
    app.add_option("--max-memory", shell.level_set.max_memory_gib,
                   "Refuse a level set that would need more GiB than this [what is free]")
        ->group("Level set");
    app.add_option("--smooth", shell.smooth.iterations, "Steps of mean-curvature flow")
        ->capture_default_str()
        ->group("Level set");
}

void add_line_options(CLI::App& app, BuildArguments& arguments)
{
    ShellOptions& shell = arguments.shell;
    bind_enum(app, "--side", shell.side, "Side of the surface that the shell lies on")
        ->group("Lines");
    bind_enum(app, "--directions", shell.directions.source, "Where the lines' directions come from")
        ->group("Lines");
    app.add_option("--perturb", shell.directions.perturbation_radians,
                   "Largest random tilt of a direction, radians")
        ->capture_default_str()
        ->group("Lines");
    app.add_option("--perturb-seed", shell.directions.seed, "Seed of the random tilt")
        ->capture_default_str()
        ->group("Lines");
    bind_enum(app, "--stop-test", shell.line_step.test, "When a line stops")->group("Lines");
    app.add_option("--rho", shell.line_step.rho, "Threshold of the normal tests, a cosine")
        ->capture_default_str()
        ->group("Lines");
    app.add_option("--step", shell.line_step.step_voxels, "Increment along a line, voxels")
        ->capture_default_str()
        ->group("Lines");
    app.add_option("--distance-threshold", shell.line_step.distance_threshold_voxels,
                   "Threshold of the distance test and of bisection, voxels")
        ->capture_default_str()
        ->group("Lines");
    app.add_option("--bisection-iterations", shell.line_step.bisection_iterations,
                   "Iteration limit of bisection")
        ->capture_default_str()
        ->group("Lines");
    app.add_option("--reference", shell.line_step.reference_voxels,
                   "Where relative-normal and own-sheet begin to compare, voxels from the start")
        ->capture_default_str()
        ->group("Lines");
    app.add_option("--sheet-angle", shell.line_step.sheet_angle_radians,
                   "own-sheet: surfaces that meet at less than this are one, radians")
        ->capture_default_str()
        ->group("Lines");
    app.add_option("--thickness", shell.line_step.thickness,
                   "Largest length of any line, world units [outward: a tenth of the diagonal]")
        ->group("Lines");
    app.add_option("--thickness-grid", arguments.thickness_grid,
                   "Float grid of largest lengths: FILE.vdb or FILE.vdb:GRID")
        ->group("Lines");
    bind_enum(app, "--limit", shell.limits.limit, "Thin-shell limit on the lengths")
        ->group("Lines");
}

void add_growth_options(CLI::App& app, GrowOptions& grow)
{
    CLI::Option* method =
        bind_enum(app, "--method", grow.method, "How the inner vertices get their places")
            ->group("Growth");
    app.add_flag_callback(
           "--thickest", [&grow] { grow.method = Method::thickest; }, "Same as --method thickest")
        ->excludes(method)
        ->group("Growth");
    const auto lever = [&](const char* flag, bool& field, const char* help) {
        app.add_flag(flag, field, help)->group("Growth");
    };
    lever("--mend-directions,!--no-mend-directions", grow.mend_directions,
          "Replace directions that see a triangle from behind [on]");
    lever("--smooth-directions,!--no-smooth-directions", grow.smooth_directions,
          "Smooth the directions across faces, not across creases [on]");
    lever("--top-down,!--no-top-down", grow.top_down,
          "Start from long lines and shrink them, instead of a thin shell [on]");
    lever("--grow-lines,!--no-grow-lines", grow.grow_lines,
          "Lengthen along the lines where the start is nearly full [on]");
    lever("--free-moves,!--no-free-moves", grow.free_moves,
          "Let inner vertices leave their lines [on]");
    lever("--soft-contacts,!--no-soft-contacts", grow.soft_contacts,
          "Keep clear of near triangles before they touch [on]");
    lever("--flips,!--no-flips", grow.flips, "Turn diagonals for room and for quality [on]");
    app.add_option("--coarse-from", grow.coarse_from,
                   "Triangles from which on growth begins on a coarser surface; 0: never")
        ->capture_default_str()
        ->group("Growth");
    app.add_option(
           "--free-rounds", grow.free_rounds,
           "Upper bound on rounds of free moves [40; after a coarser surface as many as pay]")
        ->check(CLI::NonNegativeNumber)
        ->group("Growth");
    app.add_option("--min-quality", grow.min_quality,
                   "Mean ratio that tets should reach, at a cost in thickness; 0 asks for none")
        ->capture_default_str()
        ->group("Growth");
}

void add_layer_options(CLI::App& app, ShellOptions& shell)
{
    app.add_option("--thickness-scale", shell.scale.factor,
                   "Share of each pillar's length to keep after growth")
        ->capture_default_str()
        ->group("Layers");
    app.add_option("--layers", shell.layers.layers, "Layers that each pillar is cut into")
        ->capture_default_str()
        ->group("Layers");
    app.add_option("--layer-grading", shell.layers.grading,
                   "Thickness of each layer over that of the one nearer to the surface")
        ->capture_default_str()
        ->group("Layers");
}

void add_shell_options(CLI::App& app, ShellOptions& shell)
{
    bind_enum(app, "--split", shell.split.rule, "How the prisms' diagonals are chosen")
        ->group("Tets");
    app.add_option("--ripple-seed", shell.split.seed, "Seed of the ripple method")
        ->capture_default_str()
        ->group("Tets");
    app.add_option("--samples", shell.coverage.samples,
                   "Monte Carlo points inside the solid; 0 leaves the estimate out")
        ->capture_default_str()
        ->group("Tets");
    app.add_option("--samples-seed", shell.coverage.seed, "Seed of the Monte Carlo points")
        ->capture_default_str()
        ->group("Tets");
}

ReadResult read_surface(const BuildArguments& arguments)
{
    return houdini::has_geometry_extension(arguments.mesh)
               ? houdini::read_polygon_mesh(arguments.mesh, arguments.read)
               : read_mesh(arguments.mesh, arguments.read);
}

/// FILE.vdb or FILE.vdb:GRID.
struct GridName {
    std::string file, grid;
};

GridName split_grid_name(const std::string& name)
{
    const std::size_t colon = name.rfind(".vdb:");
    if (colon == std::string::npos)
        return {name, ""};
    constexpr std::size_t kExtension = 4; // ".vdb"
    return {name.substr(0, colon + kExtension), name.substr(colon + kExtension + 1)};
}

openvdb::FloatGrid::Ptr read_thickness_grid(const std::string& name)
{
    if (name.empty())
        return nullptr;
    const GridName parts = split_grid_name(name);
    return read_float_grid(parts.file, parts.grid);
}

/// Reads the triangles or the level set, and builds; `options` are left in the unit worked in.
ShellResult read_and_build(const BuildArguments& arguments, ShellOptions& options,
                           Interrupter* interrupter)
{
    std::vector<StageCost> read_cost;
    const GridName source = split_grid_name(arguments.mesh.string());
    const std::string name = arguments.mesh.filename().string();
    const openvdb::FloatGrid::Ptr thickness = read_thickness_grid(arguments.thickness_grid);
    ShellResult result;
    if (std::filesystem::path(source.file).extension() == ".vdb") {
        if (arguments.read.recentre || arguments.read.rescale)
            throw InvalidOption(name + ": --recentre and --rescale are for triangles; a level set "
                                       "has a transform of its own");
        openvdb::FloatGrid::Ptr field;
        StageClock(read_cost).run("read",
                                  [&] { field = read_level_set(source.file, source.grid); });
        result = build_shell_from_level_set(*field, options, name, thickness.get(), interrupter);
    } else {
        ReadResult read;
        StageClock(read_cost).run("read", [&] { read = read_surface(arguments); });
        warn_of_lost_digits(arguments.mesh, read);
        const Placement& placement = read.report.placement;
        options = in_unit(options, placement.unit);
        result = build_shell(read.mesh, options, name, in_place(thickness, placement).get(),
                             interrupter);
        result.report.read = read.report;
    }
    std::vector<StageCost>& stages = result.report.stages;
    stages.insert(stages.begin(), read_cost.begin(), read_cost.end());
    return result;
}

/// Takes stack and tets out of the result.
ShellFile to_file(ShellResult& result, const ShellOptions& options, const Outputs& outputs,
                  Interrupter* interrupter)
{
    ShellFile file;
    file.stack = std::move(result.stack);
    file.tets = std::move(result.tets);
    if (result.report.read)
        file.placement = result.report.read->placement;
    file.parameters_json = options_json(options);
    file.report_json = report_json(result.report, false);
    if (wants_vdb(outputs)) {
        file.surface = result.level_set;
        file.depth = shell_depth_grid(file.tets, result.report.field.voxel_size, interrupter);
    }
    return file;
}

std::vector<std::uint8_t> certified_flags(const ShellResult& result)
{
    const std::optional<Overlaps>& overlaps = result.report.overlaps;
    return overlaps ? overlaps->certified
                    : std::vector<std::uint8_t>(result.tets.tets.size(), std::uint8_t(1));
}

void require_sensible(const BuildArguments& arguments)
{
    if (arguments.outputs.paths.empty() && arguments.report.empty() && arguments.quiet)
        throw InvalidOption("no output, no report and --quiet: nothing would come of the work");
    require_possible(arguments.outputs, {split_grid_name(arguments.mesh.string()).file});
    if (!arguments.report.empty())
        require_writable(arguments.report);
}

} // namespace

void add_build_command(CLI::App& app, BuildArguments& arguments)
{
    app.add_option("mesh", arguments.mesh,
                   "Surface: .obj .ply .off .stl .geo .bgeo .bgeo.sc; or level set: FILE.vdb or "
                   "FILE.vdb:GRID")
        ->required();
    add_output_options(app, arguments.outputs);
    app.add_option("--report", arguments.report, "Write all figures as JSON")->group("Output");
    app.add_flag("-q,--quiet", arguments.quiet, "Print no figures")->group("Output");
    app.add_flag("--progress", arguments.progress, "Name each stage on standard error as it begins")
        ->group("Output");
    add_surface_options(app, arguments);
    add_wrap_options(app, arguments.shell);
    add_resampling_options(app, arguments.shell);
    add_field_options(app, arguments.shell);
    add_line_options(app, arguments);
    add_growth_options(app, arguments.shell.grow);
    add_layer_options(app, arguments.shell);
    add_shell_options(app, arguments.shell);
}

int run_build(const BuildArguments& arguments)
{
    require_sensible(arguments);
    SignalInterrupter interrupter(arguments.progress);
    std::vector<StageCost> write_cost;
    ShellOptions options = arguments.shell;
    if (arguments.repair)
        options.repair = arguments.repair_options;
    ShellResult result = read_and_build(arguments, options, &interrupter);
    StageClock(write_cost).run("write", [&] {
        const std::vector<std::uint8_t> certified = certified_flags(result);
        write_outputs(arguments.outputs, to_file(result, options, arguments.outputs, &interrupter),
                      certified);
    });

    std::vector<StageCost>& stages = result.report.stages;
    stages.insert(stages.end(), write_cost.begin(), write_cost.end());
    if (!arguments.report.empty())
        write_stream_atomically(arguments.report, [&](std::ostream& out) {
            out << report_json(result.report) << '\n';
        });
    if (!arguments.quiet)
        std::cout << report_text(result.report);
    return success;
}

} // namespace vdb_shell::command

// SPDX-License-Identifier: Apache-2.0

// The command `build`: a surface or a level set in, files and figures out. What can be refused
// without work is refused before anything is read: options that contradict each other, unknown
// formats, folders that cannot be written. The lengths on the command line are in the unit of the
// file, while the stages work in that of the mesh (--rescale), so options are converted once, after
// reading.

#include "command/build_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/options/section.h"

#include "command/core_input.h"
#include "command/exit_code.h"
#include "command/file_plan.h"
#include "command/signals.h"

#include "core/freed_memory.h"
#include "report/stage_clock.h"
#include "vdb_shell/write/remesh_map.h"

#include <CLI/CLI.hpp>

#include <ostream>
#include <utility>
#include <vector>

namespace vdb_shell::command
{
namespace
{

/// Null without a name. Lengths and places are those of the file (in_place).
FloatGridPtr read_thickness_grid(const std::string& name)
{
    if (name.empty())
        return nullptr;
    const GridName parts = split_grid_name(name);
    return read_float_grid(parts.file, parts.grid);
}

/// Voxels that --resolution makes differ with the box of each frame, and a volume whose voxels
/// change flickers.
void keep_voxel_size(ShellOptions& options, const Context& context)
{
    if (context.sequence && context.sequence->voxel_size && !options.level_set.voxel_size)
        options.level_set.voxel_size = context.sequence->voxel_size;
}

/// By the extension alone: what is in the file is not known before it is read, and options are
/// refused by this earlier.
bool is_level_set(const BuildArguments& arguments)
{
    const GridName source = split_grid_name(arguments.mesh.string());
    return lower_case_extension(source.file) == ".vdb";
}

/// Reads the triangles or the level set, and builds. `options` are left in the unit in which the
/// stages worked, because the file has to state what its shell was made with.
ShellResult read_and_build(const BuildArguments& arguments, ShellOptions& options, Context& context,
                           Interrupter* interrupter)
{
    std::vector<StageCost> read_cost;
    const GridName source = split_grid_name(arguments.mesh.string());
    const std::string name = arguments.mesh.filename().string();
    // The small inputs come first: a wrong name of a grid is told before a large mesh is read.
    const FloatGridPtr thickness = read_thickness_grid(arguments.thickness_grid);
    ShellResult result;
    if (is_level_set(arguments)) {
        // Not left aside: whoever asks for it has a surface far away, and would go on without what
        // was meant to help.
        if (arguments.read.recentre || arguments.read.rescale)
            throw InvalidOption(name + ": --recentre and --rescale are for triangles; a level set "
                                       "has a transform of its own");
        FloatGridPtr field;
        StageClock(read_cost, interrupter).run("read", [&] {
            field = read_level_set(source.file, source.grid);
        });
        result = build_shell_from_level_set(*field, options, name, thickness.get(), interrupter,
                                            read_cores(arguments.cores, arguments.read, {}));
    } else {
        ReadResult read;
        interrupter->start("read");
        StageClock(read_cost, interrupter).run("read", [&] {
            read = read_surface(arguments.mesh, arguments.read, arguments.format);
        });
        warn_of_lost_digits(arguments.mesh, read, context);
        const Placement& placement = read.report.placement;
        for (const std::filesystem::path& output : arguments.outputs.paths)
            require_place_for(output, placement);
        // Before in_unit: what frames have in common is kept in world units, while a frame that is
        // rescaled may have a unit of its own.
        keep_voxel_size(options, context);
        options = in_unit(options, placement.unit);
        result = build_shell(read.mesh, options, name, in_place(thickness, placement).get(),
                             interrupter, read_cores(arguments.cores, arguments.read, placement));
        result.report.read = read.report;
        // The first frame that gets here decides, and it runs alone (run_steps.cpp).
        if (context.sequence && !context.sequence->voxel_size)
            context.sequence->voxel_size = result.report.field.voxel_size * placement.unit;
    }
    // Reading came before the pipeline and its clock; it is put in front so that the report has all
    // stages in their order.
    std::vector<StageCost>& stages = result.report.stages;
    stages.insert(stages.begin(), read_cost.begin(), read_cost.end());
    return result;
}

/// Takes stack and tets out of the result, which are the largest things in memory; whatever needs
/// them has to run before. The report in the file is without times, which would make its bytes
/// differ from run to run.
ShellFile to_file(ShellResult& result, const ShellOptions& options, const Outputs& outputs,
                  Interrupter* interrupter)
{
    ShellFile file;
    file.stack = std::move(result.stack);
    file.tets = std::move(result.tets);
    file.core_feet = std::move(result.core_feet);
    if (result.core)
        file.core = std::move(*result.core);
    // Only what remeshing has made can say where the points before it lie.
    if (result.remesh_map)
        file.input = input_points_of(*result.remesh_map);
    if (result.report.read)
        file.placement = result.report.read->placement;
    file.parameters_json = options_json(options);
    // The report as it is now, before anything was written: it cannot tell of the file that it
    // stands in.
    file.report_json = report_json(result.report, false);
    if (wants_vdb(outputs)) {
        file.surface = result.level_set;
        // Voxels take memory and time, and no other format has a place for them.
        file.depth = shell_depth_grid(file.tets, result.report.field.voxel_size, interrupter);
        // The lists of tets by column are as large as all else together.
        give_back_freed_memory();
    }
    return file;
}

/// Every file of the call, whichever option names it.
FilePlan plan_files(const BuildArguments& arguments)
{
    FilePlan plan(existing_files(arguments.outputs.no_clobber));
    plan.add_input(split_grid_name(arguments.mesh.string()).file);
    plan.add_input(split_grid_name(arguments.thickness_grid).file);
    plan.add_input(arguments.preset);
    for (const std::string& core : arguments.cores)
        plan.add_input(split_grid_name(core).file);
    add_outputs(plan, arguments.outputs);
    if (!arguments.report.empty() && !is_standard_output(arguments.report))
        plan.add_output(arguments.report);
    if (!arguments.remesh_map.empty())
        plan.add_output(arguments.remesh_map);
    return plan;
}

/// What Option::needs cannot say: one value of an option, and the surface itself.
void require_partners(const BuildArguments& arguments)
{
    const ShellOptions& shell = arguments.shell;
    if (shell.taper.core == CoreSurface::stitched && !shell.taper.wanted)
        throw InvalidOption("--core stitched needs --taper");
    if (shell.contour.adaptivity != ContourOptions{}.adaptivity && !is_level_set(arguments))
        throw InvalidOption("--contour-adaptivity needs a level set, FILE.vdb or FILE.vdb:GRID; "
                            "the surface is " +
                            arguments.mesh.filename().string());
    if (arguments.cores.empty() && shell.cores.distance > 0)
        throw InvalidOption("--core-distance needs --core FILE");
}

/// All that can be refused without reading a file, and before any work.
void require_sensible(const BuildArguments& arguments)
{
    if (arguments.outputs.paths.empty() && arguments.report.empty() && arguments.quiet)
        throw InvalidOption("no output, no report and --quiet: nothing would come of the work");
    require_format(arguments.mesh, arguments.format);
    // By the purpose's name, where it has set what is wrong.
    require_fit(arguments.purpose, arguments.shell);
    require_sensible(arguments.shell, !arguments.thickness_grid.empty());
    require_program(arguments.shell.core_fill);
    if (!arguments.remesh_map.empty())
        require_map_extension(arguments.remesh_map);
    require_partners(arguments);
    if (!arguments.cores.empty())
        require_cores_possible(arguments.shell);
}

/// The report is made last, because it is the only output that can tell how long the others took.
void write_report(const BuildArguments& arguments, const ShellReport& report, OutputSet& files)
{
    if (!arguments.report.empty() && !is_standard_output(arguments.report))
        files.write_stream(arguments.report,
                           [&](std::ostream& out) { out << report_json(report) << '\n'; });
}

void print_figures(const BuildArguments& arguments, const ShellReport& report, std::ostream& out)
{
    if (is_standard_output(arguments.report))
        out << report_json(report) << '\n';
    else if (!arguments.quiet)
        out << report_text(report);
}

/// The files are there all the same: the raw method is asked for what it makes.
int status_of_build(const ShellReport& report, const Context& context)
{
    const std::string faults = faults_of(report);
    if (!faults.empty()) {
        context.say_failed(check_failed, report.source, "the shell is NOT VALID: " + faults);
        return check_failed;
    }
    const std::string unmet = unmet_of(report);
    if (unmet.empty())
        return success;
    context.say_failed(bound_not_met, report.source, unmet);
    return bound_not_met;
}

/// A file without a tet would look like a success to whoever only asks whether it is there.
void require_tets(const BuildArguments& arguments, const ShellResult& result)
{
    if (result.tets.tets.empty())
        throw GeometryError(arguments.mesh.filename().string() +
                            ": the shell has no tet: no pillar is longer than what float32 can "
                            "tell from nothing; nothing was written");
}

} // namespace

OptionSections describe(BuildArguments& a)
{
    // The order of the sections is that of the help and of the file of options.
    OptionSections sections{
        {"", in_group("Options", {purpose_option(a.purpose), preset_option(a.preset),
                                  input_format_option(a.format)})}};
    for (OptionSection& section : describe(a.outputs))
        sections.push_back(std::move(section));
    const OptionList figures{
        option("", a.report, "--report",
               "Write all figures as JSON; - is standard output, in place of the text"),
        option("", a.remesh_map, "--remesh-map",
               "Write where each vertex before remeshing lies on the surface after it, and the "
               "other way round: .json or .csv")
            .needing("--remesh-edge-length or --remesh-to"),
        option("", a.quiet, "--quiet", "Print no figures").with_names({"-q"})};
    const Option painted = option("", a.thickness_grid, "--thickness-grid",
                                  "Float grid of largest lengths: FILE.vdb or FILE.vdb:GRID");
    sections.push_back({"", in_group("Output", figures)});
    sections.push_back({"read", describe(a.read)});
    for (OptionSection& section : describe(a.shell)) {
        for (Option& o : section.options)
            if (o.flag == "--core")
                take_core_files(o, a.cores);
        sections.push_back(std::move(section));
    }
    sections.push_back({"", in_group("Lines", {painted})});
    return sections;
}

BoundOptions add_build_command(CLI::App& app, BuildArguments& arguments)
{
    app.add_option("mesh", arguments.mesh,
                   std::string("Surface: ") + kSurfaceExtensions +
                       "; or level set: FILE.vdb or FILE.vdb:GRID")
        ->required();
    return bind(app, describe(arguments));
}

FilePlan plan_build(const BuildArguments& arguments)
{
    require_sensible(arguments);
    return plan_files(arguments);
}

int run_build(const BuildArguments& arguments, Context& context)
{
    SignalInterrupter interrupter(context);
    std::vector<StageCost> write_cost;
    ShellOptions options = arguments.shell;
    ShellResult result = [&] {
        // For building alone, as only --core-fill starts an outside program.
        const PoliteStop polite(options.core_fill.wanted());
        return read_and_build(arguments, options, context, &interrupter);
    }();
    // A signal that came while the outside program could run was only noted, and the last stage may
    // not have asked since.
    if (caught_signal())
        throw Cancelled();
    require_tets(arguments, result);
    OutputSet files(existing_files(arguments.outputs.no_clobber));
    interrupter.start("write");
    StageClock(write_cost, &interrupter).run("write", [&] {
        if (!arguments.remesh_map.empty())
            write_remesh_map(arguments.remesh_map, *result.remesh_map, &files);
        // Before to_file, which takes the tets out of the result.
        const std::vector<std::uint8_t> certified =
            certified_flags(result.report.overlaps, result.tets.tets.size());
        write_outputs(arguments.outputs, to_file(result, options, arguments.outputs, &interrupter),
                      certified, files);
    });

    std::vector<StageCost>& stages = result.report.stages;
    // After write_outputs: the report within the files cannot have the time that writing them took,
    // the one beside them can.
    stages.insert(stages.end(), write_cost.begin(), write_cost.end());
    write_report(arguments, result.report, files);
    files.commit();
    // When all files are in their places: whoever reads figures may take the files for written.
    print_figures(arguments, result.report, context.out);
    return status_of_build(result.report, context);
}

} // namespace vdb_shell::command

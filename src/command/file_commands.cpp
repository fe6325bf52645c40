// SPDX-License-Identifier: Apache-2.0

// The commands that work on the file of a shell: `info` prints what it holds, `convert` writes
// other formats, `check` holds it against itself. All of them read the shell whole and through its
// checksum, so each refuses a file whose arrays are damaged. Houdini's geometry holds the shell but
// not the grids, which are null then.

#include "command/file_commands.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/houdini/shell_geometry.h"
#include "vdb_shell/write/verify_file.h"

#include "command/exit_code.h"
#include "command/file_plan.h"
#include "command/signals.h"
#include "options/parse_json.h"
#include "options/shown_text.h"

#include <openvdb/openvdb.h>

#include <nlohmann/json.hpp>

#include <CLI/CLI.hpp>

#include <ostream>
#include <utility>

namespace vdb_shell::command
{
namespace
{

void add_file(CLI::App& app, FileArguments& arguments)
{
    app.add_option("file", arguments.file, "A .vdb, .geo, .bgeo or .bgeo.sc that vdb_shell wrote")
        ->required();
}

/// Other programs write such files too, and may have put any text there.
nlohmann::ordered_json stored_json(const std::filesystem::path& path, const char* what,
                                   const std::string& text)
{
    return parse_json(text, path.string() + ": its " + what);
}

/// What reading has held against the file's own digests, and what it has not looked at.
void print_checks(const ShellFile& file, std::ostream& out)
{
    if (file.digests > 0)
        out << "  checked: " << file.digests << " digests of its parts hold\n";
    else
        out << "  it has no digests of its parts\n";
    out << "  not checked: certificate and figures (vdb_shell check)\n";
}

void print_grid(const openvdb::FloatGrid& grid, std::ostream& out)
{
    out << "  " << shown(grid.getName()) << ": "
        << openvdb::GridBase::gridClassToString(grid.getGridClass()) << ", voxel "
        << grid.voxelSize()[0] << ", " << grid.activeVoxelCount() << " active voxels\n";
}

} // namespace

ShellFile read_shell(const std::filesystem::path& path)
{
    return houdini::has_geometry_extension(path) ? houdini::read_shell_geometry(path)
                                                 : read_shell_vdb(path);
}

BoundOptions add_info_command(CLI::App& app, FileArguments& arguments)
{
    add_file(app, arguments);
    Option json = option("", arguments.json, "--json",
                         "Print the stored parameters and report as one JSON object");
    return bind(app, {{"", in_group("Options", {json})}});
}

BoundOptions add_convert_command(CLI::App& app, FileArguments& arguments)
{
    add_file(app, arguments);
    OptionSections sections = describe(arguments.outputs);
    // `build` may run for its figures alone; a conversion without output would do nothing.
    find_by_flag(sections.front().options, "--output")->required = true;
    return bind(app, std::move(sections));
}

BoundOptions add_check_command(CLI::App& app, FileArguments& arguments)
{
    add_file(app, arguments);
    return {};
}

int run_info(const FileArguments& arguments, Context& context)
{
    const ShellFile file = read_shell(arguments.file);
    if (arguments.json) {
        nlohmann::ordered_json json;
        json["parameters"] = stored_json(arguments.file, "parameters", file.parameters_json);
        // Parsed and not passed on as text: what is printed is one JSON object, whatever stands in
        // the file.
        json["report"] = stored_json(arguments.file, "report", file.report_json);
        context.out << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
                    << '\n';
        return success;
    }
    const std::size_t layers = file.stack.layers.size();
    context.out << arguments.file.string() << ": shell\n  " << file.stack.surface(0).size()
                << " surface vertices, " << layers << (layers == 1 ? " layer, " : " layers, ")
                << layers * file.stack.triangles().size() << " prisms, " << file.tets.points.size()
                << " points, " << file.tets.tets.size() << " tets\n";
    if (!file.core.empty())
        context.out << "  core: " << file.core.points.size() << " points, " << file.core.tets.size()
                    << " tets\n";
    for (const openvdb::FloatGrid::Ptr& grid : {file.surface, file.depth})
        if (grid)
            print_grid(*grid, context.out);
    // Reading has thrown already for a part whose digest does not hold; so what is printed is that
    // they do.
    print_checks(file, context.out);
    context.out << "parameters " << shown_lines(file.parameters_json) << "\nreport "
                << shown_lines(file.report_json) << '\n';
    return success;
}

void add_points_file(FilePlan& plan, const std::filesystem::path& shell)
{
    // Houdini geometry has all of the shell in itself.
    if (!houdini::has_geometry_extension(shell))
        plan.add_input(read_shell_info(shell).points_at);
}

FilePlan plan_convert(const FileArguments& arguments)
{
    FilePlan plan(existing_files(arguments.outputs.no_clobber));
    plan.add_input(arguments.file);
    add_outputs(plan, arguments.outputs);
    return plan;
}

int run_convert(const FileArguments& arguments)
{
    // Made anew, for the points may stand in a file that is not known before this one is opened.
    FilePlan plan = plan_convert(arguments);
    add_points_file(plan, arguments.file);
    const ShellFile file = read_shell(arguments.file);
    // The flags of certified tets are not taken from the file's report: they are what the tets
    // themselves show, by exact tests.
    std::vector<std::uint8_t> certified;
    if (wants_flags(arguments.outputs))
        certified = certified_tets(file);
    OutputSet files(existing_files(arguments.outputs.no_clobber));
    write_outputs(arguments.outputs, file, certified, files);
    files.commit();
    return success;
}

int run_check(const FileArguments& arguments, Context& context)
{
    SignalInterrupter interrupter(context);
    bool all_hold = true;
    for (const Verification& entry : verify_shell(read_shell(arguments.file), &interrupter)) {
        context.out << (entry.holds ? "ok      " : "FAILED  ") << entry.what << ": "
                    << shown(entry.detail) << '\n';
        // Every entry is printed even after one has failed: which of them fail together is what
        // tells the cause.
        all_hold = all_hold && entry.holds;
    }
    context.out << arguments.file.string()
                << (all_hold ? ": is what it claims\n" : ": is NOT what it claims\n");
    return all_hold ? success : check_failed;
}

} // namespace vdb_shell::command

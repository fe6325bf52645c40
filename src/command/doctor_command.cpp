// SPDX-License-Identifier: Apache-2.0

// The command `doctor`: what this build and this machine have, so that a person who asks for help
// can send it, and what a given file needs. It changes nothing and starts no program.

#include "command/doctor_command.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/io/vdb_header.h"
#include "vdb_shell/io/volume_file.h"

#include "command/exit_code.h"
#include "command/help.h"
#include "core/available_memory.h"
#include "core/parallel.h"
#include "core/text_stream.h"
#include "fill/outside_program.h"
#include "io/mesh_formats.h"
#include "options/shown_text.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <algorithm>
#include <thread>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

void print_row(std::ostream& out, const std::string& what, const std::string& text)
{
    constexpr std::size_t kWidth = 14;
    out << what << std::string(kWidth - std::min(what.size(), kWidth - 1), ' ') << text << '\n';
}

void print_program(std::ostream& out, const std::string& name)
{
    const fs::path program = fill::find_program(name);
    print_row(out, name,
              program.empty() ? "not found: --core-fill " + name +
                                    " is refused (status 8); Debian "
                                    "has it in the package " +
                                    name
                              : program.string() + ", for --core-fill " + name);
}

void print_folder(std::ostream& out, const char* what, const fs::path& folder)
{
    std::error_code unknown;
    const fs::space_info space = fs::space(folder, unknown);
    OutText text;
    text.precision(3);
    text << folder.string()
         << (::access(folder.c_str(), W_OK) == 0 ? ", can be written" : ", CANNOT be written");
    if (!unknown)
        text << ", " << double(space.available) / kBytesPerGib << " GiB free";
    print_row(out, what, text.str());
}

void print_machine(std::ostream& out)
{
    out << version_text() << '\n';
    print_row(out, "threads",
              std::to_string(thread_count()) + " of " +
                  std::to_string(std::thread::hardware_concurrency()));
    print_program(out, "gmsh");
    print_program(out, "tetgen");
    std::error_code none;
    const fs::path temporary = fs::temp_directory_path(none);
    if (none)
        print_row(out, "temporary", "TMPDIR names no folder: standard input and --core-fill fail");
    else
        print_folder(out, "temporary", temporary);
    const fs::path here = fs::current_path(none);
    if (none)
        print_row(out, "here", "is no folder any more: " + none.message());
    else
        print_folder(out, "here", here);
}

/// Grids by name and type, and whether they are a shell of ours.
void print_vdb(std::ostream& out, const fs::path& path)
{
    // Before OpenVDB opens it: a count in a damaged file could have it ask for all memory.
    require_whole_vdb(path);
    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.open(false);
    bool level_set = false, floats = false, volumes = false;
    // Names and types only: that the rest is whole, the walk has shown.
    const openvdb::GridPtrVecPtr grids = file.readAllGridMetadata();
    for (const openvdb::GridBase::Ptr& grid : *grids) {
        const bool is_level_set = grid->getGridClass() == openvdb::GRID_LEVEL_SET;
        print_row(out, "grid",
                  '"' + shown(grid->getName()) + "\", " + shown(grid->type()) +
                      (is_level_set ? ", level set" : ""));
        floats = floats || grid->isType<openvdb::FloatGrid>();
        level_set = level_set || (is_level_set && grid->isType<openvdb::FloatGrid>());
        volumes = volumes || is_volume(*grid, GridKinds::volumes_and_points);
    }
    const openvdb::MetaMap::Ptr metadata = file.getMetadata();
    // The key that only files of ours have; whether the shell in it is whole is for check.
    const bool shell = (*metadata)["vdb_shell_schema"] != nullptr;
    if (shell)
        print_row(out, "use", "info, convert and check read it as a shell");
    if (level_set)
        print_row(out, "use", "build reads it as a level set");
    if (floats && !shell)
        print_row(out, "use", "build reads it as a --thickness-grid");
    if (volumes)
        print_row(out, "use", "deform and map read it as volumes");
    if (!volumes && !shell)
        print_row(
            out, "use",
            "no command reads it: it has no grids of floats, vectors, whole numbers or points");
}

int print_file(std::ostream& out, const fs::path& path)
{
    std::error_code none;
    const std::uintmax_t bytes = fs::file_size(path, none);
    if (none)
        throw ReadError(path.string() + ": " + none.message());
    const std::string extension = lower_case_extension(path);
    print_row(out, "file", path.string() + ", " + std::to_string(bytes) + " bytes");
    if (extension == ".vdb") {
        print_vdb(out, path);
        return success;
    }
    if (houdini::has_geometry_extension(path)) {
        print_row(out, "use",
                  "polygons: inspect, repair and build; a shell of vdb_shell's: info, "
                  "convert and check");
        return success;
    }
    if (mesh_format_of(path)) {
        print_row(out, "use", "inspect says what a shell of it needs; repair and build read it");
        return success;
    }
    print_row(out, "use", "no command reads the extension \"" + extension + "\"");
    // The status says what a command would say of the file.
    return read_error;
}

} // namespace

BoundOptions add_doctor_command(CLI::App& app, DoctorArguments& arguments)
{
    app.add_option("file", arguments.file, "A file that is to be read");
    return {};
}

int run_doctor(const DoctorArguments& arguments, Context& context)
{
    print_machine(context.out);
    return arguments.file.empty() ? success : print_file(context.out, arguments.file);
}

} // namespace vdb_shell::command

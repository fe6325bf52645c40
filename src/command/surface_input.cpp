// SPDX-License-Identifier: Apache-2.0

// What several commands share about reading a surface: any format by its extension, grids put into
// the frame of the mesh, and a warning about lost digits. Houdini's formats are read by
// houdini_compat, of which the library knows nothing, so the choice has to be made here.

#include "command/surface_input.h"

#include "core/temporary_file.h"
#include "core/text_stream.h"
#include "field/map_values.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/houdini/polygon_mesh.h"

#include "command/file_plan.h"
#include "io/mesh_formats.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <fstream>
#include <iostream>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

/// Readers want a file: they look at its end before its middle, and some do so twice.
ReadResult read_standard_input(const ReadOptions& options, InputFormat format)
{
    // With the extension of its format, by which readers go; readable for its owner only, as nobody
    // else was given what comes here.
    std::error_code none;
    const fs::path folder = fs::temp_directory_path(none);
    if (none)
        throw ReadError("-: standard input is kept in a file for reading, and " +
                        no_temporary_folder(none));
    const TemporaryFile spool(folder, "standard-input." + name_in_table(format), 0600);
    std::ofstream out(spool.path(), std::ios::binary);
    // Writing an empty stream out would set the stream to failed, and be told as a disk that is
    // full.
    if (std::cin.peek() == std::char_traits<char>::eof())
        throw ReadError("-: standard input is empty");
    out << std::cin.rdbuf();
    out.close();
    if (!out)
        throw ReadError("-: standard input does not fit into " +
                        spool.path().parent_path().string());
    try {
        return read_surface(spool.path(), options);
    } catch (const ReadError& error) {
        // Messages name the file, and the user knows none of that name.
        std::string text = error.what();
        const std::string name = spool.path().string();
        for (std::size_t at = 0; (at = text.find(name)) != std::string::npos;)
            text.replace(at, name.size(), "-");
        throw ReadError(text);
    }
}

} // namespace

GridName split_grid_name(const std::string& name)
{
    // The last one counts, as a folder may have such a name too. A colon alone would not do: names
    // of files may contain it.
    const std::size_t colon = lower_case(name).rfind(".vdb:");
    if (colon == std::string::npos)
        return {name, ""};
    constexpr std::size_t kExtension = 4; // ".vdb"
    return {name.substr(0, colon + kExtension), name.substr(colon + kExtension + 1)};
}

const NameTable<InputFormat>& names(InputFormat)
{
    static const NameTable<InputFormat> table{{"by-extension", InputFormat::by_extension},
                                              {"obj", InputFormat::obj},
                                              {"ply", InputFormat::ply},
                                              {"off", InputFormat::off},
                                              {"stl", InputFormat::stl},
                                              {"geo", InputFormat::geo},
                                              {"bgeo", InputFormat::bgeo}};
    return table;
}

Option input_format_option(InputFormat& format)
{
    return option("", format, "--input-format", "What standard input (-) holds");
}

void require_format(const std::filesystem::path& path, InputFormat format)
{
    const bool given = format != InputFormat::by_extension;
    if (is_standard_input(path) && !given)
        throw InvalidOption("-: standard input has no extension; --input-format says what it is");
    if (!is_standard_input(path) && given)
        throw InvalidOption("--input-format is for standard input (-); the format of " +
                            path.string() + " goes by its extension");
}

ReadResult read_surface(const std::filesystem::path& path, const ReadOptions& options,
                        InputFormat format)
{
    if (is_standard_input(path)) {
        require_format(path, format);
        return read_standard_input(options, format);
    }
    if (houdini::has_geometry_extension(path))
        return houdini::read_polygon_mesh(path, options);
    // read_mesh would name its own formats alone.
    if (!mesh_format_of(path))
        throw ReadError(path.string() + ": the extension \"" + lower_case_extension(path) +
                        "\" is none of those that are read: .obj .ply .off .stl .geo .bgeo "
                        ".bgeo.sc, and .vdb for a level set that build is given");
    return read_mesh(path, options);
}

FloatGridPtr in_place(const FloatGridPtr& grid, const Placement& placement)
{
    if (!grid || !placement.moves())
        return grid;
    // A deep copy, because values change and the caller's grid must not.
    auto moved = grid->deepCopy();
    // file = origin + unit * mesh, so the way back is first the shift and then the scale. The unit
    // is a power of two: dividing lengths by it rounds nothing, short of underflow.
    moved->transform().postTranslate(-placement.origin);
    moved->transform().postScale(1.0 / placement.unit);
    // The background too: it is the length wherever nothing was painted.
    map_values(moved->tree(), [unit = placement.unit](float value) {
        return static_cast<float>(double(value) / unit);
    });
    return moved;
}

void warn_of_lost_digits(const std::filesystem::path& path, const ReadResult& read,
                         const Context& context)
{
    const Bounds bounds = bounds_of(read.mesh.points);
    const openvdb::Vec3d size = bounds.high - bounds.low;
    const double longest = std::max({size[0], size[1], size[2]});
    // Rounding moves a coordinate by half a step of float32 at most. So above this share the object
    // has fewer than 2^17 steps along its longest side, of the 2^23 or more that it would have at
    // the origin.
    constexpr double kShare = 1.0 / (1 << 18);
    if (read.report.largest_rounding <= kShare * longest)
        return;
    OutText text;
    text << "warning: " << path.string() << ": rounding to float32 moved coordinates by up to "
         << read.report.largest_rounding << " of an object of size " << longest
         << ", which lies far from the origin; --recentre keeps the digits of the file";
    context.say(LogLevel::warning, text.str());
}

} // namespace vdb_shell::command

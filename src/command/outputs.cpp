// SPDX-License-Identifier: Apache-2.0

// From names of files to writers: the extension alone decides the format. All outputs are held
// against what is known before any work begins, so a run of minutes does not end in a misspelt
// extension. The files of a call are written into one set and appear together. A new extension also
// has to be named in the two lists that people read, the help of -o and the message for unknown
// ones.

#include "command/outputs.h"

#include "io/mesh_formats.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/houdini/shell_geometry.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/write/html_page.h"
#include "vdb_shell/write/tet_file.h"

#include <algorithm>
#include <utility>

namespace vdb_shell::command
{
namespace
{

namespace fs = std::filesystem;

enum class Kind { vdb, houdini, tets, surface, picture, page, usd, unknown };

Kind kind_of(const fs::path& path)
{
    const std::string extension = lower_case_extension(path);
    if (extension == ".vdb")
        return Kind::vdb;
    // By the whole name, as `.bgeo.sc` is two extensions to std::filesystem.
    if (houdini::has_geometry_extension(path))
        return Kind::houdini;
    if (extension == ".png")
        return Kind::picture;
    if (extension == ".html")
        return Kind::page;
    if (extension == ".usda")
        return Kind::usd;
    const std::vector<std::string>& tets = tet_file_extensions();
    if (std::find(tets.begin(), tets.end(), extension) != tets.end())
        return Kind::tets;
    return mesh_format_of(path) ? Kind::surface : Kind::unknown;
}

/// The .vdb to which a USD stage refers. The first one is taken, since all of them hold the same
/// grids.
fs::path first_vdb(const Outputs& outputs)
{
    for (const fs::path& path : outputs.paths)
        if (kind_of(path) == Kind::vdb)
            return path;
    return {};
}

/// The files that one output is made of. Of TetGen's either name gives all, and both names together
/// give them once.
std::vector<fs::path> files_of(const fs::path& path, const Outputs& outputs)
{
    if (kind_of(path) == Kind::vdb && outputs.vdb.points == PointPlacement::beside)
        return {path, points_file_of(path)};
    std::vector<fs::path> files = tet_files_of(path);
    // Where both are named, the other name writes all, and this one nothing.
    if (lower_case_extension(path) == ".ele" &&
        std::count(outputs.paths.begin(), outputs.paths.end(), files.front()) > 0)
        return {};
    return files;
}

/// The shell and what fills it, as one mesh of tets; flags of the core's are all set, as a core is
/// proven or not there.
struct Solid {
    TetMesh tets;
    std::vector<std::uint8_t> certified;
    PointExtras extras;
};
Solid solid_of(const ShellFile& file, std::vector<std::uint8_t> certified)
{
    Solid solid{joined_tets(file.tets, file.core), std::move(certified), {}};
    solid.extras = {pillar_values(file.stack, file.tets, solid.tets.points.size()),
                    feet_of_tet_points(file.stack, solid.tets, file.core_feet),
                    vectors_of_tet_points(file.tets, file.rest),
                    vectors_of_tet_points(file.tets, file.rest.velocity), file.input};
    // No flags at all stay none: an empty list says that nobody looked, and not that all are bad.
    if (!solid.certified.empty())
        solid.certified.resize(solid.tets.tets.size(), 1);
    return solid;
}

} // namespace

OptionSections describe(Outputs& o)
{
    const Option output =
        option("", o.paths, "--output",
               "File to write; give it once for each file wanted. By extension: .vdb (everything), "
               ".geo .bgeo .bgeo.sc (all but the grids, for Houdini), .usda (surface, tets, and "
               "the volumes of the .vdb written with it), .vtu .node .ele .mesh .msh (tets), .obj "
               ".ply .off .stl (a surface of the shell, --surface says which), .png (picture: a "
               "section, or the surface whole or cut open), .html (a page to turn and cut it in a "
               "browser)")
            .with_names({"-o"});
    return {{"", in_group("Output", {output, no_clobber_option(o.no_clobber)})},
            {"vdb", describe(o.vdb)},
            {"usd", describe(o.usd)},
            {"surface_file", describe(o.surface_file)},
            {"picture", describe(o.picture)}};
}

void add_outputs(FilePlan& plan, const Outputs& outputs)
{
    for (const fs::path& path : outputs.paths)
        if (kind_of(path) == Kind::unknown)
            throw InvalidOption(path.string() + ": unknown extension \"" +
                                path.extension().string() +
                                "\"; known are .vdb .geo .bgeo .bgeo.sc .usda .vtu .node .ele "
                                ".mesh .msh .obj .ply .off .stl .png .html");
    require_sensible(outputs.picture);
    // Before the files are added: a stage that could not name its volumes would be found out only
    // when it is written.
    const fs::path volume = first_vdb(outputs);
    for (const fs::path& path : outputs.paths)
        if (kind_of(path) == Kind::usd && !volume.empty())
            require_usd_asset(path, volume);
    for (const fs::path& path : outputs.paths)
        for (const fs::path& file : files_of(path, outputs))
            plan.add_output(file);
}

bool wants_vdb(const Outputs& outputs)
{
    return std::any_of(outputs.paths.begin(), outputs.paths.end(),
                       [](const fs::path& path) { return kind_of(path) == Kind::vdb; });
}

bool wants_flags(const Outputs& outputs)
{
    return std::any_of(outputs.paths.begin(), outputs.paths.end(),
                       [](const fs::path& path) { return kind_of(path) == Kind::tets; });
}

std::vector<std::uint8_t> certified_flags(const std::optional<Overlaps>& overlaps, std::size_t tets)
{
    return overlaps ? overlaps->certified : std::vector<std::uint8_t>(tets, 1);
}

void write_outputs(const Outputs& outputs, const ShellFile& file,
                   const std::vector<std::uint8_t>& certified, OutputSet& files)
{
    // Joined once for all formats of tets, and not at all without one: it is a copy of all tets.
    const Solid solid = wants_flags(outputs) ? solid_of(file, certified) : Solid{};
    for (const fs::path& path : outputs.paths) {
        // The .ele of a call that names the .node too, which writes all.
        if (files_of(path, outputs).empty())
            continue;
        switch (kind_of(path)) {
        case Kind::vdb:
            write_shell_vdb(path, file, outputs.vdb, &files);
            break;
        case Kind::houdini:
            houdini::write_shell_geometry(path, file, &files);
            break;
        case Kind::tets:
            write_tets(path, solid.tets, solid.certified, file.placement, solid.extras, &files);
            break;
        case Kind::surface:
            write_mesh(path, surface_of(file.stack, outputs.surface_file.surface), file.placement,
                       &files);
            break;
        case Kind::picture:
            write_picture(path, file, outputs.picture, &files);
            break;
        case Kind::page: {
            HtmlPage page;
            page.add(path.stem().string(), file);
            page.write(path, &files);
            break;
        }
        case Kind::usd:
            write_usd(path, {{0.0, &file, first_vdb(outputs)}}, outputs.usd, &files);
            break;
        case Kind::unknown:
            break; // refused by add_outputs
        }
    }
}

} // namespace vdb_shell::command

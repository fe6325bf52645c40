// SPDX-License-Identifier: Apache-2.0

// Chooses the writer of a file of tets by its extension and makes the file appear whole or not at
// all. The formats themselves are in vtu_file.cpp and tet_text_files.cpp. TetGen's format is the
// exception with three files, of which none is of use without the points; either extension writes
// all. Known extensions stand in one list, which the command shows and this file tests.

#include "vdb_shell/write/tet_file.h"

#include "vdb_shell/core/error.h"

#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/output_set.h"
#include "vdb_shell/core/words.h"
#include "write/tet_formats.h"

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

/// `files`: tet_files_of.
void write_tetgen(const std::vector<fs::path>& files, const TetMesh& tets,
                  const Placement& placement, OutputSet* with)
{
    write_together(with, [&](OutputSet& set) {
        // In one set, so that a reader never finds one of them with another of an earlier run.
        set.write_stream(files[0],
                         [&](std::ostream& out) { write_tetgen_node(out, tets, placement); });
        set.write_stream(files[1], [&](std::ostream& out) { write_tetgen_ele(out, tets); });
        set.write_stream(files[2], [&](std::ostream& out) { write_tetgen_face(out, tets); });
    });
}

[[noreturn]] void refuse_extension(const fs::path& path, const std::string& extension)
{
    std::string known;
    for (const std::string& one : tet_file_extensions())
        known += " " + one;
    throw InvalidOption(path.string() + ": unknown extension \"" + extension +
                        "\" for tets; known are" + known);
}

} // namespace

const std::vector<std::string>& tet_file_extensions()
{
    static const std::vector<std::string> extensions{".vtu", ".node", ".ele", ".mesh", ".msh"};
    return extensions;
}

std::vector<fs::path> tet_files_of(const fs::path& path)
{
    const std::string extension = lower_case_extension(path);
    if (extension != ".node" && extension != ".ele")
        return {path};
    std::vector<fs::path> files;
    for (const char* one : {".node", ".ele", ".face"})
        files.push_back(fs::path(path).replace_extension(one));
    return files;
}

void write_tets(const fs::path& path, const TetMesh& tets,
                const std::vector<std::uint8_t>& certified, const Placement& placement,
                const PointExtras& extras, OutputSet* with)
{
    // Only .vtu has a place for the flags; the other formats drop them, but a wrong number is
    // refused for all.
    if (!certified.empty() && certified.size() != tets.tets.size())
        throw InvalidOption(path.string() + ": " + std::to_string(certified.size()) +
                            " flags of certified tets for " + std::to_string(tets.tets.size()) +
                            " tets");
    const auto require_one_a_point = [&](std::size_t count, const char* what) {
        if (count > 0 && count != tets.points.size())
            throw InvalidOption(path.string() + ": " + std::to_string(count) + what +
                                std::to_string(tets.points.size()) + " points");
    };
    require_one_a_point(extras.pillars.thickness.size(), " thicknesses for ");
    require_one_a_point(extras.pillars.stop_reason.size(), " stop reasons for ");
    require_one_a_point(extras.feet.size(), " feet on cores for ");
    require_one_a_point(extras.rest.size(), " places at rest for ");
    require_one_a_point(extras.velocity.size(), " velocities for ");
    const std::string extension = lower_case_extension(path);
    if (const std::vector<fs::path> files = tet_files_of(path); files.size() > 1)
        return write_tetgen(files, tets, placement, with);
    if (extension == ".vtu")
        return write_stream_atomically(
            path, [&](std::ostream& out) { write_vtu(out, tets, certified, placement, extras); },
            with);
    // Both have no place for the extras of points.
    void (*write)(std::ostream&, const TetMesh&, const Placement&) = nullptr;
    if (extension == ".mesh")
        write = write_medit;
    else if (extension == ".msh")
        write = write_gmsh;
    else
        refuse_extension(path, extension);
    write_stream_atomically(
        path, [&](std::ostream& out) { write(out, tets, placement); }, with);
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/tet_file.h"

#include "vdb_shell/core/error.h"

#include "vdb_shell/core/atomic_file.h"
#include "write/tet_formats.h"

#include <algorithm>
#include <cctype>
#include <fstream>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

std::string lower_extension(const fs::path& path)
{
    std::string extension = path.extension().string();
    for (char& c : extension)
        c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

void write_tetgen(const fs::path& path, const TetMesh& tets, const Placement& placement)
{
    fs::path node = path, ele = path;
    node.replace_extension(".node");
    ele.replace_extension(".ele");
    write_atomically(ele, [&](const fs::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        write_tetgen_ele(out, tets);
        out.close();
        if (!out)
            throw WriteError(ele.string() + ": cannot be written: the disk is full or the file "
                                            "system refused the data");
        // Inside the other, so that neither name changes before both files are written.
        write_stream_atomically(
            node, [&](std::ostream& nodes) { write_tetgen_node(nodes, tets, placement); });
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

void write_tets(const fs::path& path, const TetMesh& tets,
                const std::vector<std::uint8_t>& certified, const Placement& placement)
{
    if (!certified.empty() && certified.size() != tets.tets.size())
        throw InvalidOption(path.string() + ": " + std::to_string(certified.size()) +
                            " flags of certified tets for " + std::to_string(tets.tets.size()) +
                            " tets");
    const std::string extension = lower_extension(path);
    if (extension == ".node" || extension == ".ele")
        return write_tetgen(path, tets, placement);
    if (extension == ".vtu")
        return write_stream_atomically(
            path, [&](std::ostream& out) { write_vtu(out, tets, certified, placement); });
    void (*write)(std::ostream&, const TetMesh&, const Placement&) = nullptr;
    if (extension == ".mesh")
        write = write_medit;
    else if (extension == ".msh")
        write = write_gmsh;
    else
        refuse_extension(path, extension);
    write_stream_atomically(path, [&](std::ostream& out) { write(out, tets, placement); });
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Surfaces as files that TetGen and Gmsh read, and the tets that they write. Digits are the
// shortest that give the same double again, in no locale. What comes back is not trusted: each
// index is held against the number of points, and memory is taken only for what has been read.

#include "fill/mesher_files.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/fill/fill_core.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace vdb_shell::fill
{
namespace
{

namespace fs = std::filesystem;

template <typename Number> void append(std::string& text, Number value)
{
    // More than the longest double takes, so to_chars cannot fail.
    char digits[64];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

/// The digits are those of the double, which is what both programs read.
void append_point(std::string& text, const openvdb::Vec3s& point)
{
    for (int axis = 0; axis < 3; ++axis) {
        text += ' ';
        append(text, double(point[axis]));
    }
    text += '\n';
}

void append_corners(std::string& text, const openvdb::Vec3I& triangle, std::uint32_t base)
{
    for (int corner = 0; corner < 3; ++corner) {
        text += ' ';
        append(text, triangle[corner] + base);
    }
    text += '\n';
}

void write_text(const fs::path& path, const std::string& text)
{
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    if (!out)
        throw WriteError(path.string() + ": cannot be written: the disk is full or the file system "
                                         "refused the data");
}

/// Numbers of a text file, one after the other; lines that begin with # are left out.
class Numbers
{
public:
    explicit Numbers(fs::path path) : path_(std::move(path)), in_(path_)
    {
        // A host program may have set a locale in which a point parts thousands.
        in_.imbue(std::locale::classic());
        if (!in_)
            fail("was not written");
    }
    template <typename Number> Number next()
    {
        Number value{};
        while (in_ >> std::ws && in_.peek() == '#')
            in_.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
        if (!(in_ >> value))
            fail("ends early, or has no number where one belongs");
        return value;
    }
    // No number of points or tets beyond 32 bits can be held, so none is read.
    std::size_t count() { return next<std::uint32_t>(); }
    void skip(std::size_t numbers)
    {
        for (std::size_t i = 0; i < numbers; ++i)
            next<double>();
    }
    openvdb::Vec3d point()
    {
        openvdb::Vec3d p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = next<double>();
        return p;
    }
    /// Goes on behind the line; false where there is none.
    bool find_line(const std::string& wanted)
    {
        for (std::string line; std::getline(in_, line);) {
            if (!line.empty() && line.back() == '\r')
                line.pop_back();
            if (line == wanted)
                return true;
        }
        return false;
    }
    [[noreturn]] void fail(const std::string& what) const
    {
        throw ProgramError(path_.filename().string() + ", which the program was to write, " + what);
    }

private:
    fs::path path_;
    std::ifstream in_;
};

void require_corner(const Numbers& in, std::int64_t corner, std::size_t points)
{
    if (corner < 0 || std::uint64_t(corner) >= points)
        in.fail("has a tet with the corner " + std::to_string(corner) + " of " +
                std::to_string(points) + " points");
}

fs::path with_ending(const fs::path& stem, const char* ending)
{
    return stem.string() + ending;
}

} // namespace

void write_poly(const fs::path& path, const TriangleMesh& surface)
{
    std::string text = std::to_string(surface.points.size()) + " 3 0 0\n";
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
        append(text, i);
        append_point(text, surface.points[i]);
    }
    text += std::to_string(surface.triangles.size()) + " 0\n";
    for (const openvdb::Vec3I& triangle : surface.triangles) {
        text += "1 0 0\n3";
        append_corners(text, triangle, 0);
    }
    // No holes and no regions: which tets lie in the void is decided by those who read them.
    text += "0\n0\n";
    write_text(path, text);
}

MesherTets read_tetgen(const fs::path& stem)
{
    MesherTets made;
    Numbers nodes(with_ending(stem, ".1.node"));
    const std::size_t points = nodes.count();
    // The head of a .node: points, dimension, attributes and boundary markers; only the last two
    // say how much stands behind a point.
    nodes.skip(1);
    const std::size_t behind = nodes.count() + nodes.count();
    for (std::size_t i = 0; i < points; ++i) {
        // Numbers begin at 0 as they do in the .poly, which is what says where TetGen begins.
        if (nodes.count() != i)
            nodes.fail("has no point " + std::to_string(i) + " in its place");
        made.points.push_back(nodes.point());
        nodes.skip(behind);
    }
    Numbers elements(with_ending(stem, ".1.ele"));
    const std::size_t tets = elements.count();
    if (elements.count() != 4)
        elements.fail("has elements of another kind than tets of four corners");
    const std::size_t attributes = elements.count();
    for (std::size_t t = 0; t < tets; ++t) {
        elements.skip(1);
        openvdb::Vec4I tet;
        for (int corner = 0; corner < 4; ++corner) {
            const auto index = elements.next<std::int64_t>();
            require_corner(elements, index, points);
            tet[corner] = std::uint32_t(index);
        }
        elements.skip(attributes);
        made.tets.push_back(tet);
    }
    return made;
}

void write_gmsh_input(const fs::path& geo, const fs::path& msh, const TriangleMesh& surface,
                      std::optional<double> edge_length, bool optimise)
{
    // Version 2.2, text (0), floats of 8 bytes.
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" +
                       std::to_string(surface.points.size()) + "\n";
    for (std::size_t i = 0; i < surface.points.size(); ++i) {
        append(text, i + 1);
        append_point(text, surface.points[i]);
    }
    text += "$EndNodes\n$Elements\n" + std::to_string(surface.triangles.size()) + "\n";
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        append(text, t + 1);
        // A triangle (2) with two tags: no physical group, and the surface.
        text += " 2 2 0 1";
        append_corners(text, surface.triangles[t], 1);
    }
    write_text(msh, text + "$EndElements\n");
    // Renumber: nodes keep their tags, by which they are found again. AngleToleranceFacetOverlap:
    // the void's sheets may come closer to each other than gmsh's default takes for sound.
    std::string script = "Merge \"" + msh.filename().string() +
                         "\";\nSurface Loop(1) = {1};\nVolume(1) = {1};\nMesh.Algorithm3D = 1;\n"
                         "Mesh.Renumber = 0;\nMesh.SaveAll = 1;\n"
                         "Mesh.MshFileVersion = 2.2;\nMesh.Binary = 0;\n"
                         "Mesh.AngleToleranceFacetOverlap = 1e-12;\n";
    script += optimise ? "Mesh.Optimize = 1;\n" : "Mesh.Optimize = 0;\n";
    if (edge_length) {
        script += "Mesh.MeshSizeMax = ";
        append(script, *edge_length);
        script += ";\n";
    }
    write_text(geo, script);
}

MesherTets read_gmsh_output(const fs::path& msh)
{
    Numbers in(msh);
    if (!in.find_line("$Nodes"))
        in.fail("has no nodes");
    MesherTets made;
    const std::size_t points = in.count();
    for (std::size_t i = 0; i < points; ++i) {
        // Gmsh counts from 1 and was told to keep the numbers; new points come behind.
        if (in.count() != i + 1)
            in.fail("has no node " + std::to_string(i + 1) + " in its place");
        made.points.push_back(in.point());
    }
    if (!in.find_line("$Elements"))
        in.fail("has no elements");
    constexpr std::size_t kFourNodeTet = 4;
    // Corners by the type of the element, from 1: line, triangle, quad, tet; and 15, a point.
    constexpr std::array<std::size_t, 16> kCorners{0, 2, 3, 4, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    const std::size_t elements = in.count();
    for (std::size_t e = 0; e < elements; ++e) {
        in.skip(1);
        const std::size_t type = in.count();
        // Tags: how many there are, then they.
        in.skip(in.count());
        if (type >= kCorners.size() || kCorners[type] == 0)
            in.fail("has an element of type " + std::to_string(type));
        openvdb::Vec4I tet;
        for (std::size_t corner = 0; corner < kCorners[type]; ++corner) {
            const std::int64_t index = in.next<std::int64_t>() - 1;
            require_corner(in, index, points);
            tet[int(corner)] = std::uint32_t(index);
        }
        if (type == kFourNodeTet)
            made.tets.push_back(tet);
    }
    return made;
}

} // namespace vdb_shell::fill

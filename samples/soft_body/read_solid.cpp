// SPDX-License-Identifier: Apache-2.0

// Takes a file of tets and leaves points and positive tets, whoever wrote them.

#include "solid.h"

#include <vdb_shell/core/error.h>
#include <vdb_shell/io/read_file.h>
#include <vdb_shell/shell/core_tets.h>
#include <vdb_shell/write/vdb_file.h>

#include <Eigen/Geometry>

#include <sstream>
#include <string>

namespace soft_body
{
namespace
{

namespace fs = std::filesystem;
using vdb_shell::refuse;

Solid from_shell(const vdb_shell::TetMesh& mesh)
{
    Solid solid;
    solid.points.resize(3, Eigen::Index(mesh.points.size()));
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (int k = 0; k < 3; ++k)
            solid.points(k, Eigen::Index(i)) = double(mesh.points[i][k]);
    for (const openvdb::Vec4I& t : mesh.tets)
        solid.tets.push_back({int(t[0]), int(t[1]), int(t[2]), int(t[3])});
    solid.layer = vdb_shell::signed_numbers(mesh.layer);
    return solid;
}

/// The words of a text file in order; comments run from # to the end of a line.
class Words
{
public:
    explicit Words(const fs::path& path)
        : name_(path.string()), text_(without_comments(vdb_shell::read_whole_file(path)))
    {
    }
    template <class T> T next(const std::string& what)
    {
        T value{};
        if (!(text_ >> value))
            refuse(name_, what + ": missing or no number");
        return value;
    }
    /// A count, which is bounded by the file's size because every element takes two bytes or more.
    std::size_t count(const std::string& what)
    {
        const auto value = next<long long>(what);
        if (value < 1 || std::size_t(value) > text_.str().size())
            refuse(name_, what + ": " + std::to_string(value) + " in a file of " +
                              std::to_string(text_.str().size()) + " bytes");
        return std::size_t(value);
    }
    bool skip_to(const std::string& word)
    {
        std::string found;
        while (text_ >> found)
            if (found == word)
                return true;
        return false;
    }
    const std::string& name() const { return name_; }

private:
    static std::istringstream without_comments(const std::string& text)
    {
        std::istringstream lines(text);
        std::string kept;
        for (std::string line; std::getline(lines, line);)
            kept += line.substr(0, line.find('#')) + '\n';
        return std::istringstream(kept);
    }
    std::string name_;
    std::istringstream text_;
};

Eigen::Vector3d read_point(Words& words, const std::string& what)
{
    const double x = words.next<double>(what), y = words.next<double>(what);
    return {x, y, words.next<double>(what)};
}

Solid read_tetgen(fs::path path)
{
    Solid solid;
    Words nodes(path.replace_extension(".node"));
    const std::size_t count = nodes.count("number of points");
    nodes.next<int>("dimension");
    const int attributes = nodes.next<int>("number of attributes");
    const int markers = nodes.next<int>("boundary markers");
    solid.points.resize(3, Eigen::Index(count));
    int first = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string what = "point " + std::to_string(i);
        const int index = nodes.next<int>(what);
        first = i == 0 ? index : first;
        solid.points.col(Eigen::Index(i)) = read_point(nodes, what);
        for (int k = 0; k < attributes + markers; ++k) {
            const auto value = nodes.next<double>(what);
            // This project's files have the attributes source vertex and layer, and no marker.
            if (attributes == 2 && markers == 0 && k == 1)
                solid.layer.push_back(int(value));
        }
    }
    Words elements(path.replace_extension(".ele"));
    solid.tets.resize(elements.count("number of tets"));
    const int corners = elements.next<int>("corners a tet");
    if (corners < 4)
        refuse(elements.name(), std::to_string(corners) + " corners a tet");
    const int extra = corners - 4 + elements.next<int>("number of attributes");
    for (std::size_t t = 0; t < solid.tets.size(); ++t) {
        const std::string what = "tet " + std::to_string(t);
        elements.next<int>(what);
        for (int& corner : solid.tets[t])
            corner = elements.next<int>(what) - first;
        for (int k = 0; k < extra; ++k)
            elements.next<double>(what);
    }
    return solid;
}

Solid read_vtk(const fs::path& path)
{
    Words words(path);
    Solid solid;
    if (!words.skip_to("POINTS"))
        refuse(words.name(), "no POINTS; legacy ASCII is what is read");
    const std::size_t count = words.count("number of points");
    words.next<std::string>("type of points");
    solid.points.resize(3, Eigen::Index(count));
    for (std::size_t i = 0; i < count; ++i)
        solid.points.col(Eigen::Index(i)) = read_point(words, "point " + std::to_string(i));
    if (!words.skip_to("CELLS"))
        refuse(words.name(), "no CELLS");
    const std::size_t cells = words.count("number of cells");
    words.count("size of the cells");
    for (std::size_t c = 0; c < cells; ++c) {
        const std::string what = "cell " + std::to_string(c);
        const int corners = words.next<int>(what);
        Tet tet{};
        for (int k = 0; k < corners; ++k) {
            const int corner = words.next<int>(what);
            if (k < 4)
                tet[std::size_t(k)] = corner;
        }
        if (corners == 4)
            solid.tets.push_back(tet);
    }
    return solid;
}

void check_corners(const Solid& solid, const std::string& name)
{
    for (std::size_t t = 0; t < solid.tets.size(); ++t) {
        for (int corner : solid.tets[t])
            if (corner < 0 || corner >= solid.points.cols())
                refuse(name, "tet " + std::to_string(t) + ": corner " + std::to_string(corner) +
                                 ", and " + std::to_string(solid.points.cols()) + " points");
        const auto& [a, b, c, d] = solid.tets[t];
        const Eigen::Vector3d at = solid.points.col(a);
        const double volume = (solid.points.col(b) - at)
                                  .cross(solid.points.col(c) - at)
                                  .dot(solid.points.col(d) - at) /
                              6;
        if (!(volume > 0))
            throw vdb_shell::GeometryError(name + ": tet " + std::to_string(t) + ": volume " +
                                           std::to_string(volume) +
                                           "; a solver needs tets of positive volume");
    }
    if (solid.tets.empty())
        refuse(name, "no tets");
}

/// Points of no tet have neither mass nor stiffness.
void drop_unused(Solid& solid)
{
    std::vector<int> index(std::size_t(solid.points.cols()), -1);
    for (const Tet& tet : solid.tets)
        for (int corner : tet)
            index[std::size_t(corner)] = 0;
    int count = 0;
    for (std::size_t i = 0; i < index.size(); ++i) {
        if (index[i] < 0)
            continue;
        index[i] = count++;
        solid.points.col(index[i]) = solid.points.col(Eigen::Index(i)).eval();
        if (!solid.layer.empty())
            solid.layer[std::size_t(index[i])] = solid.layer[i];
    }
    solid.points.conservativeResize(3, count);
    if (!solid.layer.empty())
        solid.layer.resize(std::size_t(count));
    for (Tet& tet : solid.tets)
        for (int& corner : tet)
            corner = index[std::size_t(corner)];
}

} // namespace

Solid read_solid(const fs::path& path)
{
    const std::string extension = path.extension().string();
    Solid solid;
    if (extension == ".vdb") {
        const vdb_shell::ShellFile file = vdb_shell::read_shell_vdb(path);
        solid = from_shell(vdb_shell::joined_tets(file.tets, file.core));
    } else if (extension == ".node" || extension == ".ele")
        solid = read_tetgen(path);
    else if (extension == ".vtk")
        solid = read_vtk(path);
    else
        refuse(path.string(),
               "unknown extension \"" + extension + "\" for tets; known are .vdb .node .ele .vtk");
    check_corners(solid, path.string());
    drop_unused(solid);
    return solid;
}

} // namespace soft_body

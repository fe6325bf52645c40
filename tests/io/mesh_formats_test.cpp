// SPDX-License-Identifier: Apache-2.0
// The less common forms of the mesh formats: docs/mesh_files.md lists what is read and refused.
#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/polygon_soup.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

const char* const kByteOrderMark = "\xEF\xBB\xBF";
const char* const kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                         "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

template <typename Value> std::string raw(Value value, bool big_endian)
{
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (big_endian)
        std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

class MeshFormats : public testing::Test
{
protected:
    ReadResult read(const std::string& file, const std::string& bytes)
    {
        test::write_bytes(folder_ / file, bytes);
        return read_mesh(folder_ / file);
    }
    std::string complaint(const std::string& file, const std::string& bytes)
    {
        try {
            read(file, bytes);
        } catch (const ReadError& error) {
            EXPECT_EQ(std::string(error.what()).find((folder_ / file).string()), 0U);
            return error.what();
        }
        return "nothing was thrown";
    }
    test::TemporaryFolder folder_;
};

#define EXPECT_SAYS(message, part)                                                                 \
    EXPECT_NE((message).find(part), std::string::npos) << "it says: " << (message)

void expect_tetrahedron(const ReadResult& result)
{
    const TriangleMesh wanted = test::unit_tetrahedron();
    EXPECT_EQ(result.mesh.points, wanted.points);
    EXPECT_EQ(result.mesh.triangles, wanted.triangles);
}

/// A grid of n by n quads in the plane z = 0, as strips that are seen from above anticlockwise.
struct StripGrid {
    std::vector<Vec3s> points;
    std::vector<std::int32_t> list; ///< with -1 behind each strip
};

StripGrid strip_grid(std::int32_t n)
{
    StripGrid grid;
    for (std::int32_t y = 0; y <= n; ++y)
        for (std::int32_t x = 0; x <= n; ++x)
            grid.points.emplace_back(float(x), float(y), 0.0F);
    for (std::int32_t y = 0; y < n; ++y) {
        for (std::int32_t x = 0; x <= n; ++x) {
            grid.list.push_back((y + 1) * (n + 1) + x);
            grid.list.push_back(y * (n + 1) + x);
        }
        grid.list.push_back(-1);
    }
    return grid;
}

std::string strip_header(const std::string& encoding, std::size_t vertices)
{
    return "ply\nformat " + encoding + " 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n"
           "property list int int vertex_indices\nend_header\n";
}

std::string text_strips(const StripGrid& grid)
{
    std::string text = strip_header("ascii", grid.points.size());
    for (const Vec3s& p : grid.points)
        text +=
            std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) + "\n";
    text += std::to_string(grid.list.size());
    for (const std::int32_t index : grid.list)
        text += " " + std::to_string(index);
    return text + "\n";
}

std::string binary_strips(const StripGrid& grid, bool big_endian)
{
    std::string bytes =
        strip_header(big_endian ? "binary_big_endian" : "binary_little_endian", grid.points.size());
    for (const Vec3s& p : grid.points)
        for (int axis = 0; axis < 3; ++axis)
            bytes += raw(p[axis], big_endian);
    bytes += raw(static_cast<std::int32_t>(grid.list.size()), big_endian);
    for (const std::int32_t index : grid.list)
        bytes += raw(index, big_endian);
    return bytes;
}

TEST_F(MeshFormats, reads_triangle_strips_of_ply_in_every_encoding)
{
    const std::int32_t n = 5;
    const StripGrid grid = strip_grid(n);
    for (const std::string& bytes :
         {text_strips(grid), binary_strips(grid, false), binary_strips(grid, true)}) {
        const ReadResult result = read("strips.ply", bytes);
        EXPECT_EQ(result.report.file_faces, std::size_t(2 * n * n));
        EXPECT_TRUE(result.report.skipped_faces.empty());
        EXPECT_EQ(result.mesh.points, grid.points);
        ASSERT_EQ(result.mesh.triangles.size(), std::size_t(2 * n * n));
        for (const Vec3I& t : result.mesh.triangles) {
            const Vec3d a(result.mesh.points[t[0]]), b(result.mesh.points[t[1]]),
                c(result.mesh.points[t[2]]);
            EXPECT_EQ((b - a).cross(c - a), Vec3d(0, 0, 1)) << "half a quad, seen from above";
        }
    }
}

TEST_F(MeshFormats, closes_a_tetrahedron_by_one_triangle_strip)
{
    StripGrid strip;
    strip.points = test::unit_tetrahedron().points;
    strip.list = {-1, 0, 2, 1, 3, 0, 2, -1, -1}; // empty strips before and after
    const ReadResult result = read("t.ply", text_strips(strip));
    EXPECT_EQ(result.mesh.triangles.size(), 4U);
    EXPECT_NEAR(check_mesh(result.mesh).volume, 1.0 / 6, 1e-12);
}

TEST_F(MeshFormats, counts_the_flat_triangles_of_a_strip_as_skipped)
{
    StripGrid grid = strip_grid(1);
    // Two strips joined by repeated corners, as programs without restarts write them.
    grid.list = {2, 0, 3, 1, 1, 2, 2, 0, 3};
    const ReadResult result = read("joined.ply", text_strips(grid));
    EXPECT_EQ(result.report.file_faces, 7U);
    EXPECT_EQ(result.report.skipped_faces, (std::vector<std::size_t>{2, 3, 4, 5}));
    EXPECT_EQ(result.mesh.triangles.size(), 3U);
}

TEST_F(MeshFormats, names_what_is_wrong_in_triangle_strips)
{
    StripGrid grid = strip_grid(1);
    grid.list = {2, 0, 3, 1, -1, 0, 1};
    EXPECT_SAYS(complaint("a.ply", text_strips(grid)),
                "triangle strip 1 (line 14) has 2 corners where at least 3 are needed");
    grid.list = {2, 0, 3, 4, -1};
    EXPECT_SAYS(
        complaint("a.ply", text_strips(grid)),
        "triangle strip 0 (line 14): the vertex index 4 is out of range, the file has 4 vertices");
    grid.list = {2, 0, 3, -2, -1};
    EXPECT_SAYS(complaint("a.ply", binary_strips(grid, true)),
                "triangle strip 0: the vertex index -2 is out of range");
    const std::string whole = binary_strips(strip_grid(1), false);
    EXPECT_SAYS(complaint("a.ply", whole.substr(0, whole.size() - 1)),
                "a list \"vertex_indices\" of 5");
    EXPECT_SAYS(complaint("a.ply", whole + "x"), "goes on");
    std::string twice = text_strips(strip_grid(1));
    twice.insert(twice.find("end_header"),
                 "element face 1\nproperty list uchar int vertex_indices\n");
    EXPECT_SAYS(complaint("a.ply", twice + "3 0 1 2\n"), "both faces and tristrips");
    std::string no_list = text_strips(strip_grid(1));
    no_list.replace(no_list.find("vertex_indices"), 14, "something");
    EXPECT_SAYS(complaint("a.ply", no_list), "gives its tristrips not one list");
}

TEST_F(MeshFormats, never_takes_cut_triangle_strips_amiss)
{
    const StripGrid grid = strip_grid(2);
    for (const std::string& bytes : {text_strips(grid), binary_strips(grid, true)})
        for (std::size_t length = 0; length + 3 < bytes.size(); ++length)
            EXPECT_NE(complaint("cut.ply", bytes.substr(0, length)), "nothing was thrown");
}

TEST_F(MeshFormats, reads_off_whose_values_run_over_line_ends)
{
    expect_tetrahedron(read("faces.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                         "3 0\n2 # a comment\n\n1\n3 0 1 3\n3\n0 3\n2 255 0 0\n"
                                         "3 1 2\n3\n"));
    expect_tetrahedron(read("all.off", "OFF 4 4 6\n0\n0\n0 1 0\n0\n0 1\n0 0\n0 1\n"
                                       "3\n0\n2\n1\n3\n0\n1\n3\n3\n0\n3\n2\n3\n1\n2\n3"));
}

TEST_F(MeshFormats, names_lines_of_off_faces_that_run_over_line_ends)
{
    const std::string head = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_SAYS(complaint("a.off", head + "3 0\n1\n7\n"),
                "face 0 (line 8): the vertex index 7 is out of range, the file has 3 vertices");
    EXPECT_SAYS(complaint("a.off", head + "3 0\n# none\n1\n"),
                "face 0 (line 6) declares 3 corners and has 2");
    EXPECT_SAYS(complaint("a.off", head + "3 0\nx 1\n"), "face 0 (line 7): \"x\"");
    EXPECT_SAYS(complaint("a.off", head + "3\n0 1\n2\n3\n"), "line 9 goes on");
    EXPECT_SAYS(complaint("a.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
                "vertex 1 (line 4) has 2 coordinates where 3 are needed");
    EXPECT_SAYS(complaint("a.off", "OFF\n2 1 0\n0 0\n0\n1 0\n"),
                "vertex 1 (line 5) has 2 coordinates where 3 are needed");
    // Two vertices on a line: the second is taken for a colour, and the numbers do not add up.
    EXPECT_SAYS(complaint("a.off", "OFF\n4 1 0\n0 0 0 1 0 0\n0 1 0 0 0 1\n3 0 1 2\n"),
                "the file ends after 3 of the 4 vertices");
}

TEST_F(MeshFormats, skips_what_else_the_vertices_of_off_have)
{
    for (const char* const keyword : {"COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF", "OFF"})
        expect_tetrahedron(read("a.off", std::string(keyword) +
                                             "\n4 4 0\n0 0 0 9 9 9\n1 0 0 9 9 9 # x\n"
                                             "0 1 0 9 9 9\n0 0 1 9 9 9\n3 0 2 1\n3 0 1 3\n"
                                             "3 0 3 2 1\n3 1 2 3 .5 .5 .5 1\n"));
    for (const char* const keyword : {"4OFF", "nOFF", "OFF4", "off"})
        EXPECT_SAYS(complaint("a.off", std::string(keyword) + "\n4 4 0\n"),
                    "the keyword \"" + std::string(keyword) + "\"");
}

TEST_F(MeshFormats, skips_a_byte_order_mark)
{
    expect_tetrahedron(read("a.obj", std::string(kByteOrderMark) + kObj));
    expect_tetrahedron(read("a.off", std::string(kByteOrderMark) +
                                         "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                         "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
    expect_tetrahedron(read("a.ply", std::string(kByteOrderMark) +
                                         "ply\nformat ascii 1.0\nelement vertex 4\n"
                                         "property float x\nproperty float y\nproperty float z\n"
                                         "element face 4\nproperty list uchar int vertex_indices\n"
                                         "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                         "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
    const ReadResult stl =
        read("a.stl", std::string(kByteOrderMark) +
                          "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                          "vertex 0 1 0\nendloop\nendfacet\nendsolid\n");
    EXPECT_EQ(stl.report.format, "STL (ASCII)");
    EXPECT_EQ(stl.mesh.triangles, (std::vector<Vec3I>{{0, 1, 2}}));
    // In a binary file the same bytes are the header's own.
    write_mesh(folder_ / "b.stl", test::unit_tetrahedron());
    std::string binary = test::read_bytes(folder_ / "b.stl");
    binary.replace(0, 8, std::string(kByteOrderMark) + "solid");
    EXPECT_EQ(read("b.stl", binary).report.format, "STL (binary)");
}

TEST_F(MeshFormats, loses_no_statement_of_obj_that_makes_a_surface)
{
    std::string old = kObj;
    old.replace(old.find("f 1 2 4"), 7, "fo 1 2 4 # an outline");
    expect_tetrahedron(read("old.obj", old));
    expect_tetrahedron(read("c.obj", std::string(kObj) + "# f 1 2 3\nvp 0.5\nl 1 2\np 3\ncsh x\n"));
    const auto expect_refused = [&](const std::string& line, const std::string& words) {
        EXPECT_SAYS(complaint("a.obj", kObj + line + "\n"), "line 9: the keyword " + words);
    };
    expect_refused("F 1 2 3", "\"F\" is in capitals; in OBJ it is \"f\"");
    expect_refused("V 1 2 3", "\"V\" is in capitals");
    expect_refused("FO 1 2 3", "\"FO\" is in capitals");
    expect_refused("v1 2 3", "\"v1\" has no blank");
    expect_refused("f1 2 3", "\"f1\" has no blank");
    expect_refused("v-1 2 3", "\"v-1\" has no blank");
    expect_refused("surf 0 1 0 1 1 2 3 4", "\"surf\" stands for a free-form surface");
    expect_refused("bzp 1 2 3 4", "\"bzp\" stands for a Bezier patch");
    expect_refused("call other.obj", "\"call\" stands for another file");
    EXPECT_SAYS(complaint("a.obj", std::string(kObj) + "f 1 2 0\n"),
                "face 4 (line 9): the vertex index 0 is out of range");
    EXPECT_SAYS(complaint("a.obj", std::string(kObj) + "f 1 2 3#\n"),
                "face 4 (line 9): \"3#\" is not a whole number");
    EXPECT_SAYS(complaint("a.obj", "f 1 2 3\nf 1 2 5\nf 1 2 6\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
                "face 1 (line 2): the vertex index 5 is out of range, the file has 3 vertices");
}

TEST_F(MeshFormats, refuses_bytes_behind_the_facets_of_binary_stl)
{
    write_mesh(folder_ / "b.stl", test::unit_tetrahedron());
    const std::string binary = test::read_bytes(folder_ / "b.stl");
    for (const std::size_t more : {1U, 50U, 200U})
        EXPECT_SAYS(complaint("b.stl", binary + std::string(more, '\0')),
                    "4 facets, which take 284 bytes, but the file has " +
                        std::to_string(284 + more));
}

PolygonSoup cube_soup(const Vec3d& corner, double size)
{
    PolygonSoup soup;
    soup.format = "a format of one's own";
    for (int i = 0; i < 8; ++i)
        soup.points.push_back(corner + size * Vec3d(i & 1, i >> 1 & 1, i >> 2));
    soup.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    soup.polygon_sizes.assign(6, 4);
    return soup;
}

TEST(PolygonSoup, becomes_a_mesh_as_files_do)
{
    const ReadResult result = mesh_of_polygons(cube_soup({0, 0, 0}, 2), "cube");
    EXPECT_EQ(result.report.format, "a format of one's own");
    EXPECT_EQ(result.report.file_vertices, 8U);
    EXPECT_EQ(result.report.file_faces, 6U);
    EXPECT_EQ(result.report.polygons_triangulated, 6U);
    EXPECT_EQ(result.mesh.triangles.size(), 12U);
    EXPECT_DOUBLE_EQ(check_mesh(result.mesh).volume, 8.0);

    // Far away the cube would be flat in float32; about an origin of its own it is not.
    ReadOptions options;
    options.recentre = true;
    const ReadResult far = mesh_of_polygons(cube_soup({1e9, 0, 0}, 0.5), "cube", options);
    EXPECT_DOUBLE_EQ(check_mesh(far.mesh).volume, 0.125);
    EXPECT_NE(far.report.placement.origin[0], 0.0);
}

TEST(PolygonSoup, that_is_no_surface_is_refused)
{
    const auto complaint = [](const PolygonSoup& soup) -> std::string {
        try {
            mesh_of_polygons(soup, "cube");
        } catch (const ReadError& error) {
            return error.what();
        }
        return "nothing was thrown";
    };
    PolygonSoup soup = cube_soup({0, 0, 0}, 1);
    soup.corners[9] = 8;
    EXPECT_SAYS(complaint(soup),
                "cube: face 2: the vertex index 8 is out of range, the file has 8");
    soup = cube_soup({0, 0, 0}, 1);
    soup.points[3][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_SAYS(complaint(soup), "cube: point 3: the coordinate");
    EXPECT_SAYS(complaint(cube_soup({0, 0, 0}, 0)), "none of its 6 faces");
    EXPECT_SAYS(complaint({}), "no faces");
    soup = cube_soup({0, 0, 0}, 1);
    soup.corners.pop_back();
    EXPECT_THROW(mesh_of_polygons(soup, "cube"), InvalidOption);
}

} // namespace
} // namespace vdb_shell

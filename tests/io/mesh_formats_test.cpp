// SPDX-License-Identifier: Apache-2.0
// The less common forms of the mesh formats: docs/mesh_files.md lists what is read and refused.
#include "support/mesh_files.h"
#include "support/shapes.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using test::raw;

const char* const kByteOrderMark = "\xEF\xBB\xBF";

class MeshFormats : public test::MeshFiles
{
};

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

TEST_F(MeshFormats, ids_of_ply_go_with_their_points)
{
    // Vertex 1 is in no triangle; vertex 4 stands where vertex 0 stands.
    const std::string vertices = "0 0 0 70\n9 9 9 5\n1 0 0 -3\n0 1 0 12345678901\n0 0 0 8\n";
    const auto text = [&](const char* property) {
        return std::string("ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\n") +
               "property float y\nproperty float z\nproperty " + property +
               "\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n" + vertices +
               "3 0 2 3\n3 4 3 2\n";
    };
    EXPECT_EQ(read("ids.ply", text("int id")).ids,
              (std::vector<std::int64_t>{70, -3, 12345678901}));
    ReadOptions apart;
    apart.weld = false;
    EXPECT_EQ(read_mesh(folder_ / "ids.ply", apart).ids,
              (std::vector<std::int64_t>{70, -3, 12345678901, 8}));
    // Numbers of another kind are no ids, and neither is another name.
    EXPECT_TRUE(read("real.ply", text("float id")).ids.empty());
    EXPECT_TRUE(read("name.ply", text("int number")).ids.empty());
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

TEST_F(MeshFormats, understands_the_forms_of_off)
{
    expect_tetrahedron(read("a.off",
                            "# first\nOFF 4 4 6 # counts\n\n0 0 0\n1 0 0 # x\n0 1 0\n0 0 1\n"
                            "3 0 2 1 255 0 0\n3 0 1 3\n# between\n3 0 3 2\n3 1 2 3"));
    expect_tetrahedron(read("c.off", "CNOFF\n4 4 0\n0 0 0 0 0 1 255 0 0\n1 0 0 0 0 1 255 0 0\n"
                                     "0 1 0 0 0 1 .5 .5 .5 1\n0 0 1 0 0 1 255 0 0 255\n"
                                     "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
}

TEST_F(MeshFormats, names_what_is_wrong_in_off)
{
    EXPECT_SAYS(complaint("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"), "after 2 of the 3 vertices");
    EXPECT_SAYS(complaint("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
                "after 1 of the 2 faces");
    EXPECT_SAYS(complaint("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
                "face 0 (line 6): the vertex index 3 is out of range, the file has 3 vertices");
    EXPECT_SAYS(complaint("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"),
                "declares 3 corners and has 2");
    EXPECT_SAYS(complaint("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"),
                "line 7 goes on");
    EXPECT_SAYS(complaint("a.off", "OFF\n4000000000 1 0\n"), "4000000000");
    EXPECT_SAYS(complaint("a.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n"),
                "vertex 0 (line 3)");
    EXPECT_SAYS(complaint("a.off", "OFF BINARY\n"), "binary OFF");
    EXPECT_SAYS(complaint("a.off", "4OFF\n"), "\"4OFF\"");
}

TEST_F(MeshFormats, understands_the_forms_of_obj_lines)
{
    const std::string text =
        "# a comment\r\nmtllib none.mtl\r\no thing\r\ng part\r\nvt 1e60 2\r\n"
        "vn 0 0 1\r\nv 0 0 0 1.0\r\n  v 1 0 0 0.5 0.5 0.5\r\nv 0 \\\r\n 1 0\r\n"
        "v 0 0 1\r\ns off\r\nusemtl m\r\nl 1 2\r\np 1\r\nf 1/1/1 3/1 2//1\r\n"
        "f 1 2 4 # a comment\r\nf -4/-1 -1 \\\r\n-2\r\nf 2 3 4";
    const ReadResult result = read("a.obj", text);
    expect_tetrahedron(result);
    EXPECT_EQ(result.report.file_vertices, 4U);
    EXPECT_EQ(result.report.file_faces, 4U);
}

TEST_F(MeshFormats, a_comment_of_obj_ends_with_its_line)
{
    expect_tetrahedron(read("a.obj", "# C:\\meshes\\\nv 0 0 0\nv 1 0 0 # \\\nv 0 1 0\nv 0 0 1\n"
                                     "f 1 3 2\nf 1 2 4 # \\\nf 1 4 3\nf 2 3 4\n"));
}

TEST_F(MeshFormats, a_comment_of_obj_may_touch_the_value_before_it)
{
    expect_tetrahedron(read("a.obj", "v 0 0 0#c\nv 1 0 0#\nv 0 1 0 # c\nv 0 0 1\n"
                                     "f 1 3 2#c\nf 1 2 4# 5\nfo 1 4 3#\nf 2 3 4\n"));
    EXPECT_SAYS(complaint("a.obj", "v 0 0 #c 0\nf 1 1 1\n"), "vertex 0 (line 1) has 2 coordinates");
}

TEST_F(MeshFormats, refuses_a_list_of_ply_whose_length_is_no_whole_number)
{
    const std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                               "property float y\nproperty float z\nelement face 1\n"
                               "property list float int vertex_indices\nend_header\n";
    std::string bytes = header;
    bytes.replace(bytes.find("ascii"), 5, "binary_little_endian");
    const float points[] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, size = 3.5F;
    bytes.append(reinterpret_cast<const char*>(points), sizeof points);
    bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes.append(16, '\0');
    EXPECT_SAYS(complaint("a.ply", bytes), "a list \"vertex_indices\" of 3.5 values");
}

TEST_F(MeshFormats, names_what_is_wrong_in_obj)
{
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_SAYS(complaint("a.obj", vertices + "f 1 2 4\n"),
                "face 0 (line 4): the vertex index 4 is out of range, the file has 3 vertices");
    EXPECT_SAYS(complaint("a.obj", vertices + "f 1 2 0\n"), "index 0 is out of range");
    EXPECT_SAYS(complaint("a.obj", vertices + "f 1 2 -4\n"), "index -4 is out of range");
    EXPECT_SAYS(complaint("a.obj", vertices + "f 1 2 99999999999\n"), "99999999999");
    EXPECT_SAYS(complaint("a.obj", vertices + "f 1 2\n"), "face 0 (line 4) has 2 corners");
    EXPECT_SAYS(complaint("a.obj", vertices + "f 1 2 x\n"), "\"x\" is not a whole number");
    EXPECT_SAYS(complaint("a.obj", vertices + "v 1 2"), "vertex 3 (line 4) has 2 coordinates");
    EXPECT_SAYS(complaint("a.obj", vertices), "no faces (and 3 vertices)");
    for (const char* const word : {"nan", "-inf", "1e39", "3.4028236e38", "1e999"}) {
        const std::string message = complaint("a.obj", vertices + "v 0 " + word + " 0\nf 1 2 3\n");
        EXPECT_SAYS(message, "vertex 3 (line 4)");
        EXPECT_SAYS(message, word);
        EXPECT_SAYS(message, "not finite in float32");
    }
    for (const char* const word : {"1,5", "0x10", "1e", "--1", "+-1", "1.2.3", "abc"})
        EXPECT_SAYS(complaint("a.obj", vertices + "v 0 " + word + " 0\nf 1 2 3\n"),
                    "is not a number");
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

TEST_F(MeshFormats, refuses_utf_16)
{
    for (const char* const file : {"a.obj", "a.off", "a.ply"})
        for (const char* const mark : {"\xFE\xFF", "\xFF\xFE"})
            EXPECT_SAYS(complaint(file, std::string(mark) + std::string("\0v\0 \0001", 6)),
                        "UTF-16");
}

TEST_F(MeshFormats, skips_a_byte_order_mark)
{
    expect_tetrahedron(read("a.obj", std::string(kByteOrderMark) + test::kTetrahedronObj));
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
    std::string old = test::kTetrahedronObj;
    old.replace(old.find("f 1 2 4"), 7, "fo 1 2 4 # an outline");
    expect_tetrahedron(read("old.obj", old));
    expect_tetrahedron(read("c.obj", std::string(test::kTetrahedronObj) +
                                         "# f 1 2 3\nvp 0.5\nl 1 2\np 3\ncsh x\n"));
    const auto expect_refused = [&](const std::string& line, const std::string& words) {
        EXPECT_SAYS(complaint("a.obj", test::kTetrahedronObj + line + "\n"),
                    "line 9: the keyword " + words);
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
    EXPECT_SAYS(complaint("a.obj", std::string(test::kTetrahedronObj) + "f 1 2 0\n"),
                "face 4 (line 9): the vertex index 0 is out of range");
    EXPECT_SAYS(complaint("a.obj", "f 1 2 3\nf 1 2 5\nf 1 2 6\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"),
                "face 1 (line 2): the vertex index 5 is out of range, the file has 3 vertices");
}

TEST_F(MeshFormats, normals_of_tiny_facets_of_binary_stl_have_length_1)
{
    // Products of edges so short are below what OpenVDB's normalize() takes for nothing.
    write_mesh(folder_ / "b.stl", test::icosphere(1e-5, 1));
    const std::string bytes = test::read_bytes(folder_ / "b.stl");
    ASSERT_GT(bytes.size(), 84u);
    for (std::size_t at = 84; at < bytes.size(); at += 50) {
        openvdb::Vec3s normal;
        std::memcpy(normal.asPointer(), bytes.data() + at, sizeof(normal));
        EXPECT_NEAR(normal.length(), 1, 1e-6);
    }
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

} // namespace
} // namespace vdb_shell

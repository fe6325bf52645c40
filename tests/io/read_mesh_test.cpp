// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/io/read_mesh.h"

#include "support/mesh_files.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;
using test::raw;

const char* const kExtensions[] = {".obj", ".ply", ".off", ".stl"};

const char* const kOff = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                         "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
const char* const kPly = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty "
                         "float y\nproperty float z\n"
                         "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                         "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string text_stl(const TriangleMesh& mesh)
{
    std::string text = "solid a name of words\n";
    for (const Vec3I& t : mesh.triangles) {
        text += "  facet normal nan 0 0\n    outer loop\n";
        for (int k = 0; k < 3; ++k) {
            const Vec3s& p = mesh.points[t[k]];
            text += "      vertex " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
                    std::to_string(p[2]) + "\n";
        }
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid a name of words\n";
}

class ReadMesh : public test::MeshFiles
{
};

void expect_same(const TriangleMesh& a, const TriangleMesh& b)
{
    ASSERT_EQ(a.points.size(), b.points.size());
    ASSERT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vec3s)), 0);
}

TEST_F(ReadMesh, gives_the_tetrahedron_of_every_format)
{
    const TriangleMesh wanted = test::unit_tetrahedron();
    expect_same(read("a.obj", test::kTetrahedronObj).mesh, wanted);
    expect_same(read("a.OFF", kOff).mesh, wanted);
    const ReadResult ply = read("a.ply", kPly);
    expect_same(ply.mesh, wanted);
    EXPECT_EQ(ply.report.format, "PLY (ASCII)");
    const ReadResult stl = read("a.stl", text_stl(wanted));
    EXPECT_EQ(stl.report.format, "STL (ASCII)");
    EXPECT_EQ(stl.report.file_vertices, 12U);
    EXPECT_EQ(stl.report.file_faces, 4U);
    EXPECT_EQ(stl.report.welded_vertices, 8U);
    EXPECT_EQ(stl.mesh.points.size(), 4U);
    EXPECT_NEAR(check_mesh(stl.mesh).volume, 1.0 / 6, 1e-12);
}

TEST_F(ReadMesh, gives_back_what_was_written_bit_for_bit)
{
    TriangleMesh mesh = test::icosphere(1, 2);
    const float odd[] = {
        1e18F, std::numeric_limits<float>::min(), -0.0F, 0.1F, 16777217.0F, -1e-30F, 1.0F / 3.0F};
    for (std::size_t i = 0; i < std::size(odd); ++i)
        mesh.points[i][1] = odd[i];
    for (const char* const extension : {".obj", ".ply", ".off"}) {
        SCOPED_TRACE(extension);
        const std::filesystem::path path = folder_ / (std::string("sphere") + extension);
        write_mesh(path, mesh);
        expect_same(read_mesh(path, {false}).mesh, mesh);
        expect_same(read_mesh(path).mesh, mesh);
    }
    write_mesh(folder_ / "sphere.stl", mesh);
    const TriangleMesh stl = read_mesh(folder_ / "sphere.stl").mesh;
    ASSERT_EQ(stl.points.size(), mesh.points.size());
    ASSERT_EQ(stl.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const Vec3s &a = stl.points[stl.triangles[t][k]],
                        &b = mesh.points[mesh.triangles[t][k]];
            EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << a << b;
        }
}

TEST_F(ReadMesh, keeps_subnormal_coordinates)
{
    TriangleMesh mesh = test::unit_tetrahedron();
    mesh.points[0] = Vec3s(1e-40F, -std::numeric_limits<float>::denorm_min(), 0);
    for (const char* const extension : {".obj", ".ply", ".off"}) {
        const std::filesystem::path path = folder_ / (std::string("tiny") + extension);
        write_mesh(path, mesh);
        expect_same(read_mesh(path).mesh, mesh);
    }
}

TEST_F(ReadMesh, rounds_text_to_the_nearest_float_once)
{
    // The second lies so near the middle of two floats that rounding to double first goes wrong.
    const char* const words[] = {"0.1", "1.00000005960464477540", "+9.9999998e17", "1e-46", ".5",
                                 "7."};
    for (const char* const word : words) {
        const std::string text = std::string("v ") + word + " 0 0\nv 1 5 0\nv 0 1 0\nf 1 2 3\n";
        EXPECT_EQ(read("a.obj", text).mesh.points.at(0)[0], std::strtof(word, nullptr)) << word;
    }
}

TEST_F(ReadMesh, refuses_what_is_no_mesh_file)
{
    EXPECT_SAYS(complaint("missing.obj"), "no such file");
    for (const char* const extension : kExtensions)
        EXPECT_SAYS(complaint(std::string("a") + extension, ""), "empty");
    EXPECT_SAYS(complaint("a.xyz", test::kTetrahedronObj), "\".xyz\"");
    std::filesystem::create_directory(folder_ / "folder.obj");
    EXPECT_SAYS(complaint("folder.obj"), "folder");
    EXPECT_SAYS(complaint("a.stl", "nonsense"), "8 bytes");
    EXPECT_SAYS(complaint("a.off", "OOF\n"), "\"OOF\"");
    EXPECT_SAYS(complaint("a.ply", "plum\n"), "\"ply\"");
}

TEST_F(ReadMesh, welds_equal_positions_and_says_so)
{
    const std::string text = "v 0 0 0\nv 9 9 9\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\nv 0 -1 0\n"
                             "f 1 3 4\nf 6 5 7\nf 1 5 4\n";
    const ReadResult welded = read("a.obj", text);
    EXPECT_EQ(welded.report.welded_vertices, 2U);
    EXPECT_EQ(welded.report.unused_vertices, 1U);
    EXPECT_EQ(welded.report.skipped_faces, (std::vector<std::size_t>{2}));
    EXPECT_EQ(welded.mesh.points.size(), 4U);
    EXPECT_EQ(welded.mesh.triangles, (std::vector<Vec3I>{{0, 1, 2}, {1, 0, 3}}));

    const ReadResult plain = read("a.obj", text, {false});
    EXPECT_EQ(plain.report.welded_vertices, 0U);
    EXPECT_EQ(plain.mesh.points.size(), 6U);
    EXPECT_EQ(plain.mesh.triangles.size(), 3U);
}

TEST_F(ReadMesh, keeps_duplicate_and_non_manifold_faces)
{
    const std::string text =
        std::string(test::kTetrahedronObj) + "f 1 3 2\nf 2 3 1\nf 1 1 2\nf 1 2 1 3\n";
    const ReadResult result = read("a.obj", text);
    EXPECT_EQ(result.report.file_faces, 8U);
    EXPECT_EQ(result.report.skipped_faces, (std::vector<std::size_t>{6}));
    EXPECT_EQ(result.mesh.triangles.size(), 8U) << "the last face is a sheet of two triangles";
    for (const Vec3I& t : result.mesh.triangles)
        EXPECT_TRUE(t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
}

double area(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const Vec3I& t : mesh.triangles) {
        const openvdb::Vec3d a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
        sum += 0.5 * (b - a).cross(c - a).length();
    }
    return sum;
}

TEST_F(ReadMesh, triangulates_polygons_without_folds)
{
    // An arrow head, from each of its corners; then an L; then a square with a bridged square hole.
    const char* const corners[] = {"1 2 3 4", "2 3 4 1", "3 4 1 2", "4 1 2 3", "4 3 2 1"};
    for (const char* const face : corners) {
        const ReadResult arrow =
            read("a.obj", std::string("v 0 0 1\nv 4 2 1\nv 0 4 1\nv 1 2 1\nf ") + face + "\n");
        EXPECT_EQ(arrow.report.polygons_triangulated, 1U);
        EXPECT_DOUBLE_EQ(area(arrow.mesh), 6.0) << face;
    }
    const ReadResult l = read("l.off", "OFF\n6 1 0\n0 0 0\n0 2 0\n0 2 1\n0 1 1\n0 1 2\n0 0 2\n"
                                       "6 0 1 2 3 4 5\n");
    EXPECT_DOUBLE_EQ(area(l.mesh), 3.0);
    EXPECT_EQ(l.mesh.triangles.size(), 4U);
    const ReadResult ring =
        read("r.off", "OFF\n8 1 0\n0 0 0\n4 0 0\n4 4 0\n0 4 0\n1 1 0\n3 1 0\n3 3 0\n1 3 0\n"
                      "10 0 1 2 3 0 4 7 6 5 4\n");
    EXPECT_DOUBLE_EQ(area(ring.mesh), 12.0);
    EXPECT_TRUE(ring.report.skipped_faces.empty());
}

TEST_F(ReadMesh, says_where_the_triangles_of_each_face_begin)
{
    const std::string points = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 6 0\n";
    // The second face has two different corners and is left out.
    const ReadResult mixed = read("m.obj", points + "f 1 2 3\nf 1 1 2\nf 1 2 3 5 4\nf 1 3 2\n");
    EXPECT_EQ(mixed.first_triangles, (std::vector<std::uint32_t>{0, 1, 4}));
    EXPECT_EQ(mixed.mesh.triangles.size(), 5U);
    EXPECT_TRUE(read("t.obj", points + "f 1 2 3\nf 1 3 2\n").first_triangles.empty());
}

TEST_F(ReadMesh, survives_a_polygon_of_very_many_corners)
{
    std::string text, face = "f";
    const int n = 50000;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * M_PI * i / n, radius = i % 2 ? 1.0 : 0.5;
        text += "v " + std::to_string(radius * std::cos(angle)) + " " +
                std::to_string(radius * std::sin(angle)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    EXPECT_EQ(read("star.obj", text + face + "\n", {false}).mesh.triangles.size(), n - 2U);
}

/// The tetrahedron with a list, a colour and another element that readers have to step over.
std::string rich_ply(bool big_endian)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    std::string text =
        std::string("ply\r\nformat ") +
        (big_endian ? "binary_big_endian" : "binary_little_endian") +
        " 1.0\r\ncomment element vertex 7\r\nobj_info element of nothing\r\n"
        "Created by Blender3D 247 - www.blender.org, source file: element\r\n"
        "element note 2\r\nproperty list ushort short words\r\nproperty uchar kind\r\n"
        "element face 4\r\nproperty uchar red\r\nproperty list int float uv\r\n"
        "property list uint uint vertex_index\r\n"
        "element vertex 4\r\nproperty double z\r\nproperty list uchar double spare\r\n"
        "property double x\r\nproperty float32 nx\r\nproperty double y\r\n"
        "element edge 1\r\nproperty int a\r\nend_header\r\n";
    auto add = [&](auto value) { text += raw(value, big_endian); };
    for (int note = 0; note < 2; ++note) {
        add(std::uint16_t(2)), add(std::int16_t(-1)), add(std::int16_t(7));
        add(std::uint8_t(1));
    }
    for (const Vec3I& t : mesh.triangles) {
        add(std::uint8_t(255)), add(std::int32_t(1)), add(0.5F), add(std::uint32_t(3));
        for (int k = 0; k < 3; ++k)
            add(t[k]);
    }
    for (const Vec3s& p : mesh.points)
        add(double(p[2])), add(std::uint8_t(1)), add(1e300), add(double(p[0])), add(1.0F),
            add(double(p[1]));
    add(std::int32_t(3));
    return text;
}

TEST_F(ReadMesh, steps_over_what_else_a_ply_file_holds)
{
    for (const bool big_endian : {false, true}) {
        const ReadResult result = read("a.ply", rich_ply(big_endian));
        expect_same(result.mesh, test::unit_tetrahedron());
        EXPECT_EQ(result.report.format, "PLY (binary)");
        EXPECT_EQ(result.report.file_faces, 4U);
    }
    const ReadResult text =
        read("t.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty list uchar float w\n"
                      "property int x\nproperty int y\nproperty double z\nelement face 1\n"
                      "property list uchar float uv\nproperty list uchar int vertex_indices\n"
                      "property list uchar int rest\nend_header\n"
                      "0 0 0 0.1\n2 7 7 1 0 0\n0 0 1 0\n1 0.5 3 0 1 2 0\n");
    EXPECT_EQ(text.mesh.points[0][2], 0.1F);
    EXPECT_EQ(text.mesh.triangles, (std::vector<Vec3I>{{0, 1, 2}}));
}

TEST_F(ReadMesh, names_what_is_wrong_in_ply)
{
    const std::string head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                             "property float y\nproperty float z\nelement face 1\n"
                             "property list uchar int vertex_indices\nend_header\n";
    const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_SAYS(complaint("a.ply", head + points + "3 0 1 3\n"),
                "face 0 (line 13): the vertex index 3 is out of range, the file has 3 vertices");
    EXPECT_SAYS(complaint("a.ply", head + points + "3 0 1 -1\n"), "index -1 is out of range");
    EXPECT_SAYS(complaint("a.ply", head + points + "3 0 1"), "the file ends in face 0");
    EXPECT_SAYS(complaint("a.ply", head + points + "2 0 1\n"), "2 corners");
    EXPECT_SAYS(complaint("a.ply", head + points + "200 0 1 2\n"), "200");
    EXPECT_SAYS(complaint("a.ply", head + points + "3 0 1 2\n3 0 1 2\n"), "goes on");
    EXPECT_SAYS(complaint("a.ply", head + "0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n"),
                "vertex 1 (line 11)");
    EXPECT_SAYS(complaint("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n"), "end_header");
    std::string many = head;
    many.replace(many.find("vertex 3"), 8, "vertex 2000000000");
    EXPECT_SAYS(complaint("a.ply", many + points), "2000000000");
    many.replace(many.find("2000000000"), 10, "99999999999");
    EXPECT_SAYS(complaint("a.ply", many + points), "99999999999");
    std::string far = rich_ply(false);
    far.replace(far.find(raw(1.0)), 8, raw(1e39));
    EXPECT_SAYS(complaint("a.ply", far), "not finite in float32");
}

TEST_F(ReadMesh, understands_the_forms_of_stl)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    const std::string one = text_stl(mesh);
    const ReadResult two = read("two.stl", one + text_stl(test::translated(mesh, {5, 0, 0})));
    EXPECT_EQ(two.report.file_faces, 8U);
    EXPECT_EQ(two.mesh.points.size(), 8U);

    write_mesh(folder_ / "b.stl", mesh);
    std::string binary = test::read_bytes(folder_ / "b.stl");
    binary.replace(0, 14, "solid facet no");
    const ReadResult solid = read("b.stl", binary);
    EXPECT_EQ(solid.report.format, "STL (binary)");
    EXPECT_EQ(solid.mesh.triangles.size(), 4U);

    // A facet of which two corners coincide.
    std::copy_n(binary.begin() + 84 + 12, 12, binary.begin() + 84 + 24);
    EXPECT_EQ(read("d.stl", binary).report.skipped_faces, (std::vector<std::size_t>{0}));
}

TEST_F(ReadMesh, names_what_is_wrong_in_stl)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    write_mesh(folder_ / "b.stl", mesh);
    const std::string binary = test::read_bytes(folder_ / "b.stl");
    EXPECT_SAYS(complaint("b.stl", binary.substr(0, binary.size() - 1)), "4 facets");
    EXPECT_SAYS(complaint("b.stl", binary + "x"), "285");
    std::string bad = binary;
    bad.replace(84 + 50 + 12, 4, raw(std::numeric_limits<float>::infinity()));
    EXPECT_SAYS(complaint("b.stl", bad), "face 1");
    const std::string text = text_stl(mesh);
    EXPECT_SAYS(complaint("t.stl", text.substr(0, text.find("endsolid"))), "without endsolid");
    EXPECT_SAYS(complaint("t.stl", text.substr(0, text.rfind("endfacet"))), "\"endfacet\"");
    std::string nan = text;
    nan.replace(nan.find("vertex ") + 7, 8, "nan     ");
    EXPECT_SAYS(complaint("t.stl", nan), "face 0 (line 4)");
    EXPECT_SAYS(complaint("t.stl", "solid\nendsolid\n"), "no faces");
}

TEST_F(ReadMesh, never_takes_a_cut_or_spoilt_file_amiss)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    write_mesh(folder_ / "b.stl", mesh);
    write_mesh(folder_ / "b.ply", mesh);
    const std::pair<const char*, std::string> files[] = {
        {"a.obj", test::kTetrahedronObj},
        {"a.off", kOff},
        {"a.ply", kPly},
        {"b.ply", test::read_bytes(folder_ / "b.ply")},
        {"c.ply", rich_ply(true)},
        {"a.stl", text_stl(mesh)},
        {"b.stl", test::read_bytes(folder_ / "b.stl")}};
    auto try_to_read = [&](const char* name, const std::string& bytes) {
        try {
            const ReadResult result = read(name, bytes);
            for (const Vec3I& t : result.mesh.triangles)
                for (int k = 0; k < 3; ++k)
                    ASSERT_LT(t[k], result.mesh.points.size());
            for (const Vec3s& p : result.mesh.points)
                ASSERT_TRUE(p.isFinite());
            ASSERT_LE(result.report.skipped_faces.size(), result.report.file_faces);
        } catch (const ReadError&) {
        }
    };
    for (const auto& [name, bytes] : files) {
        SCOPED_TRACE(name);
        for (std::size_t length = 0; length < bytes.size(); ++length)
            try_to_read(name, bytes.substr(0, length));
        for (std::size_t at = 0; at < bytes.size(); at += 11)
            for (const char spoilt : {'\0', '\xff', '9', ' ', '\n'}) {
                std::string changed = bytes;
                changed[at] = spoilt;
                try_to_read(name, changed);
            }
    }
}

TEST_F(ReadMesh, prints_nothing)
{
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    read("a.ply", rich_ply(true));
    complaint("a.ply", rich_ply(true).substr(0, 200));
    complaint("a.off", "OFF\n");
    read("a.obj", std::string("mtllib gone.mtl\nusemtl gone\nvt 1e60 0\n") + test::kTetrahedronObj);
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(ReadMesh, writes_nothing_but_what_it_can)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    EXPECT_THROW(write_mesh(folder_ / "a.xyz", mesh), InvalidOption);
    EXPECT_THROW(write_mesh(folder_ / "missing/a.obj", mesh), WriteError);
}

} // namespace
} // namespace vdb_shell

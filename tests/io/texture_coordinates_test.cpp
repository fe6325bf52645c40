// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/io/texture_coordinates.h"

#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_mesh.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <string>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;

TextureCoordinates read(const std::string& file, const std::string& bytes,
                        const Placement& placement = {})
{
    const test::TemporaryFolder folder;
    test::write_bytes(folder / file, bytes);
    return read_texture_coordinates(folder / file, placement);
}

std::string refusal(const std::string& file, const std::string& bytes)
{
    return test::complaint_of([&] { read(file, bytes); });
}

/// A unit cube of quads, all corners of a face in the plane of two axes: (u, v) are these two
/// coordinates plus ten times the number of the face, so that every face is a chart of its own.
struct Cube {
    static constexpr int kQuads[6][4] = {{1, 4, 3, 2}, {5, 6, 7, 8}, {1, 2, 6, 5},
                                         {2, 3, 7, 6}, {3, 4, 8, 7}, {4, 1, 5, 8}};
    static constexpr int kAxes[6][2] = {{0, 1}, {0, 1}, {0, 2}, {1, 2}, {0, 2}, {1, 2}};
    static constexpr double kPoints[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                             {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};

    static Vec2d uv(int face, int vertex)
    {
        const double* p = kPoints[vertex - 1];
        return {p[kAxes[face][0]] + 10 * face, p[kAxes[face][1]]};
    }
};

std::string cube_obj(bool texture_last = false)
{
    std::string points, texture, faces;
    for (const auto& p : Cube::kPoints)
        points += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " +
                  std::to_string(p[2]) + "\n";
    for (int f = 0; f < 6; ++f) {
        faces += "f";
        for (int k = 0; k < 4; ++k) {
            const Vec2d uv = Cube::uv(f, Cube::kQuads[f][k]);
            texture += "vt " + std::to_string(uv[0]) + " " + std::to_string(uv[1]) + "\n";
            faces += " " + std::to_string(Cube::kQuads[f][k]) + "/" +
                     std::to_string(4 * f + k + 1) + (f % 2 ? "/1" : "");
        }
        faces += "\n";
    }
    return points + (texture_last ? faces + texture : texture + faces);
}

/// Every corner of every triangle has the texture coordinates of its place on its face.
void expect_cube(const TextureCoordinates& cube)
{
    ASSERT_EQ(cube.mesh.triangles.size(), 12U);
    ASSERT_EQ(cube.corner.size(), 12U);
    for (std::size_t t = 0; t < 12; ++t) {
        const int face = int(t / 2);
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3s& p = cube.mesh.points[cube.mesh.triangles[t][k]];
            const Vec2d expected(double(p[Cube::kAxes[face][0]]) + 10 * face,
                                 p[Cube::kAxes[face][1]]);
            EXPECT_EQ(cube.corner[t][std::size_t(k)], expected) << t << " " << k;
        }
    }
}

TEST(TextureCoordinates, OfAnObjStandAtTheCornersOfItsFaces)
{
    expect_cube(read("cube.obj", cube_obj()));
}

TEST(TextureCoordinates, OfAnObjMayFollowTheFaces)
{
    expect_cube(read("cube.obj", cube_obj(true)));
}

TEST(TextureCoordinates, NegativeNumbersCountBack)
{
    const TextureCoordinates made = read(
        "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 9 9\nvt .25\nvt 1 0\nvt 0 1 5\nf 1/-3 2/-2 3/-1\n");
    EXPECT_EQ(made.corner[0][0], Vec2d(0.25, 0));
    EXPECT_EQ(made.corner[0][1], Vec2d(1, 0));
    EXPECT_EQ(made.corner[0][2], Vec2d(0, 1));
}

TEST(TextureCoordinates, TheMeshIsThatOfReadMesh)
{
    // Repeats, corners that weld, a face that is none, a point twice in a face, unused points.
    const std::string bytes =
        "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv 2 0 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 2 0\n"
        "f 2/1 3/2 3/2\nf 2/1 3/2 4/3 4/3 5/4\nf 3/2 7/5 4/3\nf 6/1 4/3 5/4\nf 2/1 6/1 5/4\n";
    const test::TemporaryFolder folder;
    test::write_bytes(folder / "a.obj", bytes);
    const TriangleMesh mesh = read_mesh(folder / "a.obj").mesh;
    const TextureCoordinates made = read_texture_coordinates(folder / "a.obj");
    EXPECT_EQ(made.mesh.points, mesh.points);
    EXPECT_EQ(made.mesh.triangles, mesh.triangles);
    ASSERT_EQ(made.corner.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < made.corner.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3s& p = mesh.points[mesh.triangles[t][k]];
            EXPECT_EQ(made.corner[t][std::size_t(k)], Vec2d(p[0], p[1]));
        }
}

TEST(TextureCoordinates, StandInThePlacementThatIsAskedFor)
{
    const std::string bytes = "v 1000000.25 0 0\nv 1000001 0 0\nv 1000000 1 0\n"
                              "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
    const Placement placement{{1000000, 0, 0}, 0.5};
    EXPECT_EQ(read("a.obj", bytes, placement).mesh.points[0], openvdb::Vec3s(0.5f, 0, 0));
}

std::string cube_ply(const std::string& vertex_names, bool by_face)
{
    // A vertex for each corner of each face, as PLY has no corners of its own.
    std::string header = "ply\nformat ascii 1.0\nelement vertex 24\nproperty float x\n"
                         "property float y\nproperty float z\n",
                vertices, faces;
    if (!by_face)
        for (const std::string& name : {vertex_names.substr(0, vertex_names.find(' ')),
                                        vertex_names.substr(vertex_names.find(' ') + 1)})
            header += "property float " + name + "\n";
    header += "element face 6\nproperty list uchar int vertex_indices\n";
    if (by_face)
        header += "property list uchar float texcoord\n";
    for (int f = 0; f < 6; ++f) {
        faces += "4";
        for (int k = 0; k < 4; ++k)
            faces += " " + std::to_string(4 * f + k);
        if (by_face)
            faces += " 8";
        for (int k = 0; k < 4; ++k) {
            const int v = Cube::kQuads[f][k];
            for (const double x : Cube::kPoints[v - 1])
                vertices += std::to_string(x) + " ";
            const Vec2d uv = Cube::uv(f, v);
            (by_face ? faces : vertices) +=
                " " + std::to_string(uv[0]) + " " + std::to_string(uv[1]);
            vertices += "\n";
        }
        faces += "\n";
    }
    return header + "end_header\n" + vertices + faces;
}

TEST(TextureCoordinates, OfAPlyStandAtVerticesOrFaces)
{
    for (const char* names : {"u v", "s t", "texture_u texture_v", "texture_s texture_t"})
        expect_cube(read("cube.ply", cube_ply(names, false)));
    expect_cube(read("cube.ply", cube_ply("", true)));
}

TEST(TextureCoordinates, OfABinaryPlyAreTheSame)
{
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 3\n"
                        "property float x\nproperty float y\nproperty float z\n"
                        "property double s\nproperty float t\nelement face 1\n"
                        "property list uchar int vertex_index\nend_header\n";
    const auto add = [&](const auto& value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes.append(raw, sizeof value);
    };
    for (const int v : {0, 1, 2}) {
        add(float(v == 1)), add(float(v == 2)), add(0.0f);
        add(0.1 * v), add(float(v));
    }
    add(std::uint8_t(3));
    for (const std::int32_t v : {0, 1, 2})
        add(v);
    const TextureCoordinates made = read("a.ply", bytes);
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(made.corner[0][std::size_t(k)][0], 0.1 * k, 1e-7);
        EXPECT_EQ(made.corner[0][std::size_t(k)][1], k);
    }
}

TEST(TextureCoordinates, AreRefusedWhereThereAreNone)
{
    const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
    const auto says = [](const std::string& text, const std::string& words) {
        EXPECT_NE(text.find(words), std::string::npos) << text;
    };
    says(refusal("a.obj", points + "f 1 2 3\n"), "a.obj: it has no texture coordinates");
    says(refusal("a.obj", points + "f 1//1 2//1 3//1\n"), "it has no texture coordinates");
    says(refusal("a.obj", points + "f 1/1 2/2 3/3\nf 2/2 4 3/3\n"),
         "face 1 has no texture coordinates, though others have");
    says(refusal("a.obj", points + "f 1/1 2/2 3/4\n"), "there is no texture coordinate 4");
    says(refusal("a.obj", points + "f 1/1 2/2 3/-4\n"), "there is no texture coordinate -4");
    says(refusal("a.obj", points + "f 1/1 2/2 3/0\n"), "there is no texture coordinate 0");
    says(refusal("a.obj", "vt nan 0\n" + points + "f 1/1 2/2 3/3\n"), "nan");
    says(refusal("a.obj", "vt\n" + points + "f 1/1 2/2 3/3\n"), "has no number");
    says(refusal("a.stl", ""), "read from .obj and .ply, not from \".stl\"");
    says(refusal("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nproperty float u\nelement face 1\n"
                          "property list uchar int vertex_index\nend_header\n"
                          "0 0 0 1\n1 0 0 1\n0 1 0 1\n3 0 1 2\n"),
         "it has no texture coordinates");
    std::string short_list = cube_ply("", true);
    short_list.replace(short_list.rfind(" 8 "), 3, " 7 ");
    says(refusal("a.ply", short_list.substr(0, short_list.rfind(' ')) + "\n"),
         "has 7 numbers of texture coordinates for 4 corners");
}

TEST(TextureCoordinates, OfASoupAreCountedByCorner)
{
    PolygonSoup soup{"soup", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 3}, {4}, {}};
    const std::vector<Vec2d> uv{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    const TextureCoordinates made = texture_of_polygons(soup, uv, "soup");
    ASSERT_EQ(made.corner.size(), 2U);
    for (std::size_t t = 0; t < 2; ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(made.corner[t][std::size_t(k)], uv[made.mesh.triangles[t][k]]);
    EXPECT_THROW(texture_of_polygons(soup, {{0, 0}}, "soup"), InvalidOption);
}

TEST(TextureCoordinates, FacesThatTheMeshLeavesOutHaveNone)
{
    // Pairs of points in one place. The first face repeats all of its corners, so the mesh has no
    // triangle of it, though merged first it would have one. Found by the fuzzer.
    const TextureCoordinates texture = read("pairs.obj", "v 0 0 0\nv 0 0 0\nv 1 0 0\nv 1 0 0\n"
                                                         "v 0 1 0\nv 0 1 0\nv 0 0 1\n"
                                                         "vt 0 0\nvt 1 0\nvt 0 1\n"
                                                         "f 1/1 2/1 1/1 2/1 3/1 4/1 3/1 4/1 5/1 "
                                                         "6/1 5/1 6/1\nf 1/1 3/2 7/3\n");
    ASSERT_EQ(texture.mesh.triangles.size(), 1U);
    ASSERT_EQ(texture.corner.size(), 1U);
    EXPECT_EQ(texture.corner[0][0], Vec2d(0, 0));
    EXPECT_EQ(texture.corner[0][1], Vec2d(1, 0));
    EXPECT_EQ(texture.corner[0][2], Vec2d(0, 1));
}

} // namespace
} // namespace vdb_shell

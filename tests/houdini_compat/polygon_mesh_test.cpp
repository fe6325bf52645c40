// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/houdini/polygon_mesh.h"

#include "vdb_shell/core/error.h"

#include "houdini_compat/geometries.h"
#include "support/files.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

namespace vdb_shell::houdini
{
namespace
{

/// A unit cube of quads, clockwise seen from outside, as Houdini has them.
const char* const kCubeIndices = "[0,1,2,3, 7,6,5,4, 0,4,5,1, 1,5,6,2, 2,6,7,3, 3,7,4,0]";
const char* const kCubePoints = "[0,0,0],[1,0,0],[1,1,0],[0,1,0],[0,0,1],[1,0,1],[1,1,1],[0,1,1]";
const char* const kNewRun =
    R"([["type","Polygon_run"],["startvertex",0,"nprimitives",6,"nvertices_rle",[4,6]]])";

std::string cube(const std::string& primitives, const std::string& points = kCubePoints,
                 const std::string& size = "3", const std::string& storage = "fpreal32")
{
    return "[\"fileversion\",\"18\",\"pointcount\",8,\"vertexcount\",24,\"primitivecount\",6,"
           "\"topology\",[\"pointref\",[\"indices\"," +
           std::string(kCubeIndices) +
           "]],\"attributes\",[\"pointattributes\",[[[\"type\",\"numeric\",\"name\",\"P\"],"
           "[\"size\"," +
           size + ",\"storage\",\"" + storage + "\",\"values\",[\"size\"," + size +
           ",\"tuples\",[" + points + "]]]]]],\"primitives\",[" + primitives + "]]";
}

ReadResult mesh_of(const std::string& text, const ReadOptions& options = {})
{
    return polygon_mesh(parse_geometry(text, "cube.geo"), "cube.geo", options);
}

void expect_refusal(const std::string& text, const std::string& words)
{
    try {
        mesh_of(text);
        ADD_FAILURE() << "was read, expected: " << words;
    } catch (const ReadError& error) {
        EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).rfind("cube.geo", 0), 0u) << error.what();
    }
}

/// Six quads, a vertex each after the other, as `one` puts a quad's four vertices.
template <typename One> std::string six(const One& one)
{
    std::string text;
    for (int quad = 0; quad < 6; ++quad) {
        std::string vertices = "[";
        for (int k = 0; k < 4; ++k)
            vertices += (k ? "," : "") + std::to_string(4 * quad + k);
        text += (quad ? "," : "") + one(vertices + "]");
    }
    return text;
}

TEST(PolygonMesh, OldAndNewPolygonsAreTheSameCube)
{
    const std::string old_run =
        R"([["type","run","runtype","Poly","varyingfields",["vertex"],"uniformfields",{"closed":true}],[)" +
        six([](const std::string& v) { return "[" + v + "]"; }) + "]]";
    const std::string varied_run =
        R"([["type","run","runtype","Poly","varyingfields",["closed","vertex"],"uniformfields",{}],[)" +
        six([](const std::string& v) { return "[true," + v + "]"; }) + "]]";
    const std::string single = six([](const std::string& v) {
        return R"([["type","Poly"],["vertex",)" + v + R"(,"closed",true]])";
    });
    const std::string listed =
        R"([["type","p_r"],["s_v",0,"n_p",2,"n_v",[4,4]]],[["type","p_r"],["s_v",8,"n_p",4,"r_v",[4,4]]])";
    for (const std::string& primitives :
         {std::string(kNewRun), old_run, varied_run, single, listed}) {
        const ReadResult read = mesh_of(cube(primitives));
        EXPECT_EQ(read.report.format, "Houdini geometry (text)");
        EXPECT_EQ(read.report.file_vertices, 8u);
        EXPECT_EQ(read.report.file_faces, 6u);
        EXPECT_EQ(read.report.polygons_triangulated, 6u);
        ASSERT_EQ(read.mesh.triangles.size(), 12u) << primitives;
        EXPECT_DOUBLE_EQ(signed_volume(read.mesh.points, read.mesh.triangles), 1.0) << primitives;
    }
}

TEST(PolygonMesh, PositionsMayBeDoublesOrHaveAWeightOfOne)
{
    EXPECT_EQ(mesh_of(cube(kNewRun, kCubePoints, "3", "fpreal64")).mesh.points.size(), 8u);
    const std::string weighted = "[0,0,0,1],[1,0,0,1],[1,1,0,1],[0,1,0,1],[0,0,1,1],[1,0,1,1],"
                                 "[1,1,1,1],[0,1,1,1]";
    const ReadResult read = mesh_of(cube(kNewRun, weighted, "4"));
    EXPECT_DOUBLE_EQ(signed_volume(read.mesh.points, read.mesh.triangles), 1.0);
    expect_refusal(cube(kNewRun, weighted.substr(0, weighted.size() - 2) + "2]", "4"),
                   "point 7: P has the weight 2");
    expect_refusal(cube(kNewRun, "[1e300" + std::string(kCubePoints).substr(2), "3", "fpreal64"),
                   "point 0");
}

TEST(PolygonMesh, SkipsFacesWithoutThreeCornersAndSaysSo)
{
    std::string text = cube(kNewRun);
    text.replace(text.find("[0,1,2,3,"), 9, "[0,0,2,2,");
    const ReadResult read = mesh_of(text);
    EXPECT_EQ(read.report.skipped_faces, std::vector<std::size_t>{0});
    EXPECT_EQ(read.mesh.triangles.size(), 10u);
}

TEST(PolygonMesh, WeldsOnRequest)
{
    const TriangleMesh two =
        test::joined(test::box({0, 0, 0}, {1, 1, 1}), test::box({0, 0, 0}, {1, 1, 1}));
    ReadGeometry read;
    read.geometry.points = two.points.size();
    std::vector<float> p;
    for (const openvdb::Vec3s& point : two.points)
        p.insert(p.end(), {point[0], point[1], point[2]});
    read.geometry.point_attributes = {{"P", 3, "point", p}};
    for (const openvdb::Vec3I& t : two.triangles) {
        read.geometry.vertex_point.insert(read.geometry.vertex_point.end(), {t[0], t[2], t[1]});
        read.geometry.primitives.push_back({PrimitiveType::polygon, 3});
    }
    EXPECT_EQ(polygon_mesh(read, "x", {true}).report.welded_vertices, 8u);
    const ReadResult kept = polygon_mesh(read, "x", {false});
    EXPECT_EQ(kept.report.welded_vertices, 0u);
    EXPECT_EQ(kept.mesh.points, two.points);
    EXPECT_EQ(kept.mesh.triangles, two.triangles);
}

TEST(PolygonMesh, RefusesWhatIsNoSurface)
{
    ReadGeometry read;
    read.geometry = test::rich_geometry();
    try {
        polygon_mesh(read, "x.geo");
        ADD_FAILURE();
    } catch (const ReadError& error) {
        EXPECT_STREQ(error.what(),
                     "x.geo: primitive 0 is a tetrahedron; a surface is of polygons only");
    }
    read.geometry = {};
    read.geometry.points = 1;
    read.geometry.point_attributes = {{"P", 3, "point", std::vector<float>(3)}};
    EXPECT_THROW(polygon_mesh(read, "x.geo"), ReadError);
    std::string nowhere = cube(kNewRun);
    nowhere.replace(nowhere.find("\"P\""), 3, "\"Q\"");
    expect_refusal(nowhere, "no point attribute P");
}

/// The cube with (u, v) = (x, y) of each point, or by vertex the number of the quad and of the
/// corner in it.
ReadGeometry textured_cube(bool by_vertex)
{
    ReadGeometry read = parse_geometry(cube(kNewRun), "cube.geo");
    std::vector<float> uv;
    if (by_vertex)
        for (int v = 0; v < 24; ++v)
            uv.insert(uv.end(), {float(v / 4), float(v % 4), 0});
    else
        uv = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    (by_vertex ? read.geometry.vertex_attributes : read.geometry.point_attributes)
        .push_back({"uv", 3, "", uv});
    return read;
}

TEST(PolygonTexture, OfPointsIsThatOfTheCornersThere)
{
    const TextureCoordinates made = polygon_texture(textured_cube(false), "cube.geo");
    ASSERT_EQ(made.corner.size(), 12U);
    for (std::size_t t = 0; t < 12; ++t)
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec3s& p = made.mesh.points[made.mesh.triangles[t][k]];
            EXPECT_EQ(made.corner[t][std::size_t(k)], openvdb::Vec2d(p[0], p[1]));
        }
}

TEST(PolygonTexture, OfVerticesIsTurnedRoundWithThePolygons)
{
    // The indices of kCubeIndices, clockwise.
    const int quads[6][4] = {{0, 1, 2, 3}, {7, 6, 5, 4}, {0, 4, 5, 1},
                             {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    const ReadGeometry cube = textured_cube(true);
    const TextureCoordinates made = polygon_texture(cube, "cube.geo");
    EXPECT_EQ(made.mesh.triangles, polygon_mesh(cube, "cube.geo").mesh.triangles);
    ASSERT_EQ(made.corner.size(), 12U);
    for (std::size_t t = 0; t < 12; ++t)
        for (int k = 0; k < 3; ++k) {
            const openvdb::Vec2d& uv = made.corner[t][std::size_t(k)];
            EXPECT_EQ(uv[0], double(t / 2));
            EXPECT_EQ(quads[t / 2][std::size_t(uv[1])], int(made.mesh.triangles[t][k]));
        }
}

TEST(PolygonTexture, IsRefusedWhereThereIsNone)
{
    const ReadGeometry plain = parse_geometry(cube(kNewRun), "cube.geo");
    EXPECT_NE(test::complaint_of([&] {
                  polygon_texture(plain, "cube.geo");
              }).find("cube.geo: it has no texture coordinates"),
              std::string::npos);
    ReadGeometry narrow = plain;
    narrow.geometry.point_attributes.push_back({"uv", 1, "", std::vector<float>(8, 0)});
    EXPECT_THROW(polygon_texture(narrow, "cube.geo"), ReadError);
}

} // namespace
} // namespace vdb_shell::houdini

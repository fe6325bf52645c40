// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/repair/repair_mesh.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_mesh.h"

#include "core/counter_random.h"
#include "support/faulty_shapes.h"
#include "support/files.h"
#include "support/repairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

TEST(RepairMesh, LeavesASoundSurfaceAlone)
{
    for (const TriangleMesh& mesh : {unit_tetrahedron(), icosphere(1.0, 2), torus(2, 0.5, 12, 8)}) {
        const RepairResult result = repair_mesh(mesh);
        EXPECT_FALSE(result.report.changed());
        EXPECT_EQ(result.mesh.triangles, mesh.triangles);
        ASSERT_EQ(result.mesh.points.size(), mesh.points.size());
        EXPECT_EQ(std::memcmp(result.mesh.points.data(), mesh.points.data(),
                              mesh.points.size() * sizeof(Vec3s)),
                  0);
    }
}

TEST(RepairMesh, TurnsWhatIsTurned)
{
    TriangleMesh mesh = icosphere(1.0, 2);
    for (std::size_t t = 40; t < 90; ++t)
        std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    RepairResult result = repair_mesh(mesh);
    expect_sound(result.report);
    EXPECT_EQ(result.report.turned.count, 50u);
    EXPECT_EQ(result.report.turned.first.front(), 40u);
    EXPECT_EQ(expect_kept(mesh, result), mesh.triangles.size());

    result = repair_mesh(reversed(icosphere(1.0, 2)));
    expect_sound(result.report);
    EXPECT_GT(signed_volume(result.mesh.points, result.mesh.triangles), 0);
    EXPECT_EQ(result.report.turned.count, mesh.triangles.size());
}

TEST(RepairMesh, ASphereInASphereBecomesACavity)
{
    const TriangleMesh mesh = joined(icosphere(1.0, 2), icosphere(0.5, 2));
    const RepairResult result = repair_mesh(mesh);
    expect_sound(result.report);
    EXPECT_EQ(result.report.turned.count, mesh.triangles.size() / 2);
    EXPECT_EQ(result.report.turned.first.front(), mesh.triangles.size() / 2);
    const double ball = signed_volume(icosphere(1.0, 2).points, icosphere(1.0, 2).triangles);
    EXPECT_NEAR(signed_volume(result.mesh.points, result.mesh.triangles), ball * 7 / 8, 1e-5);
}

TEST(RepairMesh, DropsARepeatAndAWallBetweenTwoBoxes)
{
    TriangleMesh repeated = icosphere(1.0, 1);
    repeated.triangles.push_back(repeated.triangles[7]);
    RepairResult result = repair_mesh(repeated);
    expect_sound(result.report);
    EXPECT_EQ(result.report.duplicates.count, 1u);
    EXPECT_EQ(result.report.duplicates.first.front(), 80u);

    const TriangleMesh two = joined(box({0, 0, 0}, {1, 1, 1}), box({1, 0, 0}, {2, 1, 1}));
    result = repair_mesh(two);
    expect_sound(result.report);
    EXPECT_EQ(result.report.welded_points.count, 4u);
    EXPECT_EQ(result.report.duplicates.count, 4u);
    EXPECT_EQ(result.report.after.components.size(), 1u);
    EXPECT_DOUBLE_EQ(signed_volume(result.mesh.points, result.mesh.triangles), 2.0);
}

TEST(RepairMesh, DropsASheetThatHangsInTheSurfaceAndAFinThatStandsOnIt)
{
    TriangleMesh mesh = gridded_box({0, 0, 0}, {2, 1, 1}, 2);
    const auto index = [&](float x, float y, float z) {
        const auto found = std::find(mesh.points.begin(), mesh.points.end(), Vec3s(x, y, z));
        return static_cast<std::uint32_t>(found - mesh.points.begin());
    };
    // The wall x = 1, which the grid's own edges frame.
    const std::uint32_t centre = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.emplace_back(1.0f, 0.5f, 0.5f);
    const std::vector<std::uint32_t> frame{index(1, 0, 0),    index(1, 0.5f, 0), index(1, 1, 0),
                                           index(1, 1, 0.5f), index(1, 1, 1),    index(1, 0.5f, 1),
                                           index(1, 0, 1),    index(1, 0, 0.5f)};
    for (std::size_t i = 0; i < 8; ++i) {
        ASSERT_LT(frame[i], centre);
        mesh.triangles.emplace_back(centre, frame[i], frame[(i + 1) % 8]);
    }
    const std::uint32_t tip = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.emplace_back(0.0f, 0.5f, 3.0f);
    mesh.triangles.emplace_back(tip, index(0, 0.5f, 1), index(0, 0, 1));
    const RepairResult result = repair_mesh(mesh);
    expect_sound(result.report);
    EXPECT_EQ(result.report.sheets.count, 9u);
    EXPECT_DOUBLE_EQ(signed_volume(result.mesh.points, result.mesh.triangles), 2.0);
}

TEST(RepairMesh, PartsTwoSpheresThatTouchInAPoint)
{
    const TriangleMesh mesh = touching_spheres(2, 0);
    ASSERT_EQ(check_mesh(mesh).non_manifold_vertices.count, 1u);
    const RepairResult result = repair_mesh(mesh);
    expect_sound(result.report);
    EXPECT_EQ(result.report.split_points.count, 1u);
    EXPECT_EQ(result.report.copies, 1u);
    EXPECT_EQ(result.report.moved_points, 1u) << "one of the two can stay";
    EXPECT_LT(result.report.largest_move, 0.03);
    EXPECT_EQ(result.report.after.components.size(), 2u);
    EXPECT_EQ(expect_kept(mesh, result), mesh.triangles.size() - 5)
        << "the five triangles around the point that moved";
}

TEST(RepairMesh, PartsBoxesThatMeetInAnEdgeAndTunnelsThatMeetInOne)
{
    const TriangleMesh boxes = voxel_surface({{0, 0, 0}, {1, 1, 0}});
    ASSERT_EQ(check_mesh(boxes).non_manifold_edges.count, 1u);
    RepairResult result = repair_mesh(boxes);
    expect_sound(result.report);
    EXPECT_EQ(result.report.split_edges, 1u);
    EXPECT_EQ(result.report.copies, 2u);
    EXPECT_NEAR(result.report.after.volume, 2.0, 0.1);

    // Both ends of the edge are one fan each, so the points in its middle are what can be parted.
    std::set<Voxel> block;
    for (int x = 0; x < 2; ++x)
        for (int y = 0; y < 2; ++y)
            for (int z = -1; z < 2; ++z)
                if (z != 0 || x == y)
                    block.insert({x, y, z});
    const TriangleMesh pinched = voxel_surface(block);
    ASSERT_EQ(check_mesh(pinched).non_manifold_edges.count, 1u);
    result = repair_mesh(pinched);
    expect_sound(result.report);
    EXPECT_EQ(result.report.copies, 2u);
    EXPECT_NEAR(result.report.after.volume, 10.0, 0.1);
}

TEST(RepairMesh, PartsWhateverRandomCubesLeave)
{
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const CounterRandom random(seed);
        std::set<Voxel> voxels;
        for (int i = 0; i < 64; ++i)
            if (random.unit(std::uint64_t(i)) < 0.5)
                voxels.insert({i % 4, i / 4 % 4, i / 16});
        const TriangleMesh mesh = voxel_surface(voxels);
        EXPECT_GT(check_mesh(mesh).non_manifold_edges.count, 0u) << seed;
        const RepairResult result = repair_mesh(mesh);
        expect_kept(mesh, result);
        EXPECT_TRUE(result.report.after.manifold()) << seed;
        EXPECT_TRUE(result.report.after.closed()) << seed;
        EXPECT_EQ(result.report.after.self_intersections.count, 0u) << seed;
        EXPECT_NEAR(result.report.after.volume, double(voxels.size()), 0.1 * double(voxels.size()));
    }
}

TEST(RepairMesh, CutsTheNeighbourOfATriangleWithoutArea)
{
    // The edge (1, 2) of the tetrahedron has a point in its middle that only one side knows; a cap
    // of no area fills the slit.
    TriangleMesh mesh = unit_tetrahedron();
    const auto middle = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.emplace_back(0.5f, 0.5f, 0.0f);
    for (std::size_t t = 0; t < 4; ++t) {
        const Vec3I corner = mesh.triangles[t];
        for (int k = 0; k < 3; ++k)
            if (corner[k] == 1 && corner[(k + 1) % 3] == 2) {
                mesh.triangles[t] = Vec3I(1, middle, corner[(k + 2) % 3]);
                mesh.triangles.emplace_back(middle, 2, corner[(k + 2) % 3]);
            }
    }
    mesh.triangles.emplace_back(middle, 1, 2);
    ASSERT_EQ(check_mesh(mesh).degenerate_triangles.count, 1u);
    ASSERT_TRUE(check_mesh(mesh).closed());
    const RepairResult result = repair_mesh(mesh);
    expect_sound(result.report);
    EXPECT_EQ(result.report.degenerate.count, 1u);
    EXPECT_EQ(result.report.recut.count, 1u);
    EXPECT_EQ(result.mesh.triangles.size(), 6u);
    EXPECT_NEAR(result.report.after.volume, 1.0 / 6, 1e-12);
}

TEST(RepairMesh, RemovesTensOfThousandsOfFlatTriangles)
{
    // A point in the middle of a side that one triangle knows and its neighbour does not, with the
    // flat triangle between them. In time that grows with the square this would be minutes.
    constexpr int kSide = 96;
    TriangleMesh mesh = gridded_box(Vec3d(0.0), Vec3d(kSide), kSide);
    const std::size_t triangles = mesh.triangles.size();
    std::size_t flat = 0;
    for (std::size_t t = 0; t < triangles; t += 3, ++flat) {
        const Vec3I corner = mesh.triangles[t];
        const auto middle = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back((mesh.points[corner[0]] + mesh.points[corner[1]]) * 0.5F);
        mesh.triangles[t] = Vec3I(corner[0], middle, corner[2]);
        mesh.triangles.emplace_back(middle, corner[1], corner[2]);
        mesh.triangles.emplace_back(corner[0], corner[1], middle);
    }
    const RepairResult result = repair_mesh(mesh);
    expect_sound(result.report);
    EXPECT_EQ(result.report.degenerate.count, flat);
    EXPECT_EQ(signed_volume(result.mesh.points, result.mesh.triangles), std::pow(kSide, 3));
}

TEST(RepairMesh, WeldsWithinATolerance)
{
    // Each triangle has corners of its own, up to 1e-4 away from where they belong.
    const TriangleMesh whole = icosphere(1.0, 2);
    const CounterRandom random(3);
    TriangleMesh soup;
    std::uint64_t draw = 0;
    for (const Vec3I& t : whole.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.points.size());
        for (int k = 0; k < 3; ++k) {
            Vec3d p(whole.points[t[k]]);
            for (int axis = 0; axis < 3; ++axis)
                p[axis] += 1e-4 * (random.unit(draw++) - 0.5);
            soup.points.emplace_back(p);
        }
        soup.triangles.emplace_back(first, first + 1, first + 2);
    }
    RepairOptions options;
    options.weld_tolerance = 1e-3;
    const RepairResult result = repair_mesh(soup, options);
    expect_sound(result.report);
    EXPECT_EQ(result.mesh.points.size(), whole.points.size());
    EXPECT_EQ(result.report.welded_points.count, soup.points.size() - whole.points.size());
    EXPECT_NEAR(result.report.after.volume, signed_volume(whole.points, whole.triangles), 1e-3);
}

TEST(RepairMesh, RemovesSliversWhenAsked)
{
    // A gridded box whose corner (0, 0, 0) has a near twin along x, as careless booleans leave it.
    TriangleMesh mesh = gridded_box({0, 0, 0}, {1, 1, 1}, 2);
    const auto find = [&](const Vec3s& p) {
        return static_cast<std::uint32_t>(std::find(mesh.points.begin(), mesh.points.end(), p) -
                                          mesh.points.begin());
    };
    const std::uint32_t a = find({0, 0, 0}), b = find({0.5f, 0, 0});
    const auto twin = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.emplace_back(1e-4f, 0.0f, 0.0f);
    const std::size_t before = mesh.triangles.size();
    for (std::size_t t = 0; t < before; ++t)
        for (int k = 0; k < 3; ++k) {
            const Vec3I c = mesh.triangles[t];
            const std::uint32_t p = c[k], q = c[(k + 1) % 3], r = c[(k + 2) % 3];
            if (!((p == a && q == b) || (p == b && q == a)))
                continue;
            mesh.triangles[t] = Vec3I(p, twin, r);
            mesh.triangles.emplace_back(twin, q, r);
            break;
        }
    ASSERT_EQ(mesh.triangles.size(), before + 2);
    ASSERT_FALSE(repair_mesh(mesh).report.changed());
    RepairOptions options;
    options.sliver_height = 1e-3;
    const RepairResult result = repair_mesh(mesh, options);
    expect_sound(result.report);
    EXPECT_GT(result.report.slivers.count, 0u);
    EXPECT_EQ(result.mesh.triangles.size(), before);
    EXPECT_NEAR(result.report.after.volume, 1.0, 1e-3);
}

TEST(RepairMesh, CutsOutWhatCrossesWhenAsked)
{
    // A spike of the sphere reaches through its other side.
    TriangleMesh mesh = icosphere(1.0, 3);
    mesh.points[100] = Vec3s(Vec3d(mesh.points[100]) * -1.3);
    ASSERT_GT(check_mesh(mesh).self_intersections.count, 0u);
    EXPECT_FALSE(repair_mesh(mesh).report.changed()) << "only when asked";
    RepairOptions options;
    options.cut_crossings = true;
    const RepairResult result = repair_mesh(mesh, options);
    expect_sound(result.report);
    EXPECT_EQ(expect_kept(mesh, result) + result.report.cut.count, mesh.triangles.size());
    EXPECT_LT(result.report.cut.count, 60u);
    const double ball = signed_volume(icosphere(1.0, 3).points, icosphere(1.0, 3).triangles);
    EXPECT_NEAR(result.report.after.volume, ball, 0.02 * ball);
    // A sheet crosses nothing, so nothing of it is cut.
    const TriangleMesh strip = moebius_strip(24, 3);
    EXPECT_EQ(repair_mesh(strip, options).report.cut.count, 0u);
}

TEST(RepairMesh, RefusesImpossibleOptionsAndMeshes)
{
    RepairOptions options;
    options.weld_tolerance = -1;
    EXPECT_THROW(repair_mesh(unit_tetrahedron(), options), InvalidOption);
    options.weld_tolerance = 0;
    options.sliver_height = std::nan("");
    EXPECT_THROW(repair_mesh(unit_tetrahedron(), options), InvalidOption);
    TriangleMesh mesh = unit_tetrahedron();
    mesh.triangles[2][1] = 9;
    try {
        repair_mesh(mesh);
        FAIL() << "an index out of range was accepted";
    } catch (const InvalidOption& error) {
        const std::string message = error.what();
        for (const char* word : {"repair_mesh", "triangle 2", "9", "4"})
            EXPECT_NE(message.find(word), std::string::npos) << message;
    }
}

TEST(RepairMesh, SurvivesNothingAndAlmostNothing)
{
    EXPECT_EQ(repair_mesh({}).mesh.triangles.size(), 0u);
    TriangleMesh line;
    line.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    line.triangles = {{0, 1, 2}};
    EXPECT_EQ(repair_mesh(line).mesh.triangles.size(), 0u);
    TriangleMesh one;
    one.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    one.triangles = {{0, 1, 2}};
    const RepairResult result = repair_mesh(one);
    EXPECT_EQ(result.mesh.triangles.size(), 1u);
    EXPECT_EQ(result.report.holes.at(0).method, FillMethod::none);
}

TEST(RepairMesh, ClosesTheStanfordBunnyAndKeepsItsSkin)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    const TriangleMesh bunny = read_mesh(real_meshes() / "artist/stanford-bunny.obj").mesh;
    ASSERT_EQ(check_mesh(bunny).boundary_edges.count, 223u);
    const RepairResult result = repair_mesh(bunny);
    expect_sound(result.report);
    EXPECT_EQ(result.report.holes.size(), 5u);
    EXPECT_EQ(expect_kept(bunny, result), bunny.triangles.size());
    // The input's points are the first ones, in their order.
    ASSERT_GT(result.mesh.points.size(), bunny.points.size());
    EXPECT_EQ(std::memcmp(result.mesh.points.data(), bunny.points.data(),
                          bunny.points.size() * sizeof(Vec3s)),
              0);
}

TEST(RepairMesh, MendsTheOtherFaultyMeshesOrSaysWhatIsLeft)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    RepairOptions options;
    options.cut_crossings = true;
    for (const char* name :
         {"artist/cow.obj", "artist/beetle.obj", "artist/suzanne.obj",
          "paper/bunny_medium_resolution.obj", "paper/bunny_high_resolution.obj"}) {
        const TriangleMesh mesh = read_mesh(real_meshes() / name).mesh;
        const RepairResult result = repair_mesh(mesh, options);
        SCOPED_TRACE(name);
        expect_sound(result.report);
        EXPECT_GT(expect_kept(mesh, result), mesh.triangles.size() * 3 / 4);
    }
    const TriangleMesh woody = read_mesh(real_meshes() / "artist/woody.obj").mesh;
    const RepairResult sheet = repair_mesh(woody, options);
    EXPECT_EQ(expect_kept(woody, sheet), woody.triangles.size());
    EXPECT_EQ(sheet.report.holes.at(0).method, FillMethod::none);
}

} // namespace
} // namespace vdb_shell::test

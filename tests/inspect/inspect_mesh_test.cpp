// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/inspect/inspect_mesh.h"

#include "vdb_shell/core/error.h"

#include "support/cancelled.h"
#include "support/faulty_shapes.h"
#include "support/files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3s;

const Finding* find(const std::vector<Finding>& findings, const std::string& kind)
{
    const auto found = std::find_if(findings.begin(), findings.end(),
                                    [&](const Finding& f) { return f.kind == kind; });
    return found == findings.end() ? nullptr : &*found;
}

std::vector<std::string> kinds_of(const MeshInspection& inspection)
{
    std::vector<std::string> kinds;
    for (const Finding& finding : findings_of(inspection)) {
        kinds.push_back(finding.kind);
        EXPECT_GT(finding.count, 0u) << finding.kind;
        EXPECT_FALSE(finding.mend.empty()) << finding.kind;
    }
    return kinds;
}

using Kinds = std::vector<std::string>;

TEST(InspectMesh, FindsNothingWrongWithSoundSurfaces)
{
    for (const TriangleMesh& mesh :
         {unit_tetrahedron(), icosphere(1.0, 3), torus(2, 0.5, 24, 12)}) {
        const MeshInspection inspection = inspect_mesh(mesh);
        EXPECT_EQ(kinds_of(inspection), Kinds{});
        EXPECT_TRUE(usable(inspection));
    }
}

TEST(InspectMesh, MeasuresHoles)
{
    TriangleMesh mesh =
        without(box({0, 0, 0}, {1, 2, 3}), [](const Vec3s& p) { return p[0] == 0; });
    mesh = without(mesh, [](const Vec3s& p) { return p[0] == 1; });
    const MeshInspection inspection = inspect_mesh(mesh);
    ASSERT_EQ(inspection.boundary_loops.size(), 2u);
    for (const BoundaryLoop& loop : inspection.boundary_loops) {
        EXPECT_EQ(loop.edges, 4u);
        EXPECT_DOUBLE_EQ(loop.length, 10.0);
        EXPECT_TRUE(loop.closed);
    }
    EXPECT_EQ(kinds_of(inspection), (Kinds{"boundary_loops", "boundary_edges"}));
    EXPECT_FALSE(usable(inspection));
}

TEST(InspectMesh, TellsHolesThatMeetInAPointApart)
{
    TriangleMesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
    const MeshInspection inspection = inspect_mesh(mesh);
    ASSERT_EQ(inspection.boundary_loops.size(), 2u);
    EXPECT_EQ(inspection.boundary_loops[0].edges, 3u);
    EXPECT_EQ(inspection.boundary_loops[1].edges, 3u);
}

TEST(InspectMesh, CountsFlippedPatches)
{
    TriangleMesh mesh = icosphere(1.0, 2);
    const auto turn = [&](std::size_t t) { std::swap(mesh.triangles[t][1], mesh.triangles[t][2]); };
    // The four children of one triangle stand together, the other one alone.
    for (std::size_t t = 16; t < 20; ++t)
        turn(t);
    turn(200);
    const MeshInspection inspection = inspect_mesh(mesh);
    ASSERT_EQ(inspection.flipped_patches.size(), 2u);
    EXPECT_EQ(inspection.flipped_patches[0].first_triangle, 16u);
    EXPECT_EQ(inspection.flipped_patches[0].triangles, 4u);
    EXPECT_EQ(inspection.flipped_patches[1].first_triangle, 200u);
    EXPECT_EQ(inspection.flipped_patches[1].triangles, 1u);
    EXPECT_EQ(inspection.one_sided_pieces.count, 0u);
}

TEST(InspectMesh, NamesAMoebiusStripAndAKleinBottle)
{
    MeshInspection inspection = inspect_mesh(moebius_strip(24, 2));
    EXPECT_EQ(inspection.one_sided_pieces.count, 1u);
    ASSERT_EQ(inspection.boundary_loops.size(), 1u);
    EXPECT_EQ(inspection.boundary_loops[0].edges, 48u);
    EXPECT_TRUE(inspection.flipped_patches.empty());

    inspection = inspect_mesh(klein_bottle(24, 16));
    EXPECT_EQ(inspection.one_sided_pieces.count, 1u);
    EXPECT_TRUE(inspection.boundary_loops.empty());
    EXPECT_GT(inspection.check.self_intersections.count, 0u)
        << "no Klein bottle lies in space without crossing itself";
    EXPECT_EQ(inspection.check.components.at(0).euler, 0);
}

TEST(InspectMesh, NamesTouchingSpheresAndNestedOnes)
{
    MeshInspection inspection = inspect_mesh(touching_spheres(2, 0));
    EXPECT_EQ(inspection.check.non_manifold_vertices.count, 1u);
    EXPECT_EQ(inspection.check.non_manifold_vertices.first.at(0), 0u);
    EXPECT_EQ(inspection.check.self_intersections.count, 0u);

    const TriangleMesh cavity = joined(icosphere(1, 2), reversed(icosphere(0.5, 2)));
    inspection = inspect_mesh(cavity);
    EXPECT_EQ(kinds_of(inspection), Kinds{"nested_components"});
    EXPECT_TRUE(usable(inspection));
    const Finding nested = findings_of(inspection).at(0);
    EXPECT_EQ(nested.first, std::vector<std::string>{"1"});

    inspection = inspect_mesh(joined(icosphere(1, 2), icosphere(0.5, 2)));
    EXPECT_EQ(kinds_of(inspection), (Kinds{"inside_out_components", "nested_components"}));
    EXPECT_FALSE(usable(inspection));
}

TEST(InspectMesh, NamesAClosedSurfaceWithoutVolume)
{
    const TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                            {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}};
    const MeshInspection inspection = inspect_mesh(flat);
    const std::vector<Finding> findings = findings_of(inspection);
    const auto found = std::find_if(findings.begin(), findings.end(), [](const Finding& finding) {
        return finding.kind == "flat_components";
    });
    ASSERT_NE(found, findings.end());
    EXPECT_EQ(found->first, std::vector<std::string>{"0"});
    EXPECT_TRUE(found->blocks);
    EXPECT_FALSE(usable(inspection));
}

TEST(InspectMesh, FindsBlindVerticesWhereNormalsOppose)
{
    // Around (1, 1, 1) a path of four of the eight cubes: its faces there look along +y and -y.
    const TriangleMesh mesh = voxel_surface({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}});
    const MeshInspection inspection = inspect_mesh(mesh);
    EXPECT_EQ(inspection.blind_vertices.count, 1u);
    ASSERT_FALSE(inspection.blind_vertices.first.empty());
    EXPECT_EQ(mesh.points[inspection.blind_vertices.first[0]], Vec3s(1, 1, 1));
    EXPECT_TRUE(usable(inspection)) << "growth pins it";
}

TEST(InspectMesh, FindsWhatIsThinnerThanAVoxel)
{
    const TriangleMesh plate = box({0, 0, 0}, {1, 1, 0.01});
    InspectOptions options;
    options.level_set.voxel_size = 0.02;
    EXPECT_EQ(inspect_mesh(plate, options).thin_triangles.count, 4u) << "both sides of the plate";
    options.level_set.voxel_size = 0.005;
    EXPECT_EQ(inspect_mesh(plate, options).thin_triangles.count, 0u);
}

TEST(InspectMesh, MeasuresWhatFloat32LeavesFarFromTheOrigin)
{
    EXPECT_EQ(inspect_mesh(box({0, 0, 0}, {1, 1, 1})).floats.digits, 23);
    // One unit in the last place at 2^20 is 2^-3; the box is 2^3 long.
    const TriangleMesh far = box({1048576.0, 0, 0}, {1048584.0, 8, 8});
    const MeshInspection inspection = inspect_mesh(far);
    EXPECT_EQ(inspection.floats.digits, 6);
    EXPECT_DOUBLE_EQ(inspection.floats.spacing, 0.125);
    EXPECT_DOUBLE_EQ(inspection.floats.longest_side, 8.0);
    EXPECT_NE(
        find(findings_of(inspection), "coarse_coordinates")->text.find("0.015625 of the longest"),
        std::string::npos);
    const std::vector<Finding> findings = findings_of(inspection);
    ASSERT_NE(find(findings, "coarse_coordinates"), nullptr);
    EXPECT_FALSE(find(findings, "coarse_coordinates")->blocks);
    // 2^20 / (8 / 256) is over the limit of 2^22 voxels.
    ASSERT_NE(find(findings, "far_coordinates"), nullptr);
    EXPECT_TRUE(find(findings, "far_coordinates")->blocks);
    EXPECT_FALSE(usable(inspection));
}

TEST(InspectMesh, NamesVoxelsTooSmallForOpenVdb)
{
    InspectOptions options;
    options.level_set.voxel_size = 1e-6;
    const MeshInspection inspection = inspect_mesh(box({0, 0, 0}, {1e-4, 1e-4, 1e-4}), options);
    ASSERT_NE(find(findings_of(inspection), "tiny_voxels"), nullptr);
    EXPECT_FALSE(usable(inspection));
    // By resolution the voxels are as large as they have to be, but eight of them at least.
    EXPECT_TRUE(usable(inspect_mesh(box({0, 0, 0}, {2e-4, 2e-4, 2e-4}))));
    EXPECT_FALSE(usable(inspect_mesh(box({0, 0, 0}, {1e-4, 1e-4, 1e-4}))));
}

TEST(InspectMesh, TakesNothingAndASinglePlace)
{
    EXPECT_EQ(findings_of(inspect_mesh({})).at(0).kind, "no_triangles");
    TriangleMesh mesh;
    mesh.points.assign(3, Vec3s(1, 2, 3));
    mesh.triangles = {{0, 1, 2}};
    const MeshInspection inspection = inspect_mesh(mesh);
    EXPECT_EQ(inspection.check.degenerate_triangles.count, 1u);
    EXPECT_FALSE(usable(inspection));
}

TEST(InspectMesh, JsonAndTextSayTheSame)
{
    const TriangleMesh mesh = without_triangle(icosphere(1.0, 2), 5);
    const MeshInspection inspection = inspect_mesh(mesh);
    ReadReport read;
    read.format = "OBJ";
    const auto json = nlohmann::json::parse(inspection_json("s.obj", read, inspection));
    EXPECT_EQ(json.at("source"), "s.obj");
    EXPECT_FALSE(json.at("usable").get<bool>());
    EXPECT_EQ(json.at("boundary_loops").at(0).at("edges"), 3);
    const std::string text = inspection_text("s.obj", read, inspection);
    for (const auto& finding : json.at("findings")) {
        EXPECT_NE(text.find(finding.at("text").get<std::string>()), std::string::npos) << text;
        EXPECT_NE(text.find(finding.at("mend").get<std::string>()), std::string::npos) << text;
    }
    EXPECT_NE(text.find("NOT usable"), std::string::npos);
}

/// The property `defects` of triangle t in a picture's bytes: triangles of 18 bytes end the file.
int marks_of_triangle(const std::string& bytes, std::size_t triangles, std::size_t t)
{
    const std::size_t end = bytes.size() - 18 * (triangles - 1 - t);
    return static_cast<unsigned char>(bytes[end - 2]) | static_cast<unsigned char>(bytes[end - 1])
                                                            << 8;
}

TEST(InspectMesh, PaintsTheDefects)
{
    TriangleMesh mesh = icosphere(1.0, 2);
    mesh.triangles.push_back(mesh.triangles[7]);
    const TemporaryFolder folder;
    write_defect_picture(folder / "d.ply", mesh);
    const ReadResult read = read_mesh(folder / "d.ply");
    EXPECT_EQ(read.mesh.triangles, mesh.triangles);
    const std::string bytes = read_bytes(folder / "d.ply");
    constexpr int kDuplicate = 64, kNonManifold = 128;
    EXPECT_EQ(marks_of_triangle(bytes, 321, 320), kDuplicate | kNonManifold);
    EXPECT_EQ(marks_of_triangle(bytes, 321, 7), kNonManifold);
    EXPECT_EQ(marks_of_triangle(bytes, 321, 300), 0);
    EXPECT_THROW(write_defect_picture(folder / "d.obj", mesh), InvalidOption);
}

TEST(InspectMesh, PaintsWhatItInspectsAndNothingElse)
{
    const TemporaryFolder folder;
    TriangleMesh mesh = icosphere(1.0, 1);
    mesh.triangles[3][1] = 1000;
    EXPECT_THROW(write_defect_picture(folder / "d.ply", mesh), InvalidOption);
    // Without a size there is no voxel to measure against, and all triangles are bad all the same.
    TriangleMesh point;
    point.points = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    point.triangles = {{0, 1, 2}};
    EXPECT_NO_THROW(write_defect_picture(folder / "d.ply", point));
    EXPECT_TRUE(std::filesystem::exists(folder / "d.ply"));
}

TEST(InspectMesh, ReportsTheRealFaultyMeshes)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    const auto look = [](const char* name) {
        return inspect_mesh(read_mesh(real_meshes() / name).mesh);
    };
    const MeshInspection bunny = look("artist/stanford-bunny.obj");
    EXPECT_EQ(bunny.boundary_loops.size(), 5u);
    EXPECT_EQ(bunny.check.boundary_edges.count, 223u);
    const MeshInspection woody = look("artist/woody.obj");
    ASSERT_EQ(woody.boundary_loops.size(), 1u);
    EXPECT_EQ(woody.boundary_loops[0].edges, 119u);
    EXPECT_EQ(look("artist/cow.obj").check.self_intersections.count, 81u);
    EXPECT_EQ(look("paper/dragon_small_resolution.obj").blind_vertices.count, 2u);
    EXPECT_EQ(look("paper/lamp.obj").blind_vertices.count, 1u);
}

TEST(InspectMesh, CanBeCancelled)
{
    const TriangleMesh mesh = icosphere(1.0, 3);
    expect_cancelled([&](Interrupter* interrupter) { inspect_mesh(mesh, {}, interrupter); });
}

} // namespace
} // namespace vdb_shell::test

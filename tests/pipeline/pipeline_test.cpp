// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/pipeline.h"

#include "core/exact.h"
#include "core/grid_instances.h"
#include "support/cancelled.h"
#include "support/files.h"
#include "support/shapes.h"
#include "support/sphere_field.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

// Stages together: what holds for the shell of a surface or level set from beginning to end.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using ::testing::HasSubstr;

TEST(Pipeline, FillsRealMeshes)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const char* name : {"cow.obj", "diku.obj", "lamp.obj", "teapot.obj"}) {
        SCOPED_TRACE(name);
        const ReadResult read = read_mesh(test::real_meshes() / "paper" / name, {});
        ShellOptions options;
        options.level_set.resolution = 64;
        const ShellResult result = build_shell(read.mesh, options, name);
        EXPECT_EQ(result.report.signs.inverted.count, 0U);
        EXPECT_EQ(result.report.signs.flat.count, 0U);
        EXPECT_EQ(result.report.certificate->layers[0].test, PrismTest::twelve_tets);
        EXPECT_TRUE(result.report.certificate->certified());
        EXPECT_EQ(result.report.coverage.samples, ShellOptions{}.coverage.samples);
        EXPECT_EQ(result.report.coverage.in_several, 0U);
        EXPECT_EQ(result.report.coverage.outside_covered, 0U);
        EXPECT_GT(result.report.fill, 0.95);
    }
}

TEST(Pipeline, APlateBetweenVoxelCentresIsFilledAllTheSame)
{
    const TriangleMesh plate = test::box(Vec3d(0, 0, 0.05), Vec3d(100, 50, 0.2));
    ShellOptions options;
    options.level_set.resolution = 64; // a voxel is 1.6 long
    const ShellResult result = build_shell(plate, options, "plate");
    EXPECT_FALSE(has_inside(*result.level_set));
    EXPECT_EQ(result.report.field.interior_depth, 0);
    EXPECT_TRUE(result.report.certificate->certified());
    EXPECT_GT(result.report.fill, 0.99);
    // Lines have nothing to step through, and say what helps.
    options.grow.method = Method::raw;
    try {
        build_shell(plate, options, "plate");
        FAIL() << "nothing was thrown";
    } catch (const GeometryError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("plate: no voxel centre lies inside, voxel size 1.5625"));
    }
}

TEST(Pipeline, TheReportSaysWhichField)
{
    const TriangleMesh mesh = test::icosphere(0.4, 2);
    const auto report_of = [&](const auto& change) {
        ShellOptions options;
        options.level_set.resolution = 64;
        options.grow.method = Method::raw;
        options.coverage.samples = 0;
        options.line_step.thickness = 0.05;
        change(options);
        return build_shell(mesh, options).report.field;
    };
    const FieldReport sparse = report_of([](ShellOptions&) {});
    EXPECT_TRUE(sparse.sparse);
    EXPECT_THAT(sparse.origin, HasSubstr("a narrow band"));
    const auto expect_dense = [&](const char* reason, const auto& change) {
        const FieldReport dense = report_of(change);
        EXPECT_FALSE(dense.sparse) << reason;
        EXPECT_THAT(dense.origin, HasSubstr(reason));
    };
    expect_dense("asked for", [](auto& o) { o.field = FieldRoute::dense; });
    expect_dense("outward", [](auto& o) { o.side = Side::both; });
    expect_dense("smoothing", [](auto& o) { o.smooth.iterations = 1; });
    expect_dense("depth asked for", [](auto& o) { o.level_set.interior_depth = 0.05; });
    expect_dense("wide band", [](auto& o) { o.level_set.exterior_voxels = 9; });
    expect_dense("many lines", [](auto& o) { o.level_set.resolution = 12; });
}

TEST(Pipeline, TheShellOfASheetIsCertified)
{
    ShellOptions options;
    options.wrap.wanted = true;
    options.wrap.resolution = 24;
    options.level_set.resolution = 64;
    options.coverage.samples = 1000;
    const TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const ShellResult result = build_shell(sheet, options, "sheet");
    ASSERT_TRUE(result.report.certificate.has_value());
    EXPECT_TRUE(result.report.certificate->certified());
    EXPECT_GT(result.report.fill, 0.1);
    ASSERT_TRUE(result.report.wrap.has_value());
    EXPECT_EQ(result.report.wrap->sheet_share, 1.0);
}

/// Vertices of the triangles that touch another one otherwise than in shared corners and edges.
std::vector<char> at_crossings(const TriangleMesh& mesh)
{
    std::vector<char> marked(mesh.points.size());
    for (const openvdb::Vec3I& s : mesh.triangles)
        for (const openvdb::Vec3I& t : mesh.triangles)
            if (s != t && exact::triangles_touch(mesh.points, s, t))
                for (int k = 0; k < 3; ++k)
                    marked[s[k]] = 1;
    return marked;
}

TEST(Pipeline, GrowthOnCrossingBoxesGivesUpTheCrossingTrianglesOnly)
{
    const TriangleMesh mesh =
        test::joined(test::gridded_box(Vec3d(0.0), Vec3d(1.0), 5),
                     test::gridded_box(Vec3d(0.53, 0.57, 0.61), Vec3d(1.53, 1.57, 1.61), 5));
    ShellOptions options;
    options.level_set.resolution = 40;
    options.coverage.samples = 10000;
    EXPECT_THROW(build_shell(mesh, options), GeometryError);
    options.check.allow_self_intersections = true;
    const ShellResult result = build_shell(mesh, options);
    ASSERT_TRUE(result.report.overlaps);
    EXPECT_FALSE(result.report.certificate->certified());
    EXPECT_TRUE(result.report.certificate->locally_valid());
    // The common part of the boxes is filled once, not twice.
    EXPECT_TRUE(result.report.overlaps->none()) << result.report.overlaps->summary();
    EXPECT_EQ(result.report.coverage.in_several, 0U);
    EXPECT_GT(result.report.coverage.covered_share, 0.85);
    const std::vector<char> near = at_crossings(result.surface);
    const PrismShell& shell = result.stack.layers.front();
    std::size_t pinned = 0;
    for (std::size_t v = 0; v < near.size(); ++v) {
        pinned += shell.length(v) == 0;
        EXPECT_TRUE(shell.length(v) > 0 || near[v]) << v;
    }
    EXPECT_GT(pinned, 0U);
}

TEST(Pipeline, AVertexOfTwoFansIsCopiedWhereCrossingsAreAllowed)
{
    // Two balls that share one vertex.
    TriangleMesh mesh = test::icosphere(1, 2);
    const Vec3s end = mesh.points[0];
    const auto count = static_cast<std::uint32_t>(mesh.points.size());
    const TriangleMesh other = mesh;
    for (const Vec3s& p : other.points)
        mesh.points.push_back(end * 2.0f - p);
    for (const openvdb::Vec3I& t : other.triangles) {
        openvdb::Vec3I turned(t[0], t[2], t[1]);
        for (int k = 0; k < 3; ++k)
            turned[k] = turned[k] == 0 ? 0U : turned[k] + count;
        mesh.triangles.push_back(turned);
    }
    ASSERT_EQ(check_mesh(mesh).non_manifold_vertices.first, std::vector<std::uint32_t>{0});
    ShellOptions options;
    options.level_set.resolution = 32;
    options.coverage.samples = 1000;
    EXPECT_THROW(build_shell(mesh, options), GeometryError);
    options.check.allow_self_intersections = true;
    const ShellResult result = build_shell(mesh, options);
    EXPECT_EQ(result.report.split_vertices.first, std::vector<std::uint32_t>{0});
    EXPECT_EQ(result.report.vertex_copies, 1U);
    ASSERT_TRUE(result.report.overlaps);
    EXPECT_TRUE(result.report.overlaps->none());
    EXPECT_GT(result.report.fill, 0.7);
}

ShellOptions quick_options()
{
    ShellOptions options;
    options.level_set.resolution = 40;
    options.coverage.samples = 1000;
    options.contour.adaptivity = 0.5;
    options.grow.free_rounds = 2;
    return options;
}

TEST(PipelineOfLevelSet, StepsThroughAGivenFieldThatIsDeepEnough)
{
    const auto field = test::sphere_field(1.0);
    const ShellResult shell = build_shell_from_level_set(*field, quick_options());
    EXPECT_EQ(shell.report.field.origin, "as given");
    EXPECT_TRUE(shell.report.certificate->certified());
    EXPECT_NEAR(shell.report.solid_volume, 4.0 / 3.0 * M_PI, 0.1);
    EXPECT_EQ(shell.report.field.voxel_size, field->voxelSize()[0]);
}

TEST(PipelineOfLevelSet, ATurnedFieldGivesTheSameSolid)
{
    const auto turned = test::sphere_field(1.0);
    turned->transform().postRotate(0.5, openvdb::math::X_AXIS);
    turned->transform().postTranslate(Vec3d(4, 5, 6));
    const ShellResult shell = build_shell_from_level_set(*turned, quick_options());
    EXPECT_EQ(shell.report.field.origin, "as given");
    EXPECT_TRUE(shell.report.certificate->certified());
    EXPECT_NEAR(shell.report.solid_volume, 4.0 / 3.0 * M_PI, 0.1);
    EXPECT_GT(shell.report.fill, 0.5);
}

TEST(PipelineOfLevelSet, SaysWhyTheFieldWasMadeAnew)
{
    const auto squeezed = test::sphere_field(0.2);
    squeezed->transform().postScale(Vec3d(1, 1, 2));
    const ShellResult shell = build_shell_from_level_set(*squeezed, quick_options());
    EXPECT_NE(shell.report.field.origin.find("no cubes"), std::string::npos);
    EXPECT_TRUE(shell.report.certificate->certified());
    EXPECT_NEAR(shell.report.solid_volume, 8.0 / 3.0 * M_PI, 0.2);
}

TEST(PipelineOfLevelSet, RefusesAWrap)
{
    ShellOptions options = quick_options();
    options.wrap.wanted = true;
    EXPECT_THROW(build_shell_from_level_set(*test::sphere_field(0.3), options), InvalidOption);
}

TEST(PipelineOfLevelSet, CanBeCancelled)
{
    const auto field = test::sphere_field(0.3);
    test::expect_cancelled([&](Interrupter* interrupter) {
        build_shell_from_level_set(*field, quick_options(), "ball", nullptr, interrupter);
    });
}

struct StopAfter : Interrupter {
    explicit StopAfter(int questions) : left(questions) {}
    void start(const char*) override { begun_late += left < 0; }
    void end() override {}
    bool wasInterrupted(int) override { return --left < 0; }
    int left, begun_late = 0;
};

// Whichever stage is told to stop, what comes after it must not begin.
TEST(Pipeline, CanBeCancelledAtEveryStage)
{
    const TriangleMesh mesh = test::icosphere(1.0, 2);
    ShellOptions options = quick_options();
    options.layers.layers = 2;
    for (int questions = 0; questions < 1 << 30; questions = 2 * questions + 1) {
        StopAfter interrupter(questions);
        try {
            build_shell(mesh, options, "ball", nullptr, &interrupter);
        } catch (const Cancelled&) {
            EXPECT_EQ(interrupter.begun_late, 0) << questions;
            continue;
        }
        EXPECT_GE(interrupter.left, 0) << "told to stop, and not stopped";
        EXPECT_GT(questions, 100);
        return;
    }
    FAIL() << "never at an end";
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "core/grid_instances.h"
#include "field/deep_field.h"
#include "mesh/nearest_on_triangle.h"
#include "step/march.h"
#include "support/files.h"
#include "support/shapes.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/field/narrow_band.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/step/line_step.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

const std::vector<StopTest> kTests{StopTest::normal, StopTest::start_gradient, StopTest::distance,
                                   StopTest::relative_normal, StopTest::own_sheet};

/// A mesh, its narrow band and its directions.
struct SparseStage {
    TriangleMesh mesh;
    openvdb::FloatGrid::Ptr band;
    Directions directions;
    double voxel;

    LineLengths step(const LineStepOptions& options, const openvdb::FloatGrid* grid = nullptr) const
    {
        return line_step_sparse(mesh, *band, directions, options, grid);
    }
    LineLengths step(StopTest test) const
    {
        LineStepOptions options;
        options.test = test;
        return step(options);
    }
};

SparseStage sparse_stage_of(const TriangleMesh& mesh, int resolution)
{
    LevelSetOptions options;
    options.resolution = resolution;
    SparseStage stage{mesh, mesh_to_narrow_band(mesh, options), {}, 0};
    stage.directions = compute_directions(mesh, *stage.band, {});
    stage.voxel = stage.band->voxelSize()[0];
    return stage;
}

TEST(SparseStep, StepsFromTheVerticesAskedForAlone)
{
    const SparseStage stage = sparse_stage_of(test::torus(2.0, 0.8, 24, 12), 96);
    const std::vector<std::uint32_t> only{3, 4, 100, 287};
    for (const bool sparse : {true, false}) {
        LevelSetOptions deep;
        deep.resolution = 96;
        const openvdb::FloatGrid::Ptr field =
            sparse ? stage.band : mesh_to_level_set(stage.mesh, deep);
        const auto step = [&](const std::vector<std::uint32_t>* from) {
            return sparse ? line_step_sparse(stage.mesh, *field, stage.directions, {}, nullptr,
                                             nullptr, from)
                          : line_step(stage.mesh, *field, stage.directions, {}, nullptr, nullptr,
                                      from);
        };
        const LineLengths whole = step(nullptr), some = step(&only);
        for (std::uint32_t v = 0; v < stage.mesh.points.size(); ++v) {
            const bool listed = std::find(only.begin(), only.end(), v) != only.end();
            EXPECT_EQ(some.length[v], listed ? whole.length[v] : 0.0);
            EXPECT_EQ(some.steps[v], listed ? whole.steps[v] : 0U);
            EXPECT_EQ(some.reason[v], listed ? whole.reason[v] : StopReason::none);
        }
    }
}

struct Differences {
    double median = 0, most = 0;
};

/// |a - b| in voxels over the vertices that count.
Differences differences(const std::vector<double>& a, const std::vector<double>& b, double voxel,
                        const std::vector<std::uint8_t>& counts = {})
{
    std::vector<double> all;
    for (std::size_t v = 0; v < a.size(); ++v)
        if (counts.empty() || counts[v])
            all.push_back(std::abs(a[v] - b[v]) / voxel);
    if (all.empty())
        return {};
    std::sort(all.begin(), all.end());
    return {all[all.size() / 2], all.back()};
}

TEST(SparseStep, CoarserSurfaceIsTheSameFromAfar)
{
    // Edges of a fifth of a voxel, and of two fifths: half as many around and along.
    const SparseStage stage = sparse_stage_of(test::torus(2.0, 0.8, 320, 160), 48);
    const TriangleMesh far = test::torus(2.0, 0.8, 160, 80);
    std::vector<std::uint32_t> only;
    for (std::uint32_t v = 0; v < stage.mesh.points.size(); v += 101)
        only.push_back(v);
    const auto step = [&](const TriangleMesh* from_afar) {
        return line_step_sparse(stage.mesh, *stage.band, stage.directions, {}, nullptr, nullptr,
                                &only, from_afar);
    };
    const std::vector<double> near = step(nullptr).length, there = step(&far).length;
    std::vector<std::uint8_t> stepped(near.size(), 0);
    for (const std::uint32_t v : only) {
        stepped[v] = 1;
        EXPECT_GT(near[v], 0.5);
    }
    // Lengths are whole steps of half a voxel.
    const Differences off = differences(near, there, stage.voxel, stepped);
    EXPECT_EQ(off.median, 0.0);
    EXPECT_LE(off.most, 0.501);
    EXPECT_NE(near, there);
}

LineLengths dense_lengths(const SparseStage& stage, int resolution, StopTest test)
{
    LevelSetOptions dense;
    dense.resolution = resolution;
    const auto field = mesh_to_level_set(stage.mesh, dense);
    LineStepOptions options;
    options.test = test;
    return line_step(stage.mesh, *field, stage.directions, options);
}

TEST(SparseStep, LinesEndWhereTheMedialAxisIs)
{
    const double r = 0.4;
    const SparseStage sphere = sparse_stage_of(test::icosphere(r, 3), 256);
    for (const double length : sphere.step(StopTest::normal).length)
        EXPECT_NEAR(length, r, 4 * sphere.voxel);
    const SparseStage torus = sparse_stage_of(test::torus(1, r, 96, 64), 256);
    for (const double length : torus.step(StopTest::normal).length)
        EXPECT_NEAR(length, r, 4 * torus.voxel);

    const SparseStage box = sparse_stage_of(test::gridded_box(Vec3d(0), Vec3d(1, 1, 0.5), 8), 256);
    const LineLengths lengths = box.step(StopTest::normal);
    int inner = 0;
    for (std::size_t v = 0; v < box.mesh.points.size(); ++v) {
        // Off the creases, half the way to the wall across or to the crease's own sheet.
        std::array<double, 3> off{};
        const Vec3d p(box.mesh.points[v]), size(1, 1, 0.5);
        for (int k = 0; k < 3; ++k)
            off[std::size_t(k)] = std::min(p[k], size[k] - p[k]);
        if (std::count_if(off.begin(), off.end(), [](double x) { return x < 1e-6; }) != 1)
            continue;
        double exact = 1;
        for (int k = 0; k < 3; ++k)
            exact = std::min(exact, off[std::size_t(k)] < 1e-6 ? size[k] / 2 : off[std::size_t(k)]);
        EXPECT_NEAR(lengths.length[v], exact, 3 * box.voxel) << "vertex " << v;
        ++inner;
    }
    EXPECT_GT(inner, 200);
}

TEST(SparseStep, LengthsAreThoseOfTheDenseField)
{
    for (const TriangleMesh& mesh : {test::icosphere(0.4, 3), test::torus(1, 0.4, 48, 32)}) {
        const SparseStage stage = sparse_stage_of(mesh, 96);
        for (const StopTest test :
             {StopTest::normal, StopTest::start_gradient, StopTest::distance}) {
            const Differences found = differences(
                stage.step(test).length, dense_lengths(stage, 96, test).length, stage.voxel);
            EXPECT_LE(found.median, 0.5);
            EXPECT_LE(found.most, 2.0);
        }
    }
}

/// Steps through the same voxels one by one.
LineLengths look_at_every_step(const SparseStage& stage, StopTest test)
{
    MarchRules rules;
    rules.test = test;
    rules.sheet_cosine = std::cos(LineStepOptions{}.sheet_angle_radians);
    rules.step = 0.5 * stage.voxel;
    rules.distance_threshold = stage.voxel;
    rules.reference = 1.5 * stage.voxel;
    rules.period = 1.7320508 * stage.voxel;
    rules.entry = 1.5 * stage.voxel;
    const std::vector<double> slopes = own_sheet_slopes(stage.mesh, stage.directions);
    const DeepField deep(stage.mesh, *stage.band);
    DeepSampler field(stage.band->transform(), DeepVoxels(deep));
    LineLengths lengths;
    for (std::size_t v = 0; v < stage.mesh.points.size(); ++v) {
        Line line{Vec3d(stage.mesh.points[v]), stage.directions.inward[v]};
        if (test == StopTest::own_sheet)
            line.own_slope = slopes[v];
        const LineEnd end = step_one(field, line, rules);
        lengths.length.push_back(end.length);
        lengths.steps.push_back(end.steps);
        lengths.reason.push_back(end.reason);
    }
    return lengths;
}

TEST(SparseStep, SkippingAheadChangesNothing)
{
    const std::vector<openvdb::Vec2d> notched{{0, 0}, {1, 0}, {1, 1}, {0.55, 0.6}, {0, 1}};
    for (const TriangleMesh& mesh :
         {test::icosphere(0.4, 3), test::torus(1, 0.4, 30, 12),
          test::gridded_box(Vec3d(0), Vec3d(1, 1, 0.5), 6),
          test::turned(test::extruded(notched, {0, 0.3, 1}), Vec3d(1, 2, 3).unit(), 0.7)}) {
        const SparseStage stage = sparse_stage_of(mesh, 80);
        for (const StopTest test : kTests) {
            const LineLengths all = look_at_every_step(stage, test), skipped = stage.step(test);
            EXPECT_EQ(skipped.length, all.length) << int(test);
            EXPECT_EQ(skipped.steps, all.steps) << int(test);
            EXPECT_EQ(skipped.reason, all.reason) << int(test);
        }
    }
}

double distance_to_all(const TriangleMesh& mesh, const Vec3d& point)
{
    double least = std::numeric_limits<double>::max();
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const std::array<Vec3d, 3> corners{Vec3d(mesh.points[t[0]]), Vec3d(mesh.points[t[1]]),
                                           Vec3d(mesh.points[t[2]])};
        least = std::min(least, (nearest_on_triangle(corners, point).point - point).length());
    }
    return least;
}

TEST(SparseStep, DeepVoxelsAreTheDistanceWhateverWasAskedBefore)
{
    for (const TriangleMesh& mesh : {test::icosphere(0.4, 4), test::torus(1, 0.4, 90, 31),
                                     test::turned(test::gridded_box(Vec3d(0), Vec3d(1, 1, 0.5), 9),
                                                  Vec3d(1, 2, 3).unit(), 0.7)}) {
        const SparseStage stage = sparse_stage_of(mesh, 64);
        const DeepField deep(stage.mesh, *stage.band);
        std::vector<openvdb::Coord> voxels;
        for (openvdb::Coord at(-40); at[0] < 40; at[0] += 3)
            for (at[1] = -40; at[1] < 40; at[1] += 5)
                for (at[2] = -40; at[2] < 40; at[2] += 4)
                    voxels.push_back(at);
        TriangleTree::Nearby nearby;
        std::vector<float> forwards, backwards;
        for (const openvdb::Coord& at : voxels)
            forwards.push_back(deep.value(at, at.offsetBy(-1, 0, 0), nearby));
        for (std::size_t i = voxels.size(); i-- > 0;)
            backwards.push_back(deep.value(voxels[i], voxels[i].offsetBy(0, 1, 0), nearby));
        std::reverse(backwards.begin(), backwards.end());
        EXPECT_EQ(forwards, backwards);
        for (std::size_t i = 0; i < voxels.size(); i += 7)
            EXPECT_NEAR(-forwards[i], distance_to_all(mesh, stage.voxel * voxels[i].asVec3d()),
                        1e-3 * stage.voxel);
    }
}

TEST(SparseStep, KeepsToTheThickness)
{
    const SparseStage stage = sparse_stage_of(test::icosphere(0.4, 3), 128);
    LineStepOptions options;
    options.thickness = 0.2341;
    auto grid = openvdb::FloatGrid::create(0.123F);
    for (const double length : stage.step(options).length)
        EXPECT_EQ(length, 0.2341);
    for (const double length : stage.step(options, grid.get()).length)
        EXPECT_EQ(length, double(0.123F));
}

TEST(SparseStep, SameBitsForAnyNumberOfThreads)
{
    const SparseStage stage = sparse_stage_of(test::torus(1, 0.4, 60, 30), 128);
    for (const StopTest test : kTests) {
        const LineLengths all = stage.step(test);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        const LineLengths alone = stage.step(test);
        EXPECT_EQ(all.length, alone.length);
        EXPECT_EQ(all.steps, alone.steps);
        EXPECT_EQ(all.reason, alone.reason);
    }
}

TEST(SparseStep, StopsAtTheWallsOfACavity)
{
    const double outer = 1, hole = 0.4;
    const TriangleMesh mesh =
        test::joined(test::icosphere(outer, 3), test::reversed(test::icosphere(hole, 3)));
    const SparseStage stage = sparse_stage_of(mesh, 192);
    for (const double length : stage.step(StopTest::normal).length)
        EXPECT_NEAR(length, (outer - hole) / 2, 4 * stage.voxel);
}

ShellResult raw_shell(const TriangleMesh& mesh, FieldRoute route, int resolution = 256)
{
    ShellOptions options;
    options.grow.method = Method::raw;
    options.level_set.resolution = resolution;
    options.coverage.samples = 0;
    options.field = route;
    return build_shell(mesh, options);
}

/// Vertices all of whose prisms are certified.
std::vector<std::uint8_t> certified_vertices(const ShellResult& shell)
{
    std::vector<std::uint8_t> good(shell.surface.points.size(), 1);
    if (!shell.report.overlaps)
        return good;
    std::vector<int> tets(shell.surface.triangles.size(), 0);
    for (std::size_t t = 0; t < shell.tets.tets.size(); ++t)
        tets[shell.tets.prism[t]] += shell.report.overlaps->certified[t];
    for (std::size_t f = 0; f < tets.size(); ++f)
        for (int k = 0; k < 3 && tets[f] < 3; ++k)
            good[shell.surface.triangles[f][k]] = 0;
    return good;
}

TEST(SparseStep, RealMeshesWithinTwoVoxelsWhereCertified)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const char* name : {"paper/sphere.obj", "paper/teapot.obj", "artist/fandisk.obj"}) {
        const TriangleMesh mesh = read_mesh(test::real_meshes() / name, {}).mesh;
        const ShellResult dense = raw_shell(mesh, FieldRoute::dense);
        const ShellResult sparse = raw_shell(mesh, FieldRoute::sparse);
        ASSERT_TRUE(sparse.report.field.sparse);
        std::vector<std::uint8_t> both = certified_vertices(dense);
        const std::vector<std::uint8_t> other = certified_vertices(sparse);
        for (std::size_t v = 0; v < both.size(); ++v)
            both[v] = both[v] && other[v];
        const double voxel = dense.report.field.voxel_size;
        EXPECT_LT(differences(sparse.lengths.length, dense.lengths.length, voxel).median, 0.5)
            << name;
        EXPECT_LE(differences(sparse.lengths.length, dense.lengths.length, voxel, both).most, 2.0)
            << name;
    }
}

} // namespace
} // namespace vdb_shell

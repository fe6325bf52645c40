// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/step/line_step.h"

#include "core/grid_instances.h"
#include "field/field_sampler.h"
#include "step/march.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/field/level_set.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using ::testing::HasSubstr;

/// A mesh, its field and its directions.
struct Stage {
    TriangleMesh mesh;
    openvdb::FloatGrid::Ptr field;
    Directions directions;
    double voxel;

    LineLengths step(const LineStepOptions& options, const openvdb::FloatGrid* grid = nullptr) const
    {
        return line_step(mesh, *field, directions, options, grid);
    }
    LineLengths step(StopTest test) const
    {
        LineStepOptions options;
        options.test = test;
        return step(options);
    }
};

Stage stage_of(const TriangleMesh& mesh, int resolution, LevelSetOptions options = {})
{
    options.resolution = resolution;
    Stage stage{mesh, mesh_to_level_set(mesh, options), {}, 0};
    stage.directions = compute_directions(mesh, *stage.field, {});
    stage.voxel = stage.field->voxelSize()[0];
    return stage;
}

/// The infinite slab |z| <= 1, as a formula.
struct Slab {
    FieldSample at(const Vec3d& p) const
    {
        return {std::abs(p[2]) - 1,
                Vec3d(0, 0,
                      p[2] > 0   ? 1
                      : p[2] < 0 ? -1
                                 : 0),
                std::abs(p[2]) >= band_end};
    }
    double band_end = 0;
};

MarchRules rules_of_slab(StopTest test)
{
    MarchRules rules;
    rules.test = test;
    rules.step = 0.0625;
    rules.distance_threshold = 0.1;
    rules.reference = 0.2;
    rules.period = 0.2;
    rules.entry = 0.2;
    rules.search_depth = 5;
    rules.interval = 1e-6;
    rules.bisection_iterations = 100;
    return rules;
}

const Line kDown{Vec3d(0, 0, 1), Vec3d(0, 0, -1)};

TEST(MarchLine, StopsAtTheLastStepBeforeTheMiddleOfASlab)
{
    Slab slab;
    for (const auto test : {StopTest::normal, StopTest::start_gradient, StopTest::relative_normal,
                            StopTest::own_sheet}) {
        const LineEnd end = step_one(slab, kDown, rules_of_slab(test));
        EXPECT_EQ(end.length, 1 - 0.0625);
        EXPECT_EQ(end.steps, 16u);
        EXPECT_EQ(end.reason, StopReason::stop_test);
    }
}

TEST(MarchLine, DistanceAndBisectionPassTheMiddleByHalfTheirThreshold)
{
    // Past the middle |e + phi| = 2 (e - 1): over 0.1 from e = 1.05 on.
    Slab slab;
    EXPECT_EQ(step_one(slab, kDown, rules_of_slab(StopTest::distance)).length, 1.0);
    const LineEnd end = step_one(slab, kDown, rules_of_slab(StopTest::bisection));
    EXPECT_NEAR(end.length, 1.05, 2e-6);
    EXPECT_EQ(end.reason, StopReason::converged);
}

TEST(MarchLine, BisectionHonoursItsIterationLimit)
{
    Slab slab;
    MarchRules rules = rules_of_slab(StopTest::bisection);
    rules.bisection_iterations = 4;
    const LineEnd end = step_one(slab, kDown, rules);
    EXPECT_EQ(end.reason, StopReason::iterations);
    EXPECT_EQ(end.steps, 5u);
    EXPECT_NEAR(end.length, 1.05, 5.0 / 16);
}

TEST(MarchLine, ReachesAThicknessExactly)
{
    Slab slab;
    Line line = kDown;
    line.max_length = 0.7;
    for (const auto test : {StopTest::normal, StopTest::distance, StopTest::bisection,
                            StopTest::relative_normal, StopTest::own_sheet, StopTest::none}) {
        const LineEnd end = step_one(slab, line, rules_of_slab(test));
        EXPECT_EQ(end.length, 0.7);
        EXPECT_EQ(end.reason, StopReason::thickness);
    }
    line.max_length = 0;
    EXPECT_EQ(step_one(slab, line, rules_of_slab(StopTest::normal)).length, 0);
}

TEST(MarchLine, NamesTheEndOfTheBandAndOfTheSolid)
{
    Slab shallow{0.5};
    const LineEnd band = step_one(shallow, kDown, rules_of_slab(StopTest::normal));
    EXPECT_EQ(band.reason, StopReason::left_band);
    EXPECT_EQ(band.length, 0.5);

    Slab slab;
    MarchRules careless = rules_of_slab(StopTest::distance);
    careless.distance_threshold = 100;
    const LineEnd solid = step_one(slab, kDown, careless);
    EXPECT_EQ(solid.reason, StopReason::left_solid);
    EXPECT_EQ(solid.length, 2.0);

    const LineEnd away = step_one(slab, {Vec3d(0, 0, 1), Vec3d(0, 0, 1)}, careless);
    EXPECT_EQ(away.reason, StopReason::left_solid);
    EXPECT_EQ(away.length, 0);
    EXPECT_EQ(step_one(slab, {Vec3d(0, 0, 1), Vec3d(0.0)}, careless).reason,
              StopReason::no_direction);
}

TEST(FieldSampler, IsExactOnALinearField)
{
    const auto grid = openvdb::FloatGrid::create();
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    const Vec3d slope(0.25, -0.5, 1.0);
    for (int i = -4; i < 8; ++i)
        for (int j = -4; j < 8; ++j)
            for (int k = -4; k < 8; ++k)
                grid->tree().setValue({i, j, k},
                                      static_cast<float>(slope.dot(0.5 * Vec3d(i, j, k)) + 2));
    FieldSampler sampler(*grid);
    for (const Vec3d& p : {Vec3d(0.1, 0.2, 0.3), Vec3d(0.0), Vec3d(1.3, -0.7, 2.45)}) {
        const FieldSample sample = sampler.at(p);
        EXPECT_TRUE(sample.in_band);
        EXPECT_NEAR(sample.phi, slope.dot(p) + 2, 1e-14);
        EXPECT_LT((sample.gradient - slope).length(), 1e-13);
    }
    EXPECT_FALSE(sampler.at(Vec3d(3.4, 0, 0)).in_band);
}

TEST(LineStep, ReachesTheCentreOfASphere)
{
    const Stage stage = stage_of(test::icosphere(1, 3), 64);
    for (const auto test : {StopTest::normal, StopTest::start_gradient, StopTest::relative_normal,
                            StopTest::own_sheet}) {
        // The narrowest test feels the turning gradient first.
        const double early = (test == StopTest::own_sheet ? 4 : 3) * stage.voxel;
        const LineLengths lengths = stage.step(test);
        for (const double length : lengths.length) {
            EXPECT_GT(length, 1 - early);
            EXPECT_LT(length, 1 + 0.5 * stage.voxel);
        }
        EXPECT_THAT(lengths.reason, ::testing::Each(StopReason::stop_test));
    }
}

TEST(LineStep, ReachesTheMiddleCircleOfATorus)
{
    const Stage stage = stage_of(test::torus(1, 0.4, 64, 32), 96);
    for (const double length : stage.step(StopTest::normal).length) {
        EXPECT_GT(length, 0.4 - 3 * stage.voxel);
        EXPECT_LT(length, 0.4 + 0.5 * stage.voxel);
    }
}

TEST(LineStep, NormalTestSticksAtTheCornersOfABoxAndTheRelativeOneReachesTheMiddle)
{
    const double half = 0.5;
    // Off the lattice, so that no voxel centre lies on a face or on the diagonals.
    const Vec3d shift(0.0031, 0.0072, 0.0013);
    const Stage stage = stage_of(test::box(Vec3d(-half) + shift, Vec3d(half) + shift), 64);
    EXPECT_THAT(stage.step(StopTest::normal).length, ::testing::Each(0.0));
    for (const double length : stage.step(StopTest::relative_normal).length) {
        EXPECT_GT(length, std::sqrt(3.0) * half - 6 * stage.voxel);
        EXPECT_LT(length, std::sqrt(3.0) * half + stage.voxel);
    }
}

TEST(LineStep, FacesOfASlabStopAtItsMiddleSheet)
{
    const Stage stage = stage_of(test::gridded_box(Vec3d(0.0), Vec3d(1, 1, 0.25), 8), 64);
    const LineLengths lengths = stage.step(StopTest::normal);
    int seen = 0;
    for (std::size_t v = 0; v < lengths.length.size(); ++v) {
        const Vec3d p(stage.mesh.points[v]);
        if (std::max(std::abs(p[0] - 0.5), std::abs(p[1] - 0.5)) > 0.3)
            continue;
        ++seen;
        EXPECT_GT(lengths.length[v], 0.125 - 3 * stage.voxel);
        EXPECT_LE(lengths.length[v], 0.125);
    }
    EXPECT_GT(seen, 10);
}

TEST(LineStep, KeepsToANumberAndToAPaintedThickness)
{
    const Stage stage = stage_of(test::icosphere(1, 3), 32);
    LineStepOptions options;
    options.thickness = 0.3;
    EXPECT_THAT(stage.step(options).length, ::testing::Each(0.3));

    // Painted by height, on a coarse lattice of its own: linear, so sampled exactly.
    const auto paint = openvdb::FloatGrid::create(0.0f);
    paint->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    for (int i = -6; i <= 6; ++i)
        for (int j = -6; j <= 6; ++j)
            for (int k = -6; k <= 6; ++k)
                paint->tree().setValue({i, j, k}, 0.25f + 0.03125f * static_cast<float>(k));
    const LineLengths lengths = stage.step(options, paint.get());
    for (std::size_t v = 0; v < lengths.length.size(); ++v) {
        const double painted = 0.25 + 0.125 * static_cast<double>(stage.mesh.points[v][2]);
        EXPECT_NEAR(lengths.length[v], std::min(0.3, painted), 1e-6);
        EXPECT_EQ(lengths.reason[v], StopReason::thickness);
    }
}

TEST(LineStep, NamesTheVertexOfABadPaintedThickness)
{
    const Stage stage = stage_of(test::icosphere(1, 1), 16);
    for (const float bad : {-1.0f, std::nanf(""), INFINITY}) {
        const auto paint = openvdb::FloatGrid::create(bad);
        paint->setName("thick");
        try {
            stage.step({}, paint.get());
            FAIL();
        } catch (const GeometryError& error) {
            EXPECT_THAT(error.what(), HasSubstr("thickness grid 'thick'"));
            EXPECT_THAT(error.what(), HasSubstr("at vertex 0 "));
        }
    }
}

TEST(LineStep, SaysWhenTheBandIsTooShallow)
{
    LevelSetOptions shallow;
    shallow.interior_depth = 0.3;
    const Stage stage = stage_of(test::icosphere(1, 3), 64, shallow);
    const LineLengths lengths = stage.step(StopTest::normal);
    EXPECT_THAT(lengths.reason, ::testing::Each(StopReason::left_band));
    for (const double length : lengths.length)
        EXPECT_GT(length, 0.3 - stage.voxel);
    // The depth asked for is the depth that can be stepped.
    LineStepOptions options;
    options.thickness = 0.3;
    EXPECT_THAT(stage.step(options).length, ::testing::Each(0.3));
}

TEST(LineStep, WithoutATestOnlyTheThicknessBounds)
{
    const Stage stage = stage_of(test::icosphere(1, 1), 16);
    EXPECT_TRUE(std::isinf(stage.step(StopTest::none).length[0]));
    LineStepOptions options;
    options.test = StopTest::none;
    options.thickness = 7;
    EXPECT_THAT(stage.step(options).length, ::testing::Each(7.0));
}

TEST(LineStep, NothingIsReadBeyondTheNumbersOfVoxels)
{
    const Stage stage = stage_of(test::icosphere(1, 1), 16);
    FieldSampler field(*stage.field);
    for (const double far : {1e9, 1e300, HUGE_VAL})
        for (const Vec3d& p : {Vec3d(far, 0, 0), Vec3d(0, -far, 0), Vec3d(far)}) {
            EXPECT_FALSE(field.at(p).in_band);
            EXPECT_EQ(field.at(p).gradient, Vec3d(0.0));
        }
}

TEST(LineStep, SameBitsForAnyNumberOfThreads)
{
    const Stage stage = stage_of(test::torus(1, 0.4, 60, 30), 48);
    const auto made_by = [&](std::size_t threads, StopTest test) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return stage.step(test);
    };
    for (const auto test :
         {StopTest::normal, StopTest::relative_normal, StopTest::bisection, StopTest::own_sheet}) {
        const LineLengths one = made_by(1, test);
        for (const std::size_t threads : {2, 7}) {
            const LineLengths other = made_by(threads, test);
            EXPECT_EQ(one.length, other.length);
            EXPECT_EQ(one.steps, other.steps);
            EXPECT_EQ(one.reason, other.reason);
        }
    }
}

TEST(LineStep, RefusesOptionsOutOfRange)
{
    const Stage stage = stage_of(test::icosphere(1, 1), 16);
    const auto refused = [&](const std::function<void(LineStepOptions&)>& change) -> std::string {
        LineStepOptions options;
        change(options);
        try {
            stage.step(options);
        } catch (const InvalidOption& error) {
            return error.what();
        }
        return "nothing thrown";
    };
    EXPECT_THAT(refused([](auto& o) { o.rho = 1; }), HasSubstr("rho is 1"));
    EXPECT_THAT(refused([](auto& o) { o.rho = -0.5; }), HasSubstr("rho is -0.5"));
    EXPECT_THAT(refused([](auto& o) { o.step_voxels = 0; }), HasSubstr("step_voxels is 0"));
    EXPECT_THAT(refused([](auto& o) { o.distance_threshold_voxels = NAN; }), HasSubstr("nan"));
    EXPECT_THAT(refused([](auto& o) { o.bisection_iterations = 0; }), HasSubstr("iterations is 0"));
    EXPECT_THAT(refused([](auto& o) { o.reference_voxels = -1; }), HasSubstr("voxels is -1"));
    EXPECT_THAT(refused([](auto& o) { o.thickness = -2; }), HasSubstr("thickness is -2"));
    EXPECT_THAT(refused([](auto& o) { o.sheet_angle_radians = 0; }), HasSubstr("radians is 0"));
    EXPECT_THAT(refused([](auto& o) { o.sheet_angle_radians = 1.5; }), HasSubstr("radians is 1.5"));
}

struct StopsAtOnce : Interrupter {
    bool wasInterrupted(int) override { return true; }
};

TEST(LineStep, StopsWhenItIsAskedTo)
{
    const Stage stage = stage_of(test::icosphere(1, 1), 16);
    StopsAtOnce interrupter;
    EXPECT_THROW(line_step(stage.mesh, *stage.field, stage.directions, {}, nullptr, &interrupter),
                 Cancelled);
}

TEST(StopReasons, AllHaveNames)
{
    for (int i = 0; i < kStopReasonCount; ++i)
        EXPECT_STRNE(name_of(static_cast<StopReason>(i)), "");
    EXPECT_STREQ(name_of(StopReason::left_band), "left_band");
}

} // namespace
} // namespace vdb_shell

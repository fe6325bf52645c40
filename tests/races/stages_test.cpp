// SPDX-License-Identifier: Apache-2.0

// The stages with parallel loops, one after the other on small surfaces, for the thread sanitizer:
// it looks at the order of accesses and not at results, so each runs once, with several threads.

#include "support/shapes.h"
#include "support/stacks.h"
#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/field/narrow_band.h"
#include "vdb_shell/field/smooth.h"
#include "vdb_shell/field/wrap.h"
#include "vdb_shell/layers/cut_layers.h"
#include "vdb_shell/layers/scale_thickness.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/shell/quality.h"
#include "vdb_shell/step/limits.h"

#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

namespace
{

using namespace vdb_shell;

class Races : public testing::Test
{
    // More than the machine may have, so that loops are shared on any.
    tbb::global_control threads_{tbb::global_control::max_allowed_parallelism, 4};
};

LevelSetOptions at_resolution(int resolution)
{
    LevelSetOptions options;
    options.resolution = resolution;
    return options;
}

TEST_F(Races, FieldAndSteps)
{
    const TriangleMesh mesh = test::torus(1, 0.4, 40, 20);
    const auto field = mesh_to_level_set(mesh, at_resolution(24));
    smooth_level_set(*field, mesh, {/*iterations*/ 1});
    const Directions directions = compute_directions(mesh, *field, {});
    for (const StopTest test : {StopTest::normal, StopTest::bisection, StopTest::own_sheet}) {
        LineStepOptions options;
        options.test = test;
        LineLengths lines = line_step(mesh, *field, directions, options);
        EXPECT_EQ(lines.length.size(), mesh.points.size());
        apply_limits(lines, vertex_limits(mesh, directions, Limit::adaptive));
        EXPECT_FALSE(extrude(mesh, directions, lines).inner.empty());
    }
}

TEST_F(Races, NarrowBand)
{
    EXPECT_GT(mesh_to_narrow_band(test::bumpy_sphere(3), at_resolution(24))->activeVoxelCount(),
              0U);
}

TEST_F(Races, ChecksAndWrap)
{
    const TriangleMesh mesh = test::joined(test::gridded_box({0, 0, 0}, {2, 2, 2}, 6),
                                           test::gridded_box({1, 1, 1}, {3, 3, 3}, 6));
    EXPECT_FALSE(check_mesh(mesh).embedded());
    WrapOptions options;
    options.resolution = 12;
    EXPECT_TRUE(check_mesh(wrap_mesh(mesh, options).mesh).closed());
}

TEST_F(Races, GrowthFromCoarse)
{
    GrowOptions options = test::by_method(Method::thickest);
    options.coarse_from = 1;
    options.schedule.multilevel.coarsest_triangles = 160;
    options.free_rounds = 2;
    options.min_quality = 0.1;
    const TriangleMesh mesh = test::trefoil(90, 8);
    ASSERT_FALSE(coarse_levels(mesh, options).empty());
    const GrowResult grown = test::grown(mesh, options);
    const ShellStack stack = one_layer(grown.shell, grown.split);
    EXPECT_TRUE(certify_stack(stack, PrismTest::chosen_tets).certified());
    const TetMesh tets = make_tets(grown.shell, grown.split);
    EXPECT_EQ(count_tet_signs(tets).inverted.count, 0U);
    EXPECT_GT(measure_quality(tets).mean_ratio.min, 0);
}

TEST_F(Races, GrowthAlongLinesAndLayers)
{
    GrowOptions options = test::by_method(Method::certified);
    options.free_rounds = 2;
    GrowResult grown = test::grown(test::trefoil(60, 8), options);
    ScaleOptions scale;
    scale.factor = 0.7;
    scale_thickness(grown.shell, grown.split, scale, PrismTest::twelve_tets);
    LayerOptions layers;
    layers.layers = 3;
    const ShellStack stack =
        cut_layers(one_layer(grown.shell, grown.split), layers, PrismTest::twelve_tets).stack;
    EXPECT_TRUE(certify_stack(stack, PrismTest::twelve_tets).certified());
    CoverageOptions coverage;
    coverage.samples = 500;
    EXPECT_EQ(estimate_coverage(TriangleMesh{grown.shell.outer, grown.shell.triangles},
                                make_tets(grown.shell, grown.split), coverage)
                  .in_several,
              0U);
}

} // namespace

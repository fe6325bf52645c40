// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/taper/wanted_bounds.h"

#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ShellOptions tapered_with_samples()
{
    ShellOptions options;
    options.level_set.resolution = 48;
    options.coverage.samples = 1000;
    options.taper.wanted = true;
    return options;
}

BoundsReport judge(const ShellResult& r, const WantedBounds& wanted)
{
    return judge_bounds(r.stack, r.tets, r.surface, Side::inward,
                        std::vector<double>(r.surface.points.size(), kInfinity), wanted);
}

std::size_t count(const WantedBound& bound, ShortCause cause)
{
    return bound.causes[std::size_t(cause)];
}

TEST(WantedBounds, AConedBoxHasTheShapesThatItsGeometrySays)
{
    // Twelve tets from the middle of the box, each on half a face: dihedral angles of 45 degrees at
    // the box's edges, and of 60 degrees at the edges to the middle, next to which the point is.
    const ShellResult box = build_shell(test::box(Vec3d(-1), Vec3d(1)), tapered_with_samples());
    ASSERT_EQ(box.tets.tets.size(), 12U);
    WantedBounds wanted;
    wanted.min_dihedral_radians = M_PI / 4 - 2e-3;
    wanted.fill = 1 - 1e-9;
    wanted.tets = 12;
    EXPECT_TRUE(judge(box, wanted).met());

    wanted = {};
    wanted.min_dihedral_radians = 50 * M_PI / 180;
    const BoundsReport report = judge(box, wanted);
    ASSERT_EQ(report.bounds.size(), 1U);
    const WantedBound& bound = report.bounds[0];
    EXPECT_FALSE(bound.met);
    EXPECT_NEAR(bound.reached, M_PI / 4, 2e-3);
    EXPECT_LT(bound.reached, M_PI / 4);
    EXPECT_EQ(bound.short_tets, 12U);
    // Two tets cannot have more than half a right angle each.
    EXPECT_EQ(count(bound, ShortCause::surface_edge), 12U);
    EXPECT_EQ(bound.first.size(), WantedBound::kFirstShown);
    EXPECT_EQ(bound.first[3].tet, 3U);
    EXPECT_EQ(bound.first[3].prism, box.tets.prism[3]);
}

TEST(WantedBounds, FewerMissedBoundsAreBetterAndThenTheSmallerShare)
{
    const ShellResult box = build_shell(test::box(Vec3d(-1), Vec3d(1)), tapered_with_samples());
    WantedBounds wanted;
    wanted.tets = 4;
    // Eight of the twelve are too many, where a budget may be missed by many times itself.
    EXPECT_DOUBLE_EQ(judge(box, wanted).bounds[0].shortfall, 8.0 / 12);
    wanted.min_dihedral_radians = 50 * M_PI / 180; // that none of them has
    const BoundsReport both = judge(box, wanted);
    wanted.min_dihedral_radians = 10 * M_PI / 180;
    const BoundsReport one = judge(box, wanted);
    EXPECT_EQ(both.bounds[0].shortfall, 1);
    EXPECT_LT(one.shortfall(), both.shortfall());
    wanted.tets = 12;
    EXPECT_EQ(judge(box, wanted).shortfall(), 0);

    // Whatever the shares are.
    const auto missed = [](const std::vector<double>& shares) {
        BoundsReport report;
        for (const double share : shares) {
            WantedBound bound;
            bound.met = share == 0;
            bound.shortfall = share;
            report.bounds.push_back(bound);
        }
        return report.shortfall();
    };
    EXPECT_LT(missed({1, 1, 0, 0}), missed({0.01, 0.01, 0.01, 0}));
    EXPECT_LT(missed({0.2, 0.3, 0, 0}), missed({0, 0, 0.6, 0.1}));
}

TEST(WantedBounds, TrianglesThatAreTooLongAreNamed)
{
    const ShellResult rod =
        build_shell(test::box(Vec3d(0), Vec3d(21, 1, 1)), tapered_with_samples());
    WantedBounds wanted;
    wanted.edge_ratio = 10;
    wanted.amips = 3.0001;
    for (const WantedBound& bound : judge(rod, wanted).bounds) {
        EXPECT_FALSE(bound.met);
        EXPECT_GE(count(bound, ShortCause::surface_triangle), 8U);
        EXPECT_EQ(std::accumulate(bound.causes.begin(), bound.causes.end(), std::size_t(0)),
                  bound.short_tets);
    }
}

TEST(WantedBounds, ThicknessIsTheCauseWhereItHoldsThePillars)
{
    ShellOptions options = tapered_with_samples();
    options.taper.wanted = false;
    options.line_step.thickness = 0.02;
    options.wanted.min_dihedral_radians = 0.3;
    options.wanted.fill = 0.9;
    const ShellResult thin = build_shell(test::icosphere(1, 2), options);
    ASSERT_TRUE(thin.report.wanted);
    EXPECT_FALSE(thin.report.wanted->met());
    const WantedBound& shape = thin.report.wanted->bounds[0];
    EXPECT_EQ(count(shape, ShortCause::thickness), shape.short_tets);
    EXPECT_GT(shape.short_tets, 0U);
    EXPECT_NEAR(thin.report.wanted->bounds[1].reached, thin.report.fill, 1e-9);
}

TEST(WantedBounds, TaperingRunsTowardsABudget)
{
    const TriangleMesh mesh = test::torus(2, 0.7, 32, 16);
    ShellOptions options = tapered_with_samples();
    options.taper.tet_cost = 0;
    const std::size_t plain = build_shell(mesh, options).tets.tets.size();
    const std::size_t budget = (plain + mesh.triangles.size()) / 2;
    options.wanted.tets = budget;
    const ShellResult within = build_shell(mesh, options);
    EXPECT_GT(plain, budget);
    EXPECT_LE(within.tets.tets.size(), budget);
    EXPECT_TRUE(within.report.wanted->met());
    EXPECT_GT(within.report.taper->runs, 1U);
    EXPECT_TRUE(within.report.certificate->certified());
    // Nothing is run again for what the first run has.
    options.wanted.tets = plain;
    EXPECT_EQ(build_shell(mesh, options).report.taper->runs, 1U);
}

TEST(WantedBounds, WhatNoShellHasIsRefused)
{
    const TriangleMesh sphere = test::icosphere(1, 2);
    ShellOptions options = tapered_with_samples();
    options.wanted.tets = sphere.triangles.size() - 1;
    EXPECT_THROW(build_shell(sphere, options), InvalidOption);

    options = tapered_with_samples();
    options.wanted.min_dihedral_radians = 71 * M_PI / 180; // a regular tet has 70.53 degrees
    EXPECT_THROW(require_sensible(options), InvalidOption);
    options = {};
    options.wanted.amips = 5;
    options.grow.method = Method::raw;
    EXPECT_THROW(require_sensible(options), InvalidOption);
    options = {};
    options.wanted.fill = 0.5;
    options.side = Side::outward;
    EXPECT_THROW(require_sensible(options), InvalidOption);
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
// The three situations of the paper's figure 2, as solids: where a line must stop at a symmetry
// sheet, and where it should walk along one.
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/step/line_step.h"

#include "core/grid_instances.h"
#include "support/certificates.h"
#include "support/shapes.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/pipeline.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;
using openvdb::Vec3d;

// Central differences reach one voxel off the point, the interpolation another cell: a sheet is
// felt at up to this distance, and a line that meets it at an angle that much earlier.
constexpr double kStencilVoxels = 2;

double radians(double degrees)
{
    return degrees * M_PI / 180;
}

/// A solid and the one vertex of it that is watched.
struct Situation {
    TriangleMesh mesh;
    std::size_t watched;
};

/// A convex polygon, extruded; the watched corner stands in the middle row, far from both ends.
/// Turned off all axes and moved off the voxels.
Situation situation(const std::vector<Vec2d>& polygon, std::size_t watched, double half_depth)
{
    const TriangleMesh straight = test::extruded(polygon, {-half_depth, 0, half_depth});
    return {
        test::translated(test::turned(straight, Vec3d(1, 2, 3), 0.7), Vec3d(0.0031, 0.0072, 0.013)),
        polygon.size() + watched};
}

/// Figure 2(a): `distance` from a ridge whose sides' normals are `a` apart, on its right side. The
/// sheet rises from the ridge at (pi - a) / 2.
Situation cross_over(double a, double distance)
{
    const Vec2d left(-3 * std::cos(a), 3 * std::sin(a));
    return situation({left, {0, 0}, {distance, 0}, {3, 0}, {3, 5}, {left[0], 5}}, 2, 3);
}

/// Figure 2(b): the middle of a blunt end of width 1, from which the sides open at `b` to the axis.
Situation tentacle(double b)
{
    const double x = 0.5 + 6 * std::sin(b), y = 6 * std::cos(b), top = y + 2 * x;
    return situation({{-0.5, 0}, {0, 0}, {0.5, 0}, {x, y}, {x, top}, {-x, top}, {-x, y}}, 1, 7);
}

/// Figure 2(c): the sharp edge of a wedge of opening 2 b and height 3.
Situation wedge(double b)
{
    const double x = 3 * std::tan(b);
    return situation({{0, 0}, {x, 3}, {-x, 3}}, 0, 3);
}

/// Figure 2(c) again: an edge of a bar 4 wide and 2 high.
Situation bar()
{
    return situation({{0, 0}, {4, 0}, {4, 2}, {0, 2}}, 0, 3);
}

struct Walk {
    double length, voxel;
};

Walk walked(const Situation& s, StopTest test, double rho = 0.9)
{
    LevelSetOptions band;
    band.resolution = 128;
    const auto field = mesh_to_level_set(s.mesh, band);
    LineStepOptions options;
    options.test = test;
    options.rho = rho;
    const LineLengths lengths =
        line_step(s.mesh, *field, compute_directions(s.mesh, *field, {}), options);
    return {lengths.length[s.watched], field->voxelSize()[0]};
}

/// Stops no later than `sheet`, and no earlier than where the stencil first feels the sheet, which
/// the line meets at `angle`.
void expect_stops_at(const Walk& walk, double sheet, double angle)
{
    EXPECT_LE(walk.length, sheet + 0.5 * walk.voxel);
    EXPECT_GE(walk.length, sheet - kStencilVoxels * walk.voxel / std::sin(angle));
}

TEST(OwnSheetSlopes, AreTheDistanceToTheVertexsOwnTriangles)
{
    const TriangleMesh box = test::gridded_box(Vec3d(0.0), Vec3d(1.0), 4);
    Directions directions{pseudo_normals(box), {}};
    for (Vec3d& d : directions.inward)
        d = -d;
    const std::vector<double> slopes = own_sheet_slopes(box, directions);
    for (std::size_t v = 0; v < slopes.size(); ++v) {
        int planes = 0;
        for (int k = 0; k < 3; ++k)
            planes += box.points[v][k] == 0 || box.points[v][k] == 1;
        EXPECT_NEAR(slopes[v], 1 / std::sqrt(planes), 1e-6); // face, edge, corner
    }
}

TEST(OwnSheetSlopes, AreOneInAHollowCornerAndNegativeWhereTheLineLeaves)
{
    // Inside out, every corner of a box is hollow: the line goes away from all its triangles.
    const TriangleMesh hollow = test::reversed(test::box(Vec3d(0.0), Vec3d(1.0)));
    Directions directions{pseudo_normals(hollow), {}};
    for (Vec3d& d : directions.inward)
        d = -d;
    EXPECT_THAT(own_sheet_slopes(hollow, directions), ::testing::Each(1.0));

    const TriangleMesh box = test::box(Vec3d(0.0), Vec3d(1.0));
    directions.inward.assign(8, Vec3d(0.0));
    EXPECT_THAT(own_sheet_slopes(box, directions), ::testing::Each(0.0));
    const TriangleMesh plate = test::gridded_box(Vec3d(0.0), Vec3d(1.0), 2);
    directions.inward = pseudo_normals(plate);
    for (std::size_t v = 0; v < plate.points.size(); ++v)
        if (own_sheet_slopes(plate, directions)[v] >= 0) {
            // Only an edge or corner has triangles that a line outward does not pierce from behind.
            const auto& p = plate.points[v];
            EXPECT_GE(
                (p[0] == 0 || p[0] == 1) + (p[1] == 0 || p[1] == 1) + (p[2] == 0 || p[2] == 1), 2);
        }
}

TEST(SymmetryLines, OwnSheetStopsAtTheSheetOfANeighbouringRidge)
{
    for (const double degrees : {16.0, 20.0, 24.0}) {
        const double a = radians(degrees);
        const Situation s = cross_over(a, 0.25);
        const double sheet = 0.25 / std::tan(a / 2);
        expect_stops_at(walked(s, StopTest::own_sheet), sheet, a / 2);
        // All of these take cos(a) > 0.9 for the same side and go on to the far wall.
        for (const auto test :
             {StopTest::normal, StopTest::start_gradient, StopTest::relative_normal})
            EXPECT_GT(walked(s, test).length, 1.3 * sheet);
    }
}

TEST(SymmetryLines, OwnSheetMakesNoTentacleFromABluntEnd)
{
    // The end's own region is a triangle over it, 0.5 tan(45 + b / 2) high.
    const double steep = radians(70), open = radians(45);
    const double steep_top = 0.5 * std::tan(radians(45) + steep / 2);
    const double open_top = 0.5 * std::tan(radians(45) + open / 2);
    expect_stops_at(walked(tentacle(steep), StopTest::own_sheet), steep_top,
                    radians(45) - steep / 2);
    expect_stops_at(walked(tentacle(open), StopTest::own_sheet), open_top, radians(45) - open / 2);

    // Along the axis the slope is sin b: 0.94 passes eq. 10, 0.71 passes a test of its sign.
    EXPECT_GT(walked(tentacle(steep), StopTest::normal).length, 2 * steep_top);
    EXPECT_GT(walked(tentacle(steep), StopTest::relative_normal).length, 2 * steep_top);
    EXPECT_GT(walked(tentacle(open), StopTest::normal, 0.0).length, 4 * open_top);
}

TEST(SymmetryLines, OwnSheetWalksAlongTheSheetOfACreaseToItsJunction)
{
    // The sheet of an edge ends where the far side is as near: h sqrt 2 in the bar, L / (1 + sin b)
    // in the wedge. A line that has passed it looks back: it is felt head on, not at an angle.
    const double square = radians(90);
    expect_stops_at(walked(bar(), StopTest::own_sheet), std::sqrt(2.0), square);
    for (const double b : {radians(30), radians(60)})
        expect_stops_at(walked(wedge(b), StopTest::own_sheet), 3 / (1 + std::sin(b)), square);
    EXPECT_EQ(walked(bar(), StopTest::normal).length, 0);
    EXPECT_EQ(walked(wedge(radians(30)), StopTest::normal).length, 0);
}

TEST(SymmetryLines, OwnSheetTakesCornersOfABoxToItsMiddle)
{
    const Situation s{
        test::translated(test::turned(test::box(Vec3d(-1), Vec3d(1)), Vec3d(1, 2, 3), 0.7),
                         Vec3d(0.0031, 0.0072, 0.0013)),
        0};
    expect_stops_at(walked(s, StopTest::own_sheet), std::sqrt(3.0), std::asin(1 / std::sqrt(3.0)));
}

TEST(SymmetryLines, GrowthCertifiesAllThreeAndLeavesNoOverlap)
{
    for (const Situation& s : {cross_over(radians(20), 0.25), tentacle(radians(70)),
                               tentacle(radians(45)), bar(), wedge(radians(30))}) {
        ShellOptions options;
        options.level_set.resolution = 48;
        options.coverage.samples = 20000;
        const ShellResult r = build_shell(s.mesh, options);
        EXPECT_TRUE(r.report.certificate->certified());
        EXPECT_EQ(r.report.coverage.in_several, 0u);
        EXPECT_GT(r.report.coverage.covered_share, 0.9);
    }
}

} // namespace
} // namespace vdb_shell

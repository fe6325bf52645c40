// SPDX-License-Identifier: Apache-2.0
#include "write/tet_boundary.h"

#include "support/filled.h"
#include "support/shapes.h"
#include "vdb_shell/shell/core_tets.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

std::size_t count_of(const std::vector<BoundaryTriangle>& triangles, TetBoundary boundary)
{
    return std::size_t(
        std::count_if(triangles.begin(), triangles.end(),
                      [&](const BoundaryTriangle& t) { return t.boundary == boundary; }));
}

/// What the triangles enclose as seen from outside.
double volume_within(const std::vector<openvdb::Vec3s>& points,
                     const std::vector<BoundaryTriangle>& triangles, TetBoundary boundary)
{
    double six_volumes = 0;
    for (const BoundaryTriangle& t : triangles)
        if (t.boundary == boundary)
            six_volumes += Vec3d(points[t.corners[0]])
                               .dot(Vec3d(points[t.corners[1]]).cross(Vec3d(points[t.corners[2]])));
    return six_volumes / 6;
}

/// Ascending, so that the same triangles are the same lists.
std::vector<std::array<std::uint32_t, 3>> sorted(std::vector<std::array<std::uint32_t, 3>> corners)
{
    for (auto& c : corners)
        std::sort(c.begin(), c.end());
    std::sort(corners.begin(), corners.end());
    return corners;
}

TEST(TetBoundary, HasEachOuterAndEachInnerTriangleOnceAsSeenFromOutsideOfTheTets)
{
    // Around the pin the inner triangles have a corner on the outer surface.
    const test::HandMade made = test::hand_made_shell(test::icosphere(1, 2), 0.5, {7});
    const std::vector<BoundaryTriangle> boundary = boundary_of(made.tets);
    std::vector<std::array<std::uint32_t, 3>> outer, inner, wanted;
    for (const BoundaryTriangle& t : boundary) {
        std::array<std::uint32_t, 3> vertices{};
        for (std::size_t k = 0; k < 3; ++k) {
            vertices[k] = made.tets.source_vertex[t.corners[int(k)]];
            // A face of the tet that it is said to be of.
            const openvdb::Vec4I& tet = made.tets.tets[t.tet];
            EXPECT_TRUE(t.corners[int(k)] == tet[0] || t.corners[int(k)] == tet[1] ||
                        t.corners[int(k)] == tet[2] || t.corners[int(k)] == tet[3]);
        }
        (t.boundary == TetBoundary::outer ? outer : inner).push_back(vertices);
        EXPECT_EQ(sorted({vertices})[0],
                  sorted({{made.shell.triangles[made.tets.prism[t.tet]][0],
                           made.shell.triangles[made.tets.prism[t.tet]][1],
                           made.shell.triangles[made.tets.prism[t.tet]][2]}})[0]);
    }
    for (const Vec3I& t : made.shell.triangles)
        wanted.push_back({t[0], t[1], t[2]});
    EXPECT_EQ(sorted(outer), sorted(wanted));
    EXPECT_EQ(sorted(inner), sorted(wanted));
    // Inner triangles look into the void.
    const double within = volume_within(made.tets.points, boundary, TetBoundary::outer),
                 beyond = volume_within(made.tets.points, boundary, TetBoundary::inner);
    EXPECT_LT(beyond, 0);
    EXPECT_NEAR(within + beyond, tet_volume(made.tets), 1e-6);
}

TEST(TetBoundary, IsWhereTheShellEndsAtACoreAndWhereTheCoreHasHoles)
{
    const ShellStack ball = test::hollow_ball();
    const TetMesh shell = make_tets(ball);
    CoreTets core = test::cone_core(ball, shell, {0, 0, 0});
    const std::size_t triangles = ball.triangles().size();
    const std::vector<BoundaryTriangle> full = boundary_of(joined_tets(shell, core));
    EXPECT_EQ(count_of(full, TetBoundary::outer), triangles);
    EXPECT_EQ(count_of(full, TetBoundary::inner), triangles);
    EXPECT_EQ(count_of(full, TetBoundary::hole), 0u);
    for (const BoundaryTriangle& t : full)
        EXPECT_LT(t.tet, shell.tets.size()) << "of the shell, not of the core";

    // A tet of the core fewer: three of its faces are faces of one tet, the fourth is the shell's.
    core.tets.pop_back();
    const std::vector<BoundaryTriangle> open = boundary_of(joined_tets(shell, core));
    EXPECT_EQ(count_of(open, TetBoundary::inner), triangles);
    EXPECT_EQ(count_of(open, TetBoundary::hole), 3u);
}

TEST(TetBoundary, OfACoreAloneIsOutside)
{
    const ShellStack none = test::empty_shell(test::icosphere(1, 1));
    const TetMesh shell = make_tets(none);
    const CoreTets core = test::cone_core(none, shell, {0, 0, 0});
    const std::vector<BoundaryTriangle> boundary = boundary_of(joined_tets(shell, core));
    EXPECT_EQ(count_of(boundary, TetBoundary::outer), none.triangles().size());
    EXPECT_EQ(boundary.size(), none.triangles().size());
    EXPECT_TRUE(boundary_of(TetMesh{}).empty());
}

} // namespace
} // namespace vdb_shell

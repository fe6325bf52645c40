// SPDX-License-Identifier: Apache-2.0
#include "growth/pins.h"

#include "core/stage_progress.h"
#include "growth/initialise.h"
#include "growth/move_tests.h"
#include "growth/predicates.h"
#include "support/shapes.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/step/directions.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace
{

using namespace vdb_shell;

TEST(Pins, AreReleasedWhereTheExactTestsAllowItAndNotWithoutVisibility)
{
    const TriangleMesh ball = test::icosphere(1, 1);
    const Directions directions = directions_along(ball, pseudo_normals(ball));
    const growth::Connectivity mesh = growth::connect(ball.points.size(), ball.triangles);
    const std::vector<double> cap(ball.points.size(), std::numeric_limits<double>::infinity());
    growth::GrowState s = growth::make_state(mesh, ball.points, cap);
    growth::shrink_until_valid(s, directions, std::vector<double>(s.b.size(), 0.5),
                               StageProgress(nullptr, "test"));
    // Neighbours too: each is released beside pins that are not yet.
    for (const int v : {0, 1, 11}) {
        s.pinned[v] = 1;
        s.b[v] = s.a[v];
    }
    EXPECT_EQ(growth::release_pins(s, std::vector<double>(s.b.size(), 0.0)), 0);
    EXPECT_EQ(growth::release_pins(s, directions.visibility), 3);
    for (int f = 0; f < mesh.face_count(); ++f) {
        EXPECT_TRUE(growth::prism_valid(s, f));
        const growth::InnerTriangle triangle(s, f);
        for (int g = 0; g < mesh.face_count(); ++g)
            EXPECT_FALSE(triangle.meets_outer(g) || (g != f && triangle.meets_inner(g)));
    }
    for (const int v : {0, 1, 11})
        EXPECT_NE(s.b[v], s.a[v]);
}

} // namespace

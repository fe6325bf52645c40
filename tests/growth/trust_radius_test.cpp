// SPDX-License-Identifier: Apache-2.0
#include "growth/trust_radius.h"

#include "growth/grown.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace
{

using namespace vdb_shell;

/// Of a ball whose inner surface is nearly flat: inner edges that run inward have all but no
/// length.
growth::GrowState flattened(const growth::Connectivity& mesh, const TriangleMesh& ball)
{
    const std::vector<double> cap(ball.points.size(), test::kInfinity);
    growth::GrowState s = growth::make_state(mesh, ball.points, cap);
    for (openvdb::Vec3d& p : s.b)
        p[2] *= 0.01;
    return s;
}

TEST(TrustRadius, FirstOnesAreBoundedByEdgesAndShortOnesByTheShortestInnerEdgeToo)
{
    const TriangleMesh ball = test::icosphere(1, 2);
    const growth::Connectivity mesh = growth::connect(ball.points.size(), ball.triangles);
    growth::GrowState s = flattened(mesh, ball);
    const TrustRadiusSchedule& schedule = s.schedule.radius;
    growth::set_first_radii(s, false);
    const std::vector<double> longer = s.trust_radius;
    growth::set_first_radii(s, true);
    bool collapsed = false;
    for (int v = 0; v < mesh.vertices; ++v) {
        double shortest = test::kInfinity;
        for (const int u : growth::neighbours(mesh, v))
            shortest = std::min(shortest, (s.b[u] - s.b[v]).length());
        EXPECT_LE(longer[v],
                  schedule.first_edge_share * growth::mean_edge(mesh, s.a, v) * 1.000001);
        EXPECT_LE(s.trust_radius[v], schedule.short_first_share * longer[v] * 1.000001);
        EXPECT_LE(s.trust_radius[v], schedule.short_first_share * schedule.short_first_inner_edges *
                                         shortest * 1.000001);
        EXPECT_GT(s.trust_radius[v], 0);
        collapsed = collapsed || s.trust_radius[v] < 0.5 * schedule.short_first_share * longer[v];
    }
    EXPECT_TRUE(collapsed) << "inner edges never bind";
}

} // namespace

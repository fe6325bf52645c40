// SPDX-License-Identifier: Apache-2.0
#include "growth/group_shares.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;
using openvdb::Vec3d;

TEST(GroupShares, AreCoordinatesOnTheCoarseSurface)
{
    const TriangleMesh fine = test::icosphere(1.0, 3), coarse = test::icosphere(1.0, 1);
    const std::vector<GroupShare> shares =
        group_shares(coarse, nearest_coarse_points(fine, coarse, MultilevelSchedule{}));
    std::vector<double> sum(fine.points.size(), 0.0);
    std::vector<Vec3d> at(fine.points.size(), Vec3d(0.0));
    int last = 0;
    for (const GroupShare& share : shares) {
        EXPECT_LE(last, share.group);
        last = share.group;
        sum[std::size_t(share.vertex)] += share.weight;
        at[std::size_t(share.vertex)] +=
            share.weight * Vec3d(coarse.points[std::size_t(share.group)]);
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
        // Weights of a twentieth are left out; at most two can be so small.
        EXPECT_LE(sum[v], 1 + 1e-9);
        EXPECT_GE(sum[v], 0.9);
        EXPECT_LT((at[v] - Vec3d(fine.points[v])).length(), 0.25);
    }
}

} // namespace

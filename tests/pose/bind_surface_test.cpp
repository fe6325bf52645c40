// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/pose/bind_surface.h"

#include "vdb_shell/core/error.h"

#include "support/bends.h"

#include <gtest/gtest.h>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

TEST(BindSurface, AtRestPointsStayWhereTheyAre)
{
    const TriangleMesh rest = test::icosphere(1.0, 2), fine = test::icosphere(1.05, 3);
    const test::Points back = move_bound(bind_surface(fine.points, rest), rest);
    for (std::size_t i = 0; i < back.size(); ++i)
        EXPECT_LT((back[i] - fine.points[i]).length(), 1e-6f);
}

TEST(BindSurface, RigidMotionsCarryPointsOnAndOffTheSurface)
{
    const TriangleMesh rest = test::icosphere(1.0, 2), fine = test::icosphere(1.2, 2);
    const auto pose = [](const TriangleMesh& mesh) {
        return test::translated(test::turned(mesh, {1, 1, 0}, 0.7), {3, -2, 1});
    };
    const test::Points there = move_bound(bind_surface(fine.points, rest), pose(rest));
    const TriangleMesh expected = pose(fine);
    for (std::size_t i = 0; i < there.size(); ++i)
        EXPECT_LT((there[i] - expected.points[i]).length(), 3e-6f);
}

TEST(BindSurface, CornersGoWithTheirTriangles)
{
    const TriangleMesh rod = test::round_rod();
    const TriangleMesh posed{
        test::moved(rod.points, [](const Vec3d& p) { return test::elbow(p, 1.2, 0.5); }),
        rod.triangles};
    const test::Points there = move_bound(bind_surface(rod.points, rod), posed);
    for (std::size_t i = 0; i < there.size(); ++i)
        EXPECT_LT((there[i] - posed.points[i]).length(), 1e-5f);
}

TEST(BindSurface, IdsOrderPointsWhereverTheyStand)
{
    const test::Points points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    EXPECT_EQ(in_order_of_ids(points, {70, -5, 8}, {-5, 8, 70}, "m.ply"),
              (test::Points{{1, 0, 0}, {2, 0, 0}, {0, 0, 0}}));
    // Points that nobody asks for are left aside: a vertex without triangles has an id, too.
    EXPECT_EQ(in_order_of_ids(points, {70, -5, 8}, {8}, "m.ply"), (test::Points{{2, 0, 0}}));
    const auto complaint = [&](const std::vector<std::int64_t>& ids) -> std::string {
        try {
            in_order_of_ids(points, ids, {1, 2, 3}, "m.ply");
        } catch (const GeometryError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(complaint({1, 2, 2}), "m.ply: the points 1 and 2 have the same id 2");
    EXPECT_EQ(complaint({1, 3, 4}), "m.ply: no point has the id 2");
}

} // namespace
} // namespace vdb_shell

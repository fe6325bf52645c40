// SPDX-License-Identifier: Apache-2.0
#include "pose/skin_motion.h"

#include "support/bends.h"

#include <gtest/gtest.h>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using Side = SkinMotion::Side;

const std::vector<Vec3d> kInside{{0, 0, 0}, {0.1, 0.2, 0.9}, {-0.3, 0, -1.4}, {0, 0.45, 0.3}};

TEST(SkinMotion, RigidMotionsAreFollowedExactly)
{
    const TriangleMesh rod = test::round_rod();
    const SkinMotion motion(rod.points, rod.triangles);
    const Vec3d axis = Vec3d(1, 2, -0.5).unit(), shift(100, -20, 3);
    const auto move = [&](const Vec3d& p) {
        // Rodrigues' formula.
        const double c = std::cos(2.0), s = std::sin(2.0);
        return Vec3d(c * p + s * axis.cross(p) + (1 - c) * axis.dot(p) * axis + shift);
    };
    const auto frame = motion.frame(test::moved(rod.points, move));
    for (const Side side : {Side::inside, Side::outside})
        for (const Vec3d& p : kInside)
            // The posed skin is rounded to float32, at 100.
            EXPECT_LT((motion.carry(frame, p, side) - move(p)).length(), 3e-5);
}

TEST(SkinMotion, VerticesOfTheSkinGoWithIt)
{
    const TriangleMesh rod = test::round_rod();
    const SkinMotion motion(rod.points, rod.triangles);
    const test::Points posed =
        test::moved(rod.points, [](const Vec3d& p) { return test::elbow(p, 1.5, 0.6); });
    const auto frame = motion.frame(posed);
    for (std::size_t v = 0; v < posed.size(); v += 7)
        EXPECT_LT(
            (motion.carry(frame, Vec3d(rod.points[v]), Side::inside) - Vec3d(posed[v])).length(),
            1e-6);
}

TEST(SkinMotion, FarFromTheElbowPlacesMoveAsTheirOwnHalf)
{
    const TriangleMesh rod = test::round_rod();
    const SkinMotion motion(rod.points, rod.triangles);
    const auto move = [](const Vec3d& p) { return test::elbow(p, 1.5, 0.4); };
    const auto frame = motion.frame(test::moved(rod.points, move));
    for (const double z : {-1.7, 1.7}) {
        const Vec3d p(0.1, -0.1, z);
        EXPECT_LT((motion.carry(frame, p, Side::inside) - move(p)).length(), 0.03);
    }
}

TEST(SkinMotion, ATwistTurnsTheMiddleAndDoesNotCollapseIt)
{
    // Averaged positions would shrink towards the axis; averaged frames do not.
    const TriangleMesh rod = test::round_rod();
    const SkinMotion motion(rod.points, rod.triangles);
    const auto frame =
        motion.frame(test::moved(rod.points, [](const Vec3d& p) { return test::twist(p, 1.5); }));
    for (const double z : {-1.0, 0.0, 1.0}) {
        const Vec3d p(0.25, 0, z), there = motion.carry(frame, p, Side::inside);
        EXPECT_NEAR(std::hypot(there[0], there[1]), 0.25, 0.02);
        EXPECT_LT((there - test::twist(p, 1.5)).length(), 0.05);
    }
}

TEST(SkinMotion, SkinBehindAnotherLimbDoesNotCount)
{
    // Two rods side by side, a tenth apart; one goes away.
    const TriangleMesh one = test::round_rod();
    const TriangleMesh both = test::joined(one, test::translated(one, {1.1, 0, 0}));
    const SkinMotion motion(both.points, both.triangles);
    const auto frame = motion.frame(test::moved(
        both.points, [](const Vec3d& p) { return p[0] > 0.55 ? p + Vec3d(5, 0, 0) : p; }));
    const Vec3d p(0.45, 0, 0); // nearer to the other rod's skin than to most of its own
    EXPECT_LT((motion.carry(frame, p, Side::inside) - p).length(), 0.02);
}

} // namespace
} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "growth/lengthen_again.h"

#include "core/stage_progress.h"
#include "growth/initialise.h"
#include "growth/move_tests.h"
#include "growth/predicates.h"
#include "growth/violations.h"
#include "support/shapes.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/step/directions.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

/// A ball whose pillars are that long.
class LengthenAgain : public testing::Test
{
protected:
    explicit LengthenAgain(double length = 0.5)
        : ball_(test::icosphere(1, 2)),
          mesh_(growth::connect(ball_.points.size(), ball_.triangles)),
          s_(growth::make_state(
              mesh_, ball_.points,
              std::vector<double>(ball_.points.size(), std::numeric_limits<double>::infinity())))
    {
        growth::shrink_until_valid(s_, directions_along(ball_, pseudo_normals(ball_)),
                                   std::vector<double>(s_.b.size(), length), progress());
    }

    static StageProgress progress() { return StageProgress(nullptr, "test"); }
    /// Halfway or some other share along the pillar of now.
    Vec3d along(int v, double share) const
    {
        return growth::rounded(s_.a[v] + share * (s_.b[v] - s_.a[v]));
    }
    void expect_valid()
    {
        for (const std::uint8_t bad :
             growth::violating_faces(s_, std::vector<std::uint8_t>(mesh_.faces.size(), 1), true))
            EXPECT_EQ(bad, 0);
    }

    TriangleMesh ball_;
    growth::Connectivity mesh_;
    growth::GrowState s_;
};

TEST_F(LengthenAgain, WhatWasShortenedInVainComesBackToTheBit)
{
    const std::vector<Vec3d> before = s_.b;
    for (const int v : {3, 40, 41})
        s_.b[v] = along(v, 0.5);
    EXPECT_EQ(growth::lengthen_again(s_, before, progress()), 3U);
    EXPECT_EQ(s_.b, before);
    expect_valid();
}

TEST_F(LengthenAgain, WhereTheWholeWayIsBarredThePointGoesPartOfIt)
{
    std::vector<Vec3d> before = s_.b;
    // Beyond the middle of the ball, through the other side of the inner surface.
    before[7] = growth::rounded(s_.a[7] + 3.5 * (s_.b[7] - s_.a[7]));
    const double was = growth::fill_of(s_);
    EXPECT_EQ(growth::lengthen_again(s_, before, progress()), 1U);
    EXPECT_GT(growth::fill_of(s_), was);
    EXPECT_GT((s_.b[7] - s_.a[7]).length(), 0.5);
    EXPECT_LT((s_.b[7] - s_.a[7]).length(), 1.5);
    expect_valid();
}

TEST_F(LengthenAgain, LittleLossesPinsAndFullShellsAreLeftAlone)
{
    std::vector<Vec3d> before = s_.b;
    s_.b[3] = along(3, 0.999);
    s_.b[9] = s_.a[9];
    s_.pinned[9] = 1;
    const std::vector<Vec3d> now = s_.b;
    EXPECT_EQ(growth::lengthen_again(s_, before, progress()), 0U);
    EXPECT_EQ(s_.b, now);
    s_.schedule.barrier.enough_fill = 0.1;
    s_.b[40] = along(40, 0.5);
    EXPECT_EQ(growth::lengthen_again(s_, before, progress()), 0U);
}

TEST_F(LengthenAgain, LossesAreVolumes)
{
    const std::vector<Vec3d> before = s_.b;
    const double full = growth::fill_of(s_) * growth::volume6(s_.a, mesh_.faces);
    s_.b[5] = along(5, 0.9);
    const double lost = full - growth::fill_of(s_) * growth::volume6(s_.a, mesh_.faces);
    const std::vector<double> lost6 = growth::volume6_lost(s_, before);
    EXPECT_NEAR(lost6[5], lost, 1e-6 * lost) << "one point's move changes the volume linearly";
    for (std::size_t v = 0; v < lost6.size(); ++v)
        if (v != 5) {
            EXPECT_EQ(lost6[v], 0);
        }
}

} // namespace

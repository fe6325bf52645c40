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

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

/// A ball, or another surface, whose pillars are that long.
class LengthenAgain : public testing::Test
{
protected:
    explicit LengthenAgain(double length = 0.5, TriangleMesh surface = test::icosphere(1, 2))
        : surface_(std::move(surface)),
          mesh_(growth::connect(surface_.points.size(), surface_.triangles)),
          s_(growth::make_state(
              mesh_, surface_.points,
              std::vector<double>(surface_.points.size(), std::numeric_limits<double>::infinity())))
    {
        growth::shrink_until_valid(s_, directions_along(surface_, pseudo_normals(surface_)),
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

    TriangleMesh surface_;
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

class LengthenAgainInAPlate : public LengthenAgain
{
protected:
    LengthenAgainInAPlate()
        : LengthenAgain(0.05, test::gridded_box(Vec3d(-0.5, -0.5, -0.1), Vec3d(0.5, 0.5, 0.1), 6))
    {
    }
};

TEST_F(LengthenAgainInAPlate, PointsInEachOthersWayComeBackAsIfOneByOne)
{
    // Beyond the middle from either side: where one has gone, the other has no room.
    std::vector<Vec3d> before = s_.b;
    for (std::size_t v = 0; v < before.size(); ++v) {
        const Vec3d& a = s_.a[v];
        if (std::max(std::abs(a[0]), std::abs(a[1])) < 0.4)
            before[v] = growth::rounded(Vec3d(a[0], a[1], -0.5 * a[2]));
    }
    growth::GrowState one_by_one = s_;
    const std::vector<double> lost6 = growth::volume6_lost(s_, before);
    std::vector<int> order(s_.b.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](int u, int v) { return lost6[std::size_t(u)] > lost6[std::size_t(v)]; });
    std::size_t moved = 0, barred = 0;
    for (const int v : order) {
        if (!(lost6[std::size_t(v)] > 0))
            continue;
        const Vec3d here = one_by_one.b[v];
        bool moves = false;
        for (double share = 1; share > 0.1 && !moves; share /= 2) {
            one_by_one.b[v] = growth::capped(one_by_one, v, here + share * (before[v] - here));
            growth::build_inner_tree(one_by_one);
            moves = growth::faces_valid(one_by_one, growth::faces_at(mesh_, v));
            barred += !moves;
        }
        if (!moves)
            one_by_one.b[v] = here;
        moved += moves;
    }
    EXPECT_GT(moved, 0U);
    EXPECT_GT(barred, moved / 4) << "few are in another's way";
    s_.schedule.mend.least_loss = 0;
    EXPECT_EQ(growth::lengthen_again(s_, before, progress()), moved);
    EXPECT_EQ(s_.b, one_by_one.b);
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

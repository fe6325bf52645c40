// SPDX-License-Identifier: Apache-2.0
#include "growth/barrier.h"

#include "core/counter_random.h"
#include "growth/prism.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using openvdb::Vec3d;
using namespace vdb_shell::growth;

const Ball kNoBall{Vec3d(0.0), std::numeric_limits<double>::infinity()};

/// A prism whose corners stand a little off a regular one's; the first six entries of `id`.
std::array<Vec3d, 6> prism(std::uint64_t id)
{
    const vdb_shell::CounterRandom random(id);
    std::array<Vec3d, 6> corner{Vec3d(0, 0, 0), Vec3d(0, 1, 0), Vec3d(1, 0, 0),
                                Vec3d(0, 0, 1), Vec3d(0, 1, 1), Vec3d(1, 0, 1)};
    for (std::uint64_t i = 0; i < 18; ++i)
        corner[i / 3][static_cast<int>(i % 3)] += 0.3 * (random.unit(i) - 0.5);
    return corner;
}

/// All twelve tets' bounds on inner corner l, added one by one.
void add_one_by_one(const std::array<Vec3d, 6>& corner, int l, LinearBounds& bounds)
{
    for (int i = 0; i < tables().from_b_count[kTwelve][l]; ++i) {
        const std::array<std::uint8_t, 3>& base = tables().from_b[kTwelve][l][i].base;
        const Vec3d& p = corner[base[0]];
        bounds.add((corner[base[1]] - p).cross(corner[base[2]] - p), p);
    }
}

TEST(Barrier, APrismAtOnceBoundsAsItsTetsDoOneByOne)
{
    int held = 0;
    for (std::uint64_t id = 0; id < 50; ++id)
        for (int l = 0; l < 3; ++l) {
            const std::array<Vec3d, 6> corner = prism(id);
            const Vec3d here = corner[3 + l];
            const int next = (l + 1) % 3, last = (l + 2) % 3;
            LinearBounds one_by_one, at_once;
            one_by_one.clear(here, 0.1);
            at_once.clear(here, 0.1);
            add_one_by_one(corner, l, one_by_one);
            at_once.add_prism(
                {corner[l], corner[next], corner[last], corner[3 + next], corner[3 + last]});
            if (one_by_one.size() < 8)
                continue; // some tet is inverted to begin with: such a bound is left out
            ++held;
            EXPECT_EQ(at_once.size(), 8U);
            const Vec3d down(0, 0, -1);
            const Ball ball{here, 0.5}; // the tets of one prism leave directions open
            const Vec3d expected = barrier_minimum(one_by_one, ball, down, 0.05);
            const Vec3d found = barrier_minimum(at_once, ball, down, 0.05);
            EXPECT_LT((found - expected).length(), 1e-4 * (expected - here).length() + 1e-6)
                << id << " " << l;
            EXPECT_GT((expected - here).length(), 1e-3);
        }
    EXPECT_GT(held, 100);
}

TEST(Barrier, TheMinimumBetweenTwoPlanesIsWhereTheirPushesCancel)
{
    LinearBounds bounds;
    bounds.clear(Vec3d(0, 0, 0.5), 1.0);
    bounds.add(Vec3d(0, 0, 2), Vec3d(0, 0, 0));
    bounds.add(Vec3d(0, 0, -3), Vec3d(0, 0, 1));
    for (const Vec3d& side : {Vec3d(1, 0, 0), Vec3d(-1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, -1, 0)})
        bounds.add(side, Vec3d(0, 0, 0.5) - side);
    EXPECT_LT((barrier_minimum(bounds, kNoBall, Vec3d(0.0), 1.0) - Vec3d(0, 0, 0.5)).length(),
              1e-6);
    // 1/z - 1/(1-z) = 1 at z = (3 - sqrt 5) / 2.
    const Vec3d pushed = barrier_minimum(bounds, kNoBall, Vec3d(0, 0, 1), 1.0);
    EXPECT_NEAR(pushed[2], 0.381966, 2e-3);
}

} // namespace

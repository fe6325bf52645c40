// SPDX-License-Identifier: Apache-2.0
#include "growth/grow_state.h"

#include "growth/grown.h"
#include "growth/move_tests.h"
#include "growth/prism.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using namespace vdb_shell;

constexpr std::size_t kPinned = 5; // neither beside vertex 0 nor opposite

/// Of a ball: inner points halfway to its centre, but for one that is pinned.
PrismShell half_full(const TriangleMesh& ball)
{
    PrismShell shell{ball.points, ball.points, ball.triangles, {}};
    for (openvdb::Vec3s& p : shell.inner)
        p *= 0.5F;
    shell.inner[kPinned] = shell.outer[kPinned];
    return shell;
}

class PutShell : public ::testing::Test
{
protected:
    growth::GrowState state_with(const PrismShell& shell)
    {
        growth::GrowState s = growth::make_state(mesh_, ball_.points, cap_);
        growth::put_shell(s, shell, orders_);
        return s;
    }

    const TriangleMesh ball_ = test::icosphere(1, 1);
    const growth::Connectivity mesh_ = growth::connect(ball_.points.size(), ball_.triangles);
    const std::vector<double> cap_ = std::vector<double>(ball_.points.size(), test::kInfinity);
    const std::vector<PrismOrder> orders_ =
        std::vector<PrismOrder>(ball_.triangles.size(), growth::tables().order[4]);
};

TEST_F(PutShell, TakesPointsPinsAndOrders)
{
    const PrismShell shell = half_full(ball_);
    const growth::GrowState s = state_with(shell);
    for (std::size_t v = 0; v < shell.inner.size(); ++v) {
        EXPECT_EQ(s.b[v], openvdb::Vec3d(shell.inner[v]));
        EXPECT_EQ(s.pinned[v] != 0, v == kPinned) << v;
    }
    EXPECT_EQ(s.order, std::vector<std::uint8_t>(ball_.triangles.size(), 4));
    for (int f = 0; f < mesh_.face_count(); ++f)
        EXPECT_TRUE(growth::inner_triangle_clear(s, f)) << f;
}

/// A state without boxes for its inner triangles would let everything pass.
TEST_F(PutShell, LetsContactTestsSeeTheInnerTriangles)
{
    PrismShell shell = half_full(ball_);
    shell.inner[0] = -0.8F * shell.outer[0];
    const growth::GrowState s = state_with(shell);
    bool clear = true;
    for (const growth::FaceCorner& at : growth::star(mesh_, 0))
        clear = clear && growth::inner_triangle_clear(s, at.face);
    EXPECT_FALSE(clear) << "the pillar of vertex 0 goes through the other side";
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/obstacles/join_cores.h"

#include "support/shapes.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

// Together and apart again gives what there was.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;

TEST(JoinCores, BoundsTheSolidBetween)
{
    const TriangleMesh box = test::box(Vec3d(-1), Vec3d(1)), core = test::box(Vec3d(0), Vec3d(0.5));
    const TriangleMesh both = join_cores(box, core);
    const MeshCheck check = check_mesh(both);
    EXPECT_EQ(check.inside_out_components(), 0U);
    EXPECT_DOUBLE_EQ(check.volume, 8 - 0.125);
    const TriangleMesh again = drop_cores(both, {8, 8});
    EXPECT_EQ(again.points, box.points);
    EXPECT_EQ(again.triangles, box.triangles);
}

TEST(JoinCores, VerticesAfterTheRangeMoveUp)
{
    const TriangleMesh box = test::box(Vec3d(-1), Vec3d(1)), core = test::box(Vec3d(0), Vec3d(0.5));
    // As refinement leaves it, with new points at the end.
    const TriangleMesh again = drop_cores(join_cores(core, box), {0, 8});
    EXPECT_EQ(again.points, box.points);
    EXPECT_EQ(again.triangles, test::reversed(box).triangles);
}

TEST(JoinCores, AStackIsPartedInAllLayers)
{
    const TriangleMesh box = test::box(Vec3d(-1), Vec3d(1)), core = test::box(Vec3d(0), Vec3d(0.5));
    const TriangleMesh both = join_cores(box, core);
    PrismShell shell{both.points, both.points, both.triangles,
                     std::vector<StopReason>(16, StopReason::pinned)};
    PrismSplit split;
    split.order.assign(24, {0, 1, 2});
    const ShellStack stack = drop_cores(one_layer(shell, split), {8, 8});
    EXPECT_EQ(stack.surface(0), box.points);
    EXPECT_EQ(stack.surface(1), box.points);
    EXPECT_EQ(stack.triangles(), box.triangles);
    EXPECT_EQ(stack.splits[0].order.size(), 12U);
    EXPECT_EQ(stack.layers[0].stop.size(), 8U);
}

TEST(JoinCores, AStackAndCoresAreOneAndApartAgain)
{
    const TriangleMesh box = test::box(Vec3d(-1), Vec3d(1)), core = test::box(Vec3d(0), Vec3d(0.5));
    PrismShell shell{box.points, box.points, box.triangles,
                     std::vector<StopReason>(8, StopReason::prism)};
    for (Vec3s& p : shell.inner)
        p *= 0.75f;
    PrismSplit split;
    split.order.assign(12, {2, 0, 1});
    const ShellStack both = join_cores(one_layer(shell, split), core);
    EXPECT_EQ(both.surface(0), join_cores(box, core).points);
    EXPECT_EQ(both.triangles(), join_cores(box, core).triangles);
    for (std::size_t v = 8; v < 16; ++v) {
        EXPECT_TRUE(both.layers[0].pinned(v));
        EXPECT_EQ(both.layers[0].stop[v], StopReason::pinned);
    }
    const ShellStack again = drop_cores(both, {8, 8});
    EXPECT_EQ(again.surface(1), shell.inner);
    EXPECT_EQ(again.triangles(), box.triangles);
    EXPECT_EQ(again.splits[0].order, split.order);
    EXPECT_EQ(again.layers[0].stop, shell.stop);
}

TEST(JoinCores, SeesAPointInThePlaceOfACore)
{
    const TriangleMesh box = test::box(Vec3d(-1), Vec3d(1)), core = test::box(Vec3d(0), Vec3d(0.5));
    const TriangleMesh both = join_cores(box, core);
    PrismShell shell{both.points, both.points, both.triangles, {}};
    PrismSplit split;
    split.order.assign(24, {0, 1, 2});
    EXPECT_FALSE(shares_core_point(one_layer(shell, split), {8, 8}));
    shell.inner[3] = Vec3s(0.5f);
    EXPECT_TRUE(shares_core_point(one_layer(shell, split), {8, 8}));
    EXPECT_FALSE(shares_core_point(one_layer(shell, split), {}));
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/write/surface_file.h"

#include "support/shapes.h"
#include "support/tapered.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

namespace vdb_shell::test
{
namespace
{

double volume_of(const TriangleMesh& mesh)
{
    return signed_volume(mesh.points, mesh.triangles);
}

/// Balls within each other, each layer half as large as the one around it.
ShellStack balls(std::size_t skin)
{
    const HandMade outer = hand_made_shell(icosphere(1.0, 1), 0.5);
    const HandMade inner = hand_made_shell({outer.shell.inner, outer.shell.triangles}, 0.5);
    ShellStack stack;
    stack.layers = {outer.shell, inner.shell};
    stack.splits = {outer.split, inner.split};
    stack.skin = skin;
    return stack;
}

TEST(SurfaceFile, OfAShellInsideIsItsInnerSurfaceOrTheInput)
{
    const double input = volume_of(icosphere(1.0, 1));
    EXPECT_NEAR(volume_of(surface_of(balls(0), ShellSurface::grown)), input / 64, 1e-6);
    EXPECT_NEAR(volume_of(surface_of(balls(0), ShellSurface::skin)), input, 1e-6);
}

TEST(SurfaceFile, OfAShellOnBothSidesIsTheInnerSurfaceOrTheInputInBetween)
{
    const double outermost = volume_of(icosphere(1.0, 1));
    EXPECT_NEAR(volume_of(surface_of(balls(1), ShellSurface::grown)), outermost / 64, 1e-6);
    EXPECT_NEAR(volume_of(surface_of(balls(1), ShellSurface::skin)), outermost / 8, 1e-6);
}

TEST(SurfaceFile, OfAnOutwardShellIsTheOutermostSurfaceOrTheInput)
{
    const double outermost = volume_of(icosphere(1.0, 1));
    EXPECT_NEAR(volume_of(surface_of(balls(2), ShellSurface::grown)), outermost, 1e-6);
    EXPECT_NEAR(volume_of(surface_of(balls(2), ShellSurface::skin)), outermost / 64, 1e-6);
}

TEST(SurfaceFile, TheSkinOfATaperedShellHasAllItsPoints)
{
    const TriangleMesh ball = icosphere(1.0, 1);
    const ShellStack stack = coned(ball, openvdb::Vec3s(0));
    EXPECT_TRUE(surface_of(stack, ShellSurface::grown).triangles.empty());
    const TriangleMesh skin = surface_of(stack, ShellSurface::skin);
    EXPECT_TRUE(same_bits(skin.points, ball.points));
    EXPECT_TRUE(same_bits(skin.triangles, ball.triangles));
}

} // namespace
} // namespace vdb_shell::test

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/prism_shell.h"

#include "core/counter_random.h"
#include "support/shapes.h"
#include "support/shells.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;

bool same_bits(const Vec3s& a, const Vec3s& b)
{
    return std::memcmp(&a, &b, sizeof(a)) == 0;
}

TEST(Extrude, KeepsALengthThatFloat32CanHoldExactly)
{
    const TriangleMesh box = test::box({0, 0, 0}, {1, 1, 1});
    const PrismShell shell = test::shell_along(
        box, [](const Vec3d&) { return Vec3d(0, 0, -1); }, [](std::size_t) { return 0.25; });
    for (std::size_t v = 0; v < box.points.size(); ++v) {
        EXPECT_EQ(shell.inner[v], box.points[v] - Vec3s(0, 0, 0.25f));
        EXPECT_EQ(shell.length(v), 0.25);
    }
}

TEST(Extrude, NeverLengthensAndLosesNoMoreThanTheRounding)
{
    const CounterRandom random(7);
    TriangleMesh mesh = test::icosphere(10, 3);
    for (Vec3s& p : mesh.points)
        p += Vec3s(3.3f, -7.7f, 20.1f);
    std::size_t rounded_up = 0;
    std::vector<double> wanted;
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        wanted.push_back(std::pow(10.0, -4 + 5 * random.unit(v)));
    auto direction = [](const Vec3d& p) { return (Vec3d(3.3, -7.7, 20.1) - p).unit(); };
    const PrismShell shell =
        test::shell_along(mesh, direction, [&](std::size_t v) { return wanted[v]; });
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        EXPECT_LE(shell.length(v), wanted[v]) << "vertex " << v;
        // Rounded towards the outer point by less than one float32 at 32 along each axis.
        EXPECT_GE(shell.length(v), wanted[v] - std::sqrt(3.0) * 32 * 0x1p-23) << "vertex " << v;
        const Vec3d outer(mesh.points[v]);
        const Vec3s nearest(outer + wanted[v] * direction(outer));
        rounded_up += (Vec3d(nearest) - outer).length() > wanted[v];
    }
    EXPECT_GT(rounded_up, mesh.points.size() / 4); // the plain rounding would have failed
}

TEST(Extrude, PinsVerticesWithoutLengthOrDirectionBitForBit)
{
    TriangleMesh mesh = test::unit_tetrahedron();
    mesh.points[0] = Vec3s(-0.0f, 0.0f, -0.0f);
    Directions directions{{Vec3d(1, 0, 0), Vec3d(0.0), Vec3d(0, -1, 0), Vec3d(0, 0, -1)},
                          {1, 1, 1, 1}};
    LineLengths lengths{{0.0, 0.5, 0.0, 0.5},
                        {0, 0, 0, 3},
                        {StopReason::stop_test, StopReason::no_direction, StopReason::stop_test,
                         StopReason::thickness}};
    const PrismShell shell = extrude(mesh, directions, lengths);
    for (std::size_t v = 0; v < 3; ++v) {
        EXPECT_TRUE(shell.pinned(v));
        EXPECT_TRUE(same_bits(shell.outer[v], shell.inner[v]));
        EXPECT_EQ(shell.length(v), 0);
    }
    EXPECT_FALSE(shell.pinned(3));
    EXPECT_EQ(shell.inner[3], Vec3s(0, 0, 0.5f));
    EXPECT_EQ(shell.stop, lengths.reason);
}

TEST(Extrude, PinsWhereFloat32CannotHoldTheLength)
{
    // At 2^24 the float32 spacing is 2: half of it would round up to a pillar of twice the length.
    TriangleMesh mesh = test::translated(test::box({0, 0, 0}, {64, 64, 64}), {16777216, 0, 0});
    const PrismShell shell = test::shell_along(
        mesh, [](const Vec3d&) { return Vec3d(1, 0, 0); }, [](std::size_t) { return 1.5; });
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        EXPECT_TRUE(same_bits(shell.outer[v], shell.inner[v]));
}

TEST(InnerSurface, HasTheTrianglesOfTheOuterOne)
{
    const TriangleMesh sphere = test::icosphere(1, 2);
    const PrismShell shell = test::radial_shell(sphere, [](std::size_t) { return 0.5; });
    const TriangleMesh inner = inner_surface(shell);
    EXPECT_EQ(inner.triangles, sphere.triangles);
    EXPECT_EQ(inner.points, shell.inner);
    // Similar to the outer polyhedron, at half the size.
    EXPECT_NEAR(signed_volume(inner.points, inner.triangles),
                signed_volume(sphere.points, sphere.triangles) / 8, 1e-6);
}

} // namespace

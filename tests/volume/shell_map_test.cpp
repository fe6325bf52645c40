// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/shell_map.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "volume/tet_index_grid.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

constexpr double kMapVoxel = 0.03;

/// A sphere's shell whose inner surface is turned about the z axis, so that sides are curved.
PrismShell turned_shell(double radians, const std::set<std::uint32_t>& pinned = {})
{
    PrismShell shell = test::hand_made_shell(test::icosphere(1.0, 2), 0.6, pinned).shell;
    for (std::size_t v = 0; v < shell.inner.size(); ++v)
        if (!shell.pinned(v)) {
            const Vec3s p = shell.inner[v];
            shell.inner[v] =
                Vec3s(float(std::cos(radians) * p[0] - std::sin(radians) * p[1]),
                      float(std::sin(radians) * p[0] + std::cos(radians) * p[1]), p[2]);
        }
    return shell;
}

ShellStack stack_of(PrismShell shell, SplitRule rule)
{
    SplitOptions options;
    options.rule = rule;
    PrismSplit split = split_prisms(shell, options);
    return one_layer(std::move(shell), std::move(split));
}

ShellMap map_of(const ShellStack& stack)
{
    return {stack, make_tets(stack)};
}

template <typename Visit> void for_each_voxel(const ShellMap& map, const Visit& visit)
{
    const auto grid = tet_index_grid(map.tets(), kMapVoxel, "test", StageProgress(nullptr, "test"));
    ASSERT_GT(grid->activeVoxelCount(), 10000u);
    for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel)
        visit(std::uint32_t(*voxel), kMapVoxel * voxel.getCoord().asVec3d());
}

TEST(ShellMap, ThereAndBack)
{
    const ShellMap map = map_of(stack_of(turned_shell(0.1, {5}), SplitRule::vertex_index));
    EXPECT_EQ(map.prisms(), map.triangles());
    EXPECT_EQ(map.linear_prisms(), 0u);
    std::size_t inside = 0, all = 0;
    for_each_voxel(map, [&](std::uint32_t tet, const Vec3d& point) {
        const ShellPlace place = map.place_in(tet, point);
        EXPECT_LT((map.point_of(place) - point).length(), 1e-10);
        inside += place.prism != ShellPlace::kNone && place.weight[0] > -1e-8 &&
                  place.weight[1] > -1e-8 && place.weight[2] > -1e-8;
        ++all;
    });
    // Every point lies in the wedge that it is said to be in.
    EXPECT_EQ(inside, all);
}

TEST(ShellMap, DoesNotDependOnDiagonals)
{
    const ShellMap one = map_of(stack_of(turned_shell(0.1), SplitRule::vertex_index));
    const ShellMap other = map_of(stack_of(turned_shell(0.1), SplitRule::length_ascending));
    const auto grid =
        tet_index_grid(other.tets(), kMapVoxel, "test", StageProgress(nullptr, "test"));
    auto tet_at = grid->getConstAccessor();
    std::size_t other_tets = 0;
    for_each_voxel(one, [&](std::uint32_t tet, const Vec3d& point) {
        const int second = tet_at.getValue(openvdb::Coord::round(point / kMapVoxel));
        if (second < 0)
            return;
        const SurfacePlace a = one.on_surface(one.place_in(tet, point));
        const SurfacePlace b = other.on_surface(other.place_in(std::uint32_t(second), point));
        EXPECT_NEAR(a.share, b.share, 1e-8);
        // On a side either prism is right.
        if (a.triangle == b.triangle)
            EXPECT_LT((a.weight - b.weight).length(), 1e-8);
        else
            EXPECT_LT(a.weight[openvdb::math::MinIndex(a.weight)], 1e-8);
        other_tets += one.tets().tets[tet] != other.tets().tets[std::size_t(second)];
    });
    EXPECT_GT(other_tets, 1000u); // or the two were cut alike, and nothing was compared
}

TEST(ShellMap, PrismsThatAreTurnedOverAreLinearInTheirTets)
{
    PrismShell shell = turned_shell(0.1);
    std::swap(shell.inner[3], shell.inner[shell.triangles[0][0] == 3 ? 9 : 3]);
    const Vec3s off = shell.outer[7] + 0.7f * (shell.outer[8] - shell.outer[7]);
    shell.inner[7] = off;
    const ShellMap map = map_of(stack_of(std::move(shell), SplitRule::vertex_index));
    EXPECT_GT(map.linear_prisms(), 0u);
    for_each_voxel(map, [&](std::uint32_t tet, const Vec3d& point) {
        EXPECT_LT((map.point_of(map.place_in(tet, point)) - point).length(), 1e-9);
    });
}

TEST(ShellMap, WhatIsLinearInOnePoseIsLinearInTheOther)
{
    const ShellStack at_rest = stack_of(turned_shell(0.1), SplitRule::vertex_index);
    ShellStack in_pose = at_rest;
    PrismShell& layer = in_pose.layers[0];
    layer.inner[7] = layer.outer[7] + 0.7f * (layer.outer[8] - layer.outer[7]);
    ShellMap rest = map_of(at_rest), posed = map_of(in_pose);
    const std::size_t linear = posed.linear_prisms();
    ASSERT_GT(linear, 0u);
    ASSERT_EQ(rest.linear_prisms(), 0u);
    make_linear_alike(rest, posed);
    EXPECT_EQ(rest.linear_prisms(), linear);
    EXPECT_EQ(posed.linear_prisms(), linear);
    // A tet goes to the same tet, and back.
    std::size_t tested = 0;
    for_each_voxel(posed, [&](std::uint32_t tet, const Vec3d& point) {
        const ShellPlace place = posed.place_in(tet, point);
        if (place.prism != ShellPlace::kNone)
            return;
        const Vec3d there = rest.point_of(place);
        ASSERT_TRUE(rest.holds(tet, there));
        EXPECT_LT((posed.point_of(rest.place_in(tet, there)) - point).length(), 1e-10);
        ++tested;
    });
    EXPECT_GT(tested, 100u);
}

TEST(ShellMap, TheJacobianIsTheDerivative)
{
    const ShellMap map = map_of(stack_of(turned_shell(0.1), SplitRule::vertex_index));
    constexpr double kStep = 1e-6;
    for_each_voxel(map, [&](std::uint32_t tet, const Vec3d& point) {
        if (tet % 50 != 0)
            return;
        const ShellPlace place = map.place_in(tet, point);
        for (int k = 0; k < 3; ++k) {
            ShellPlace more = place;
            more.weight[k == 2 ? 3 : k + 1] += kStep;
            if (k < 2)
                more.weight[0] -= kStep;
            const Vec3d slope = (map.point_of(more) - point) / kStep;
            EXPECT_LT((slope - map.jacobian_of(place).col(k)).length(), 1e-4);
        }
    });
}

/// A disc of triangles around its middle, whose inner side is turned about the middle's pillar.
PrismShell turned_disc(std::uint32_t rim, double radians)
{
    PrismShell shell;
    shell.outer = {Vec3s(0, 0, 0)};
    shell.inner = {Vec3s(0, 0, -1)};
    for (std::uint32_t i = 0; i < rim; ++i) {
        const double at = 2 * M_PI * i / rim, turned = at + radians;
        shell.outer.emplace_back(float(std::cos(at)), float(std::sin(at)), 0.0F);
        shell.inner.emplace_back(float(std::cos(turned)), float(std::sin(turned)), -1.0F);
        shell.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % rim);
    }
    shell.stop.assign(shell.outer.size(), StopReason{});
    return shell;
}

openvdb::BBoxd box_of_prism(const PrismShell& shell, std::uint32_t prism)
{
    openvdb::BBoxd box;
    for (int k = 0; k < 3; ++k) {
        box.expand(Vec3d(shell.outer[shell.triangles[prism][k]]));
        box.expand(Vec3d(shell.inner[shell.triangles[prism][k]]));
    }
    return box;
}

TEST(ShellMap, APrismWherePlacesOfATetAreFoundIsOneOfItsOwn)
{
    // Sides at the middle are turned by three triangles from top to bottom, so flat tets and curved
    // prisms do not agree on which of them has a point.
    constexpr std::uint32_t kRim = 36;
    const PrismShell disc = turned_disc(kRim, M_PI / 6);
    const ShellMap map = map_of(stack_of(disc, SplitRule::vertex_index));
    ASSERT_EQ(map.linear_prisms(), 0U);
    std::size_t far = 0;
    const TetMesh& tets = map.tets();
    for (std::uint32_t t = 0; t < tets.tets.size(); ++t)
        for (int corner = 0; corner < 4; ++corner) {
            // Five eighths of one corner, an eighth of each of the others.
            Vec3d point = 0.5 * Vec3d(tets.points[tets.tets[t][corner]]);
            for (int k = 0; k < 4; ++k)
                point += 0.125 * Vec3d(tets.points[tets.tets[t][k]]);
            const ShellPlace place = map.place_in(t, point);
            ASSERT_NE(place.prism, ShellPlace::kNone);
            ASSERT_LT((map.point_of(place) - point).length(), 1e-9);
            const std::uint32_t apart = (place.prism + kRim - tets.prism[t]) % kRim;
            far += apart > 1 && apart < kRim - 1;
            const openvdb::BBoxd box = box_of_prism(disc, place.prism);
            EXPECT_TRUE(map.tets_that([&](const openvdb::BBoxd& other) {
                return other.min() == box.min() && other.max() == box.max();
            })[t])
                << "tet " << t << ", " << apart << " prisms away";
        }
    EXPECT_GT(far, 0U) << "else prisms beside one another are all that was asked for";
}

} // namespace
} // namespace vdb_shell

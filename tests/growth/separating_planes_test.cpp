// SPDX-License-Identifier: Apache-2.0
#include "growth/separating_planes.h"

#include "core/counter_random.h"
#include "growth/move_tests.h"
#include "support/shapes.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <limits>

namespace
{

using openvdb::Vec3d;
using namespace vdb_shell;
using namespace vdb_shell::growth;

struct Shell {
    Connectivity connectivity;
    GrowState state;
};

/// A torus whose inner surface is nearly collapsed: everything is near something.
std::unique_ptr<Shell> thick_torus()
{
    const TriangleMesh mesh = test::torus(2.0, 0.5, 24, 12);
    auto shell = std::make_unique<Shell>();
    shell->connectivity = connect(mesh.points.size(), mesh.triangles);
    shell->state = make_state(
        shell->connectivity, mesh.points,
        std::vector<double>(mesh.points.size(), std::numeric_limits<double>::infinity()));
    GrowState& s = shell->state;
    for (std::size_t v = 0; v < s.b.size(); ++v) {
        const Vec3d& a = s.a[v];
        const Vec3d ring = Vec3d(a[0], a[1], 0) * (2.0 / Vec3d(a[0], a[1], 0).length());
        s.b[v] = rounded(a + 0.9 * (ring - a));
        s.trust_radius[v] = 0.05;
    }
    return shell;
}

/// Moves every vertex at random within its reach, where its planes allow it.
std::size_t shake(GrowState& s, const SeparatingPlanes& w, std::uint64_t seed)
{
    const CounterRandom random(seed);
    std::size_t moved = 0;
    for (std::size_t v = 0; v < s.b.size(); ++v) {
        Vec3d step;
        for (int k = 0; k < 3; ++k)
            step[k] = 2 * random.unit(3 * v + static_cast<std::uint64_t>(k)) - 1;
        const Vec3d x = rounded(s.trust_centre[v] + step * (0.57 * s.trust_radius[v]));
        if (!w.locked[v] && on_own_sides(w, static_cast<int>(v), x)) {
            s.b[v] = x;
            ++moved;
        }
    }
    return moved;
}

bool share_a_corner(const Connectivity& m, int f, int g)
{
    for (int k = 0; k < 3; ++k)
        if (m.incident_to(g, m.corner(f, k)))
            return true;
    return false;
}

void expect_apart(const GrowState& s)
{
    const int faces = s.mesh->face_count();
    for (int f = 0; f < faces; ++f)
        for (int g = 0; g < faces; ++g) {
            const bool tested = g > f && !share_a_corner(*s.mesh, f, g);
            ASSERT_FALSE(tested && improper_contact(inner_corners(s, f), inner_ids(s, f),
                                                    inner_corners(s, g), inner_ids(s, g)))
                << f << " " << g;
            ASSERT_FALSE(improper_contact(inner_corners(s, f), inner_ids(s, f), outer_corners(s, g),
                                          outer_ids(s, g)))
                << f << " outer " << g;
        }
}

TEST(SeparatingPlanes, WhateverMovesBetweenThemNeverTouches)
{
    const auto shell = thick_torus();
    GrowState& s = shell->state;
    SeparatingPlanes planes;
    separate_triangles(s, std::vector<std::uint8_t>(s.b.size(), 0), planes);
    const std::size_t moved = shake(s, planes, 11);
    EXPECT_GT(moved, s.b.size() / 10);
    EXPECT_LT(moved, s.b.size()) << "no plane held anything: the test says nothing";
    expect_apart(s);
}

TEST(SeparatingPlanes, RecentredTheyStillKeepApartWhatMovesBetweenThem)
{
    const auto shell = thick_torus();
    GrowState& s = shell->state;
    SeparatingPlanes planes;
    separate_triangles(s, std::vector<std::uint8_t>(s.b.size(), 0), planes);
    for (std::uint64_t round = 0; round < 4; ++round) {
        const std::vector<SeparatingPlane> before = planes.plane;
        EXPECT_GT(shake(s, planes, 20 + round), s.b.size() / 10);
        recentre_planes(s, planes);
        std::size_t moved = 0;
        for (std::size_t i = 0; i < before.size(); ++i)
            moved += planes.plane[i].d != before[i].d;
        EXPECT_GT(moved, before.size() / 10);
        for (int v = 0; v < s.mesh->vertices; ++v)
            EXPECT_TRUE(planes.locked[v] || on_own_sides(planes, v, s.b[v])) << v;
        expect_apart(s);
    }
}

TEST(SeparatingPlanes, RecentredTheyAreHalfwayWhereNothingElseHoldsThem)
{
    const auto shell = thick_torus();
    GrowState& s = shell->state;
    SeparatingPlanes planes;
    separate_triangles(s, std::vector<std::uint8_t>(s.b.size(), 0), planes);
    shake(s, planes, 31);
    recentre_planes(s, planes);
    int halfway = 0, held = 0;
    for (std::size_t i = 0; i < planes.plane.size(); ++i) {
        const auto& [f, g, least_d, most_d] = planes.range[i];
        if (g < 0)
            continue;
        const SeparatingPlane& plane = planes.plane[i];
        double of_f = std::numeric_limits<double>::max(), of_g = of_f;
        for (int k = 0; k < 3; ++k) {
            of_f = std::min(of_f, plane.value(s.b[s.mesh->corner(f, k)]));
            of_g = std::min(of_g, -plane.value(s.b[s.mesh->corner(g, k)]));
        }
        EXPECT_GT(of_f, 0);
        EXPECT_GT(of_g, 0);
        if (plane.d == least_d || plane.d == most_d) {
            ++held;
            continue;
        }
        EXPECT_NEAR(of_f, of_g, 1e-9) << i;
        ++halfway;
    }
    EXPECT_GT(halfway, 100);
    EXPECT_GT(held, 100);
}

TEST(SeparatingPlanes, WithoutThemTheSameMovesDoTouch)
{
    const auto shell = thick_torus();
    GrowState& s = shell->state;
    SeparatingPlanes none;
    separate_triangles(s, std::vector<std::uint8_t>(s.b.size(), 1), none);
    EXPECT_EQ(shake(s, none, 11), s.b.size()) << "nothing moves, so nothing needs a plane";
    int contacts = 0;
    for (int f = 0; f < s.mesh->face_count(); ++f)
        for (int g = f + 1; g < s.mesh->face_count(); ++g)
            contacts += !share_a_corner(*s.mesh, f, g) &&
                        improper_contact(inner_corners(s, f), inner_ids(s, f), inner_corners(s, g),
                                         inner_ids(s, g));
    EXPECT_GT(contacts, 0);
}

TEST(SeparatingPlanes, StandWhereTheVerticesAreOnTheirRightSide)
{
    const auto shell = thick_torus();
    GrowState& s = shell->state;
    SeparatingPlanes planes;
    separate_triangles(s, std::vector<std::uint8_t>(s.b.size(), 0), planes);
    ASSERT_GT(planes.plane.size(), s.b.size());
    for (int v = 0; v < s.mesh->vertices; ++v)
        EXPECT_TRUE(planes.locked[v] || on_own_sides(planes, v, s.b[v])) << v;
}

TEST(SeparatingPlanes, AreTheSameForAnyNumberOfThreads)
{
    SeparatingPlanes first;
    for (const std::size_t threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        const auto shell = thick_torus();
        SeparatingPlanes planes;
        separate_triangles(shell->state, std::vector<std::uint8_t>(shell->state.b.size(), 0),
                           planes);
        if (first.plane.empty())
            first = planes;
        ASSERT_EQ(planes.first, first.first);
        ASSERT_EQ(planes.side, first.side);
        ASSERT_EQ(planes.locked, first.locked);
        ASSERT_EQ(planes.plane.size(), first.plane.size());
        for (std::size_t i = 0; i < first.plane.size(); ++i) {
            ASSERT_TRUE(planes.plane[i].n == first.plane[i].n &&
                        planes.plane[i].d == first.plane[i].d)
                << i;
            ASSERT_EQ(planes.range[i].f, first.range[i].f);
            ASSERT_EQ(planes.range[i].least_d, first.range[i].least_d);
        }
    }
}

TEST(SeparatingPlanes, TrianglesThatTouchAlreadyAreLocked)
{
    const auto shell = thick_torus();
    GrowState& s = shell->state;
    // An inner corner lands on one across the tube.
    const int f = 0;
    int g = s.mesh->face_count() / 2;
    while (share_a_corner(*s.mesh, f, g))
        ++g;
    const Corners c = inner_corners(s, g);
    s.b[s.mesh->corner(f, 0)] = c[0];
    SeparatingPlanes planes;
    separate_triangles(s, std::vector<std::uint8_t>(s.b.size(), 0), planes);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(planes.locked[s.mesh->corner(f, k)], 1);
        EXPECT_EQ(planes.locked[s.mesh->corner(g, k)], 1);
    }
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "mesh/most_visible.h"

#include "core/counter_random.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

TEST(MostVisible, IsAsFarFromAllThreeAxes)
{
    const Vec3d d = most_visible({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(d[k], 1 / std::sqrt(3.0), 1e-12);
}

TEST(MostVisible, LeavesOutNormalsThatSayNothingNew)
{
    // The widest angle is that between the first two; the third lies between them.
    const Vec3d d = most_visible({{1, 0, 0}, {0, 1, 0}, Vec3d(1, 1, 0).unit()});
    EXPECT_NEAR(smallest_dot({{1, 0, 0}, {0, 1, 0}}, d), std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(d[2], 0, 1e-12);
}

TEST(MostVisible, NoDirectionSeesOppositeNormals)
{
    const std::vector<Vec3d> normals{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
    EXPECT_LE(smallest_dot(normals, most_visible(normals)), 0);
}

TEST(MostVisible, ManyNormalsOfACone)
{
    // More than are tried by triples: all at 60 degrees from the axis.
    std::vector<Vec3d> normals;
    for (int i = 0; i < 40; ++i) {
        const double angle = 2 * M_PI * i / 40;
        normals.emplace_back(std::sqrt(0.75) * std::cos(angle), std::sqrt(0.75) * std::sin(angle),
                             0.5);
    }
    EXPECT_NEAR(smallest_dot(normals, most_visible(normals)), 0.5, 1e-12);
}

TEST(MostVisible, ManyNormalsThatLeaveANarrowCone)
{
    // Each twice, as the two ends of a pillar give them, and all but square to the axis.
    for (const double sight : {1e-2, 1e-4, 1e-6}) {
        std::vector<Vec3d> normals;
        for (int i = 0; i < 17; ++i) {
            const double angle = 2 * M_PI * (i * 7 % 17) / 17;
            normals.push_back(Vec3d(std::cos(angle), std::sin(angle), sight).unit());
            normals.push_back(Vec3d(std::cos(angle), std::sin(angle), 2 * sight).unit());
        }
        // Along the axis.
        const double least = sight / std::hypot(1, sight);
        EXPECT_NEAR(smallest_dot(normals, most_visible(normals)), least, 1e-9 * least);
    }
}

TEST(BlindVertices, ABoxHasNone)
{
    EXPECT_TRUE(blind_vertices(test::box(Vec3d(0.0), Vec3d(1.0))).empty());
}

TEST(BlindVertices, FindsTheCornerOfTwoTrianglesThatFaceOppositeWays)
{
    TriangleMesh mesh;
    for (const auto& p : {openvdb::Vec3s(0, 0, 0), openvdb::Vec3s(1, 0, 0), openvdb::Vec3s(0, 1, 0),
                          openvdb::Vec3s(-1, 0, 0), openvdb::Vec3s(0, -1, 0)})
        mesh.points.push_back(p);
    mesh.triangles = {openvdb::Vec3I(0, 1, 2), openvdb::Vec3I(0, 4, 3)};
    EXPECT_EQ(blind_vertices(mesh), std::vector<std::uint32_t>{0});
    mesh.triangles[1] = openvdb::Vec3I(0, 3, 4);
    EXPECT_TRUE(blind_vertices(mesh).empty());
}

/// A closed fan around the origin.
TriangleMesh fan_of(const std::vector<openvdb::Vec3s>& rim)
{
    TriangleMesh mesh;
    mesh.points.emplace_back(0.f, 0.f, 0.f);
    mesh.points.insert(mesh.points.end(), rim.begin(), rim.end());
    const auto n = static_cast<std::uint32_t>(rim.size());
    for (std::uint32_t i = 0; i < n; ++i)
        mesh.triangles.emplace_back(0, 1 + i, 1 + (i + 1) % n);
    return mesh;
}

bool apex_is_blind(const TriangleMesh& mesh)
{
    const std::vector<std::uint32_t> blind = blind_vertices(mesh);
    return !blind.empty() && blind.front() == 0;
}

TEST(BlindVertices, AFlatFanIsSeenAndOneThatIsFoldedFlatIsNot)
{
    const std::vector<openvdb::Vec3s> square{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    EXPECT_FALSE(apex_is_blind(fan_of(square)));
    // The last two triangles lie back to back in the plane.
    EXPECT_TRUE(apex_is_blind(fan_of({{1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5f, -1, 0}})));
}

// A rim that goes up and down by h times, all around. With four corners or more up and down, h says
// how narrow the cone is from which all sides are seen; it is closed when the normals of opposite
// sides are opposite.
TEST(BlindVertices, ASaddleIsSeenUntilItsConeCloses)
{
    const auto saddle = [](float h) {
        return fan_of({{1, 0, h},
                       {1, 1, 0},
                       {0, 1, -h},
                       {-1, 1, 0},
                       {-1, 0, h},
                       {-1, -1, 0},
                       {0, -1, -h},
                       {1, -1, 0}});
    };
    // The inward normal of the side (1,0,h), (1,1,0) is (h, -h, -1), and by symmetry all are
    // (+-h, +-h, -1): straight down sees them all, however steep they are.
    EXPECT_FALSE(apex_is_blind(saddle(0.5f)));
    EXPECT_FALSE(apex_is_blind(saddle(1e6f)));
}

// Three sides that hold the z axis, their normals once round it with the sum 0: nothing sees them.
// Tilted by e, the third is seen with the others from far up the axis or far down. A fourth side
// leaves the lower half only. However small e is, its sign decides; doubles round it away.
TEST(BlindVertices, ANarrowConeIsToldFromNoneByTheSignOfATinyNumber)
{
    const auto sides = [](float e) {
        TriangleMesh mesh;
        mesh.points = {{0, 0, 0},      {0, 0, 1}, {1, 0, 0}, {-0.5f, 1, 0},
                       {-0.5f, -1, 0}, {e, 0, 1}, {0, 1, 0}};
        mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 5, 4}};
        return mesh;
    };
    EXPECT_TRUE(apex_is_blind(sides(0)));
    for (const float e : {1.f, 1e-5f, 1e-10f, 1e-20f, 1e-30f})
        for (const float sign : {-1.f, 1.f}) {
            TriangleMesh mesh = sides(sign * e);
            EXPECT_FALSE(apex_is_blind(mesh)) << e;
            mesh.triangles.emplace_back(0, 2, 6);
            EXPECT_EQ(apex_is_blind(mesh), sign > 0) << e;
        }
}

using Whole = std::array<long long, 3>;

long long dot(const Whole& a, const Whole& b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Whole cross(const Whole& a, const Whole& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Inward normals of the triangles that have an area. Coordinates are small whole numbers.
std::vector<Whole> whole_normals(const TriangleMesh& mesh)
{
    std::vector<Whole> normals;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d c = Vec3d(mesh.points[t[2]]).cross(Vec3d(mesh.points[t[1]]));
        if (c.lengthSqr() > 0)
            normals.push_back({std::llround(c[0]), std::llround(c[1]), std::llround(c[2])});
    }
    return normals;
}

bool span_space(const std::vector<Whole>& n)
{
    for (const Whole& a : n)
        for (const Whole& b : n)
            for (const Whole& c : n)
                if (dot(cross(a, b), c) != 0)
                    return true;
    return false;
}

/// Of normals that span space: the directions that see no side from outside are a pointed cone, and
/// the sum of its edges, in each of which two planes meet, is within it if anything is.
bool any_direction(const std::vector<Whole>& n)
{
    Whole sum{0, 0, 0};
    for (const Whole& a : n)
        for (const Whole& b : n) {
            const Whole ray = cross(a, b);
            if (std::all_of(n.begin(), n.end(), [&](const Whole& m) { return dot(m, ray) >= 0; }))
                for (std::size_t k = 0; k < 3; ++k)
                    sum[k] += ray[k];
        }
    return std::all_of(n.begin(), n.end(), [&](const Whole& m) { return dot(m, sum) > 0; });
}

TEST(BlindVertices, AreThoseThatNoEdgeOfTheConeServes)
{
    const CounterRandom random(7);
    int blind = 0, seen = 0;
    for (std::uint64_t trial = 0; trial < 4000; ++trial) {
        std::vector<openvdb::Vec3s> rim;
        for (std::size_t i = 0; i < 3 + trial % 5; ++i) {
            const auto whole = [&](std::uint64_t axis) {
                return float(random.below(trial * 64 + i * 4 + axis, 7)) - 3;
            };
            rim.emplace_back(whole(0), whole(1), whole(2));
        }
        const TriangleMesh mesh = fan_of(rim);
        const std::vector<Whole> normals = whole_normals(mesh);
        if (!span_space(normals))
            continue;
        const bool any = any_direction(normals);
        EXPECT_EQ(apex_is_blind(mesh), !any) << trial;
        ++(any ? seen : blind);
    }
    EXPECT_GT(blind, 200);
    EXPECT_GT(seen, 200);
}

} // namespace

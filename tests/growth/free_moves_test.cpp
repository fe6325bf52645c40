// SPDX-License-Identifier: Apache-2.0
#include "growth/free_moves.h"

#include "growth/move_tests.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;

/// A sphere of radius 1 whose inner points lie at 0.5.
struct HalfFull {
    TriangleMesh mesh = test::icosphere(1.0, 3);
    Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    GrowState s;

    HalfFull()
        : s(make_state(
              connectivity, mesh.points,
              std::vector<double>(mesh.points.size(), std::numeric_limits<double>::infinity())))
    {
        for (std::size_t v = 0; v < s.b.size(); ++v)
            s.b[v] = rounded(0.5 * s.a[v]);
    }
    void move(const FreeStage& stage)
    {
        GrowReport report;
        move_freely(s, std::vector<double>(s.b.size(), 1.0), GrowOptions{}, stage,
                    StageProgress(nullptr, "test"), report);
    }
};

constexpr double kSoftness = 0.01;

TEST(FreeMoves, AsksOnlyWhereSomethingIsToBeWonAndBeside)
{
    HalfFull sphere;
    const std::vector<Vec3d> before = sphere.s.b;
    const int hopeful = 100;
    std::vector<double> hope(before.size(), 0.0);
    hope[hopeful] = 1.0;
    sphere.move({1, kSoftness, 0.5, 0.0, 0.0, 0.0, -1.0, 1e-3, hope});
    int moved = 0;
    for (int v = 0; v < sphere.s.mesh->vertices; ++v) {
        if (sphere.s.b[v] == before[v])
            continue;
        ++moved;
        const Slice<int> around = neighbours(*sphere.s.mesh, v);
        EXPECT_TRUE(v == hopeful ||
                    std::find(around.begin(), around.end(), hopeful) != around.end())
            << v;
    }
    EXPECT_GT(moved, 3);
}

TEST(FreeMoves, WithoutHopesAllAreAsked)
{
    HalfFull sphere;
    const std::vector<Vec3d> before = sphere.s.b;
    sphere.move({1, kSoftness, 0.5, 0.0, 0.0, 0.0, -1.0, 1e-3});
    for (std::size_t v = 0; v < before.size(); ++v)
        EXPECT_NE(sphere.s.b[v], before[v]) << v;
}

TEST(FreeMoves, EndsWhenNobodyHopes)
{
    HalfFull sphere;
    const std::vector<Vec3d> before = sphere.s.b;
    sphere.move(
        {40, kSoftness, 0.5, 0.0, 0.0, 0.0, 1e-6, 1e-3, std::vector<double>(before.size(), 0.0)});
    EXPECT_EQ(sphere.s.b, before);
}

} // namespace

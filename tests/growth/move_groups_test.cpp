// SPDX-License-Identifier: Apache-2.0
#include "growth/move_groups.h"

#include "growth/grown.h"
#include "growth/move_tests.h"
#include "growth/violations.h"
#include "support/shapes.h"

#include <tbb/global_control.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;
using test::kInfinity;

/// A shell over part of the way to a point or a sheet, on a surface of many triangles.
struct Partial {
    TriangleMesh mesh, coarse;
    Connectivity connectivity;
    GrowState s;

    Partial(TriangleMesh fine, TriangleMesh coarser, double cap)
        : mesh(std::move(fine)), coarse(std::move(coarser)),
          connectivity(connect(mesh.points.size(), mesh.triangles)),
          s(make_state(connectivity, mesh.points, std::vector<double>(mesh.points.size(), cap)))
    {
        // The void is spread evenly here, and by default only what stands before much of it moves.
        s.schedule.groups.least_void = 1;
    }
    std::size_t move()
    {
        return move_groups(
            s, group_shares(coarse, nearest_coarse_points(mesh, coarse, MultilevelSchedule{})),
            StageProgress(nullptr, "test"));
    }
    bool valid()
    {
        const std::vector<std::uint8_t> bad =
            violating_faces(s, std::vector<std::uint8_t>(mesh.triangles.size(), 1), true);
        return std::none_of(bad.begin(), bad.end(), [](std::uint8_t b) { return b != 0; });
    }
};

/// A unit sphere whose inner points lie at 0.6: .784 of it is full.
Partial sphere(double cap = kInfinity)
{
    Partial shell(test::icosphere(1.0, 4), test::icosphere(1.0, 2), cap);
    for (std::size_t v = 0; v < shell.s.b.size(); ++v)
        shell.s.b[v] = rounded(0.6 * shell.s.a[v]);
    return shell;
}

/// A plate of 2 by 2 by 0.4 whose inner surface is the same at .7 of its size: .657 of it is full.
Partial plate()
{
    const Vec3d low(-1, -1, -0.2), high(1, 1, 0.2);
    Partial shell(test::gridded_box(low, high, 24), test::gridded_box(low, high, 6), kInfinity);
    for (std::size_t v = 0; v < shell.s.b.size(); ++v)
        shell.s.b[v] = rounded(0.7 * shell.s.a[v]);
    return shell;
}

TEST(MoveGroups, FillsAVoidAsWideAsManyTriangles)
{
    Partial shell = sphere();
    ASSERT_TRUE(shell.valid());
    EXPECT_GT(shell.move(), 0u);
    // An edge is 0.04 long, the void 1.2 across.
    EXPECT_GT(fill_of(shell.s), 0.9);
    EXPECT_TRUE(shell.valid());
}

TEST(MoveGroups, SheetsThatFaceEachOtherComeCloseAndDoNotMeet)
{
    Partial shell = plate();
    ASSERT_TRUE(shell.valid());
    shell.move();
    EXPECT_GT(fill_of(shell.s), 0.9);
    EXPECT_TRUE(shell.valid());
}

TEST(MoveGroups, NoPillarBecomesLongerThanItMay)
{
    const double cap = 0.45;
    Partial shell = sphere(cap);
    shell.move();
    EXPECT_GT(fill_of(shell.s), 0.784);
    for (int v = 0; v < shell.s.mesh->vertices; ++v)
        EXPECT_TRUE(within_cap(shell.s, v, shell.s.b[v])) << v;
    EXPECT_TRUE(shell.valid());
}

TEST(MoveGroups, PinsStayWhereTheyAre)
{
    Partial shell = sphere();
    for (const int v : {0, 17, 1000}) {
        shell.s.pinned[v] = 1;
        shell.s.b[v] = shell.s.a[v];
    }
    ASSERT_TRUE(shell.valid());
    shell.move();
    for (const int v : {0, 17, 1000})
        EXPECT_EQ(shell.s.b[v], shell.s.a[v]);
    EXPECT_TRUE(shell.valid());
}

TEST(MoveGroups, LeavesAFullSolidAlone)
{
    Partial shell = sphere();
    for (std::size_t v = 0; v < shell.s.b.size(); ++v)
        shell.s.b[v] = rounded(0.1 * shell.s.a[v]);
    const std::vector<Vec3d> before = shell.s.b;
    EXPECT_EQ(shell.move(), 0u);
    EXPECT_EQ(shell.s.b, before);
}

TEST(MoveGroups, SameForAnyNumberOfThreads)
{
    Partial first = plate(), second = plate();
    {
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        first.move();
    }
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    second.move();
    EXPECT_EQ(first.s.b, second.s.b);
}

} // namespace

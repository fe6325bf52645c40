// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/shared_points.h"

#include "support/tapered.h"

#include "vdb_shell/shell/tessellate.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3s;
using Places = std::vector<std::uint32_t>;

TEST(SharedPoints, UntaperedStacksSharePinsOnly)
{
    const TriangleMesh cube = test::octahedron();
    ShellStack stack = test::tapered_stack(
        {cube.points, test::all_at(Vec3s(0), 6), test::all_at(Vec3s(0), 6)}, cube.triangles);
    stack.tapered = false;
    Places expected(18);
    std::iota(expected.begin(), expected.begin() + 12, 0U);
    std::iota(expected.begin() + 12, expected.end(), 6U); // pinned in the second layer
    EXPECT_EQ(first_places(stack), expected);
    stack.tapered = true;
    std::fill(expected.begin() + 6, expected.end(), 6U);
    EXPECT_EQ(first_places(stack), expected);
}

TEST(SharedPoints, ZerosOfEitherSignAreOnePoint)
{
    const TriangleMesh mesh = test::octahedron();
    std::vector<Vec3s> inner(6, Vec3s(0));
    inner[0] = mesh.points[0];
    inner[0][1] = -0.0f; // pinned: equal as numbers
    inner[3] = Vec3s(0, -0.0f, 0);
    inner[4] = mesh.points[2]; // sideways
    const ShellStack stack = test::tapered_stack({mesh.points, inner}, mesh.triangles);
    EXPECT_TRUE(stack.layers[0].pinned(0));
    EXPECT_EQ(first_places(stack), (Places{0, 1, 2, 3, 4, 5, 0, 7, 7, 7, 2, 7}));
}

void expect_same(const TetMesh& a, const TetMesh& b)
{
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.tets, b.tets);
    EXPECT_EQ(a.prism, b.prism);
    EXPECT_EQ(a.prism_layer, b.prism_layer);
    EXPECT_EQ(a.source_vertex, b.source_vertex);
    EXPECT_EQ(a.layer, b.layer);
}

TEST(SharedPoints, WithoutSharedPointsATaperedStackHasTheSameTets)
{
    for (const test::SplitShell& made :
         {test::folded_shell(), test::pierced_shell(), test::twisted_shell(1.2)}) {
        ShellStack stack = one_layer(made.shell, made.split);
        const TetMesh tets = make_tets(stack);
        stack.tapered = true;
        expect_same(make_tets(stack), tets);
    }
}

TEST(SharedPoints, AConeHasOneTetForEachTriangle)
{
    const TriangleMesh ball = test::icosphere(1, 2);
    const TetMesh tets = make_tets(test::coned(ball, Vec3s(0)));
    EXPECT_EQ(tets.tets.size(), ball.triangles.size());
    EXPECT_EQ(tets.points.size(), ball.points.size() + 1);
    EXPECT_EQ(tets.source_vertex.back(), 0U); // the first place that shares the point
    EXPECT_EQ(tets.layer.back(), 1U);
    EXPECT_NEAR(tet_volume(tets), signed_volume(ball.points, ball.triangles), 1e-12);
    // To a vertex: its own triangles have no tets.
    const TriangleMesh mesh = test::octahedron();
    const TetMesh four = make_tets(test::coned(mesh, mesh.points[0]));
    EXPECT_EQ(four.tets.size(), 4U);
    EXPECT_EQ(four.points, mesh.points);
}

TEST(SharedPoints, PrismsHaveOneTetLessForEachPointShared)
{
    const TetMesh sheets = make_tets(test::two_sheets());
    EXPECT_EQ(sheets.tets.size(), 24U);
    EXPECT_EQ(sheets.points.size(), 6U + 5U);
    EXPECT_NEAR(tet_volume(sheets), 4.0 / 3, 1e-6);
    const ShellStack stack = test::layers_to_a_point();
    const TetMesh tets = make_tets(stack);
    std::set<std::array<float, 3>> places;
    for (const Vec3s& p : tets.points)
        places.insert({p[0], p[1], p[2]});
    EXPECT_EQ(places.size(), tets.points.size());
    EXPECT_EQ(tets.points.size(), 42U + 42U + 40U + 1U);
    // In the second layer a triangle has lost two corners and its three neighbours one each; in the
    // third each triangle of the surface above has one tet.
    EXPECT_EQ(tets.tets.size(), 80U * 3 + (80U * 3 - 2 - 3) + (80U - 4));
}

TEST(SharedPoints, InnerSurfaceIsWhatIsLeftOfIt)
{
    EXPECT_TRUE(inner_surface(test::two_sheets()).triangles.empty());
    EXPECT_TRUE(inner_surface(test::coned(test::octahedron(), Vec3s(0))).points.empty());
    const ShellStack rod = test::pinched_rod();
    const TriangleMesh cavities = inner_surface(rod);
    EXPECT_EQ(cavities.points.size(), rod.surface(1).size() - 5);
    EXPECT_EQ(cavities.triangles.size(), rod.triangles().size() - 12);
    EXPECT_NEAR(signed_volume(rod.surface(0), rod.triangles()) -
                    signed_volume(cavities.points, cavities.triangles),
                tet_volume(make_tets(rod)), 1e-6);
    ShellStack plain = rod;
    plain.tapered = false;
    EXPECT_EQ(inner_surface(plain).points, rod.surface(1));
    EXPECT_EQ(inner_surface(plain).triangles, rod.triangles());
}

} // namespace

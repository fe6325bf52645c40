// SPDX-License-Identifier: Apache-2.0
#include "mesh/curve_order.h"

#include "core/counter_random.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace
{

using namespace vdb_shell;

std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed)
{
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    const CounterRandom random(seed);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return random.unit(a) < random.unit(b); });
    return order;
}

TriangleMesh in_no_order(const TriangleMesh& mesh)
{
    return in_order(mesh, {shuffled(mesh.points.size(), 1), shuffled(mesh.triangles.size(), 2)});
}

double mean_distance_of_corners(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const openvdb::Vec3I& t : mesh.triangles)
        sum += double(std::max({t[0], t[1], t[2]}) - std::min({t[0], t[1], t[2]}));
    return sum / double(mesh.triangles.size());
}

TEST(CurveOrder, HasEveryVertexAndTriangleOnce)
{
    const TriangleMesh mesh = in_no_order(test::icosphere(1, 4));
    const MeshOrder order = curve_order(mesh, 0);
    for (auto list : {order.vertices, order.triangles}) {
        std::sort(list.begin(), list.end());
        for (std::uint32_t i = 0; i < list.size(); ++i)
            ASSERT_EQ(list[i], i);
    }
    EXPECT_EQ(order.vertices.size(), mesh.points.size());
    EXPECT_EQ(order.triangles.size(), mesh.triangles.size());
}

TEST(CurveOrder, TrianglesStayWhatTheyAre)
{
    const TriangleMesh mesh = in_no_order(test::icosphere(1, 3));
    const MeshOrder order = curve_order(mesh, 0);
    const TriangleMesh ordered = in_order(mesh, order);
    for (std::size_t t = 0; t < ordered.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(ordered.points[ordered.triangles[t][k]],
                      mesh.points[mesh.triangles[order.triangles[t]][k]]);
}

// A surface has as many vertices within a distance as its square says, so a triangle's stand about
// the square root of their number apart on any good curve.
TEST(CurveOrder, CornersOfATriangleComeNearEachOther)
{
    const TriangleMesh mesh = in_no_order(test::icosphere(1, 5));
    const TriangleMesh ordered = in_order(mesh, curve_order(mesh, 0));
    const double vertices = double(mesh.points.size());
    EXPECT_GT(mean_distance_of_corners(mesh), vertices / 3);
    EXPECT_LT(mean_distance_of_corners(ordered), 3 * std::sqrt(vertices));
}

TEST(CurveOrder, LetsAGoodOrderBe)
{
    const TriangleMesh mesh = in_no_order(test::icosphere(1, 3));
    const MeshOrder order = curve_order(mesh, 0);
    ASSERT_FALSE(order.own());
    EXPECT_TRUE(curve_order(in_order(mesh, order), 0).own());
    // Row by row, the corners of a triangle are a row apart.
    EXPECT_TRUE(curve_order(test::torus(3, 1, 2000, 4), 0).own());
}

TEST(CurveOrder, LetsFewTrianglesBe)
{
    const TriangleMesh mesh = in_no_order(test::icosphere(1, 3));
    EXPECT_TRUE(curve_order(mesh).own());
    EXPECT_TRUE(curve_order(mesh, mesh.triangles.size() + 1).own());
    EXPECT_FALSE(curve_order(mesh, mesh.triangles.size()).own());
}

TEST(CurveOrder, PointsInOnePlaceHaveAnOrderToo)
{
    TriangleMesh mesh = test::box(openvdb::Vec3d(1), openvdb::Vec3d(2));
    std::fill(mesh.points.begin(), mesh.points.end(), openvdb::Vec3s(1));
    EXPECT_TRUE(curve_order(mesh, 0).own());
}

TEST(CurveOrder, ValuesComeBackToWhereTheyWere)
{
    const std::vector<std::uint32_t> order = shuffled(100, 3);
    std::vector<int> values(order.size());
    std::iota(values.begin(), values.end(), 1000);
    const std::vector<int> ordered = values_at(values, order);
    EXPECT_NE(ordered, values);
    EXPECT_EQ(out_of_order(ordered, order), values);
    for (std::size_t i = 0; i < order.size(); ++i)
        EXPECT_EQ(places_of(order)[order[i]], i);
}

} // namespace

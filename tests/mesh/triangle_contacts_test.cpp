// SPDX-License-Identifier: Apache-2.0
#include "mesh/triangle_contacts.h"

#include "core/counter_random.h"
#include "core/exact.h"
#include "mesh/topology.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace vdb_shell;

std::vector<std::uint32_t> rim_of(const TriangleMesh& mesh, std::size_t vertex)
{
    const Rims rims = rims_around_vertices(mesh.points.size(), mesh.triangles);
    const VertexTriangles::Range rim = rims.of(vertex);
    return {rim.begin(), rim.end()};
}

TEST(Rims, TurnRoundTheVertexAsItsTrianglesDo)
{
    const TriangleMesh mesh = test::icosphere(1.0, 2);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        const std::vector<std::uint32_t> rim = rim_of(mesh, v);
        ASSERT_GE(rim.size(), 5U);
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const openvdb::Vec3I wanted(std::uint32_t(v), rim[i], rim[(i + 1) % rim.size()]);
            EXPECT_TRUE(std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                                    [&](const openvdb::Vec3I& t) {
                                        return t == wanted ||
                                               openvdb::Vec3I(t[1], t[2], t[0]) == wanted ||
                                               openvdb::Vec3I(t[2], t[0], t[1]) == wanted;
                                    }))
                << v << " " << i;
        }
    }
}

TEST(Rims, AreThereForOneClosedFanOnly)
{
    const TriangleMesh tetrahedron = test::unit_tetrahedron();
    EXPECT_EQ(rim_of(tetrahedron, 0).size(), 3U);
    const TriangleMesh open = test::without_triangle(tetrahedron, 0);
    for (int k = 0; k < 3; ++k)
        EXPECT_TRUE(rim_of(open, tetrahedron.triangles[0][k]).empty());
    // Two that share a corner.
    TriangleMesh pair = test::joined(tetrahedron, test::translated(tetrahedron, {2, 0, 0}));
    for (openvdb::Vec3I& t : pair.triangles)
        for (int k = 0; k < 3; ++k)
            t[k] = t[k] == 4 ? 1 : t[k];
    EXPECT_TRUE(rim_of(pair, 1).empty());
    EXPECT_EQ(rim_of(pair, 0).size(), 3U);
    EXPECT_TRUE(rim_of(pair, 4).empty()) << "of no triangle";
    TriangleMesh turned = tetrahedron;
    std::swap(turned.triangles[0][0], turned.triangles[0][1]);
    EXPECT_TRUE(rim_of(turned, turned.triangles[0][0]).empty());
}

TEST(TriangleContacts, AreThoseOfTheExactTest)
{
    for (const double noise : {0.0, 0.1, 0.8}) {
        TriangleMesh mesh = test::torus(1.0, 0.4, 14, 9);
        const CounterRandom random(7);
        for (std::size_t v = 0; v < mesh.points.size(); ++v)
            for (int k = 0; k < 3; ++k)
                mesh.points[v][k] += float(noise * (random.unit(3 * v + std::uint64_t(k)) - 0.5));
        const TriangleContacts contacts(mesh.points, mesh.triangles);
        int touching = 0;
        for (std::uint32_t a = 0; a < mesh.triangles.size(); ++a)
            for (std::uint32_t b = a + 1; b < mesh.triangles.size(); ++b) {
                const bool touch =
                    exact::triangles_touch(mesh.points, mesh.triangles[a], mesh.triangles[b]);
                touching += touch;
                ASSERT_EQ(contacts.touch(a, b), touch) << noise << " " << a << " " << b;
            }
        EXPECT_EQ(touching > 100, noise > 0.2) << touching;
    }
}

} // namespace

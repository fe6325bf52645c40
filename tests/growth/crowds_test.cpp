// SPDX-License-Identifier: Apache-2.0
#include "growth/active_set.h"

#include "growth/move_tests.h"
#include "growth/violations.h"
#include "support/shapes.h"
#include "vdb_shell/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace
{

using openvdb::Vec3s;
using namespace vdb_shell;
using namespace vdb_shell::growth;

/// Two cones over one rim, whose ends have as many triangles as it has corners.
TriangleMesh two_cones(std::uint32_t rim)
{
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < rim; ++i) {
        const double angle = 2 * M_PI * i / rim;
        mesh.points.emplace_back(float(std::cos(angle)), float(std::sin(angle)), 0.0F);
    }
    mesh.points.emplace_back(0.0F, 0.0F, 1.0F);
    mesh.points.emplace_back(0.0F, 0.0F, -1.0F);
    for (std::uint32_t i = 0; i < rim; ++i) {
        mesh.triangles.emplace_back(i, (i + 1) % rim, rim);
        mesh.triangles.emplace_back((i + 1) % rim, i, rim + 1);
    }
    return mesh;
}

std::ptrdiff_t left_out(const TriangleMesh& mesh)
{
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    const GrowState s = make_state(
        connectivity, mesh.points,
        std::vector<double>(mesh.points.size(), std::numeric_limits<double>::infinity()));
    std::vector<std::uint8_t> inactive(mesh.points.size());
    leave_out_crowds(s, inactive);
    return std::count(inactive.begin(), inactive.end(), 1);
}

TEST(Crowds, VerticesOfThousandsOfTrianglesAndThoseBesideThemAreLeftOut)
{
    EXPECT_EQ(left_out(two_cones(1025)), 1027);
    EXPECT_EQ(left_out(two_cones(1024)), 0);
    EXPECT_EQ(left_out(test::icosphere(1.0, 3)), 0);
}

TEST(Crowds, OneAmongManyOtherTrianglesIsNot)
{
    // All fans together are as much work as on a good surface.
    TriangleMesh mesh = test::icosphere(1.0, 6);
    const TriangleMesh cones = test::translated(two_cones(1100), {5, 0, 0});
    const auto first = std::uint32_t(mesh.points.size());
    mesh.points.insert(mesh.points.end(), cones.points.begin(), cones.points.end());
    for (const openvdb::Vec3I& t : cones.triangles)
        mesh.triangles.emplace_back(t[0] + first, t[1] + first, t[2] + first);
    EXPECT_EQ(left_out(mesh), 0);
}

TEST(Crowds, ContactsAreThoseOfEachTriangleByItself)
{
    // A ball in the way of the inner cones.
    const openvdb::Vec3d middle(0.25, 0, 0.25);
    const TriangleMesh cones = two_cones(1100);
    const TriangleMesh mesh =
        test::joined(cones, test::translated(test::icosphere(0.1, 1), middle));
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    GrowState s = make_state(
        connectivity, mesh.points,
        std::vector<double>(mesh.points.size(), std::numeric_limits<double>::infinity()));
    ASSERT_TRUE(connectivity.has_crowds);
    for (std::size_t v = 0; v < s.b.size(); ++v) {
        const openvdb::Vec3d to = v < cones.points.size() ? openvdb::Vec3d(0.0) : middle;
        s.b[v] = rounded(0.5 * (s.a[v] + to));
    }
    const std::vector<std::uint8_t> all(mesh.triangles.size(), 1);
    const std::vector<std::uint8_t> bad = violating_faces(s, all, true);
    std::ptrdiff_t contacts = 0;
    for (int f = 0; f < connectivity.face_count(); ++f) {
        EXPECT_EQ(bad[std::size_t(f)] == 0, faces_valid(s, {f})) << f;
        contacts += !inner_triangle_clear(s, f);
    }
    EXPECT_GT(contacts, 10);
    EXPECT_LT(std::count(bad.begin(), bad.end(), 1), std::ptrdiff_t(bad.size()) / 2);
}

TEST(Crowds, VerticesOfAColourHaveNoNeighbourInCommon)
{
    const TriangleMesh mesh = two_cones(1100);
    const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
    std::size_t vertices = 0;
    for (const std::vector<int>& colour : connectivity.colour) {
        std::vector<int> seen(mesh.points.size());
        for (const int v : colour) {
            ++seen[std::size_t(v)];
            for (const int u : neighbours(connectivity, v))
                ++seen[std::size_t(u)];
        }
        EXPECT_LE(*std::max_element(seen.begin(), seen.end()), 1);
        vertices += colour.size();
    }
    EXPECT_EQ(vertices, mesh.points.size());
}

TEST(Crowds, TheirShellsAreProvenAndFillTheSolid)
{
    ShellOptions options;
    options.level_set.resolution = 32;
    options.coverage.samples = 0;
    const ShellResult result = build_shell(two_cones(3000), options);
    EXPECT_TRUE(result.report.certificate->certified());
    EXPECT_GT(result.report.fill, 0.9);
}

} // namespace

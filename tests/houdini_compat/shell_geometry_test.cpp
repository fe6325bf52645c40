// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/houdini/shell_geometry.h"

#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/io/read_mesh.h"
#include "vdb_shell/pipeline.h"

#include "houdini_compat/geometries.h"
#include "houdini_compat/round_trip.h"
#include "support/files.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using test::expect_round_trips;
using test::has;
using test::held;
using test::refusal_of_changed;
using test::scaled_shell_file;
using test::values_of;

/// With pinned corners, of which triangle 0 has all, and zeros of both signs.
ShellFile pinned_shell()
{
    TriangleMesh mesh = test::box({0, 0, 0}, {1, 1, 1});
    for (Vec3s& p : mesh.points)
        p -= Vec3s(0.5f, 0.5f, 0);
    const openvdb::Vec3I first = mesh.triangles[0];
    ShellFile file = scaled_shell_file(mesh, 0.5f, {first[0], first[1], first[2]});
    file.stack.layers.front().outer[first[0]][2] = -0.0f;
    file.stack.layers.front().inner[first[0]][2] = 0.0f;
    file.tets = make_tets(file.stack);
    return file;
}

TEST(ShellGeometry, EveryFormGivesTheSameShellBackBitForBit)
{
    expect_round_trips(scaled_shell_file(test::icosphere(1.0, 2), 0.5f));
    expect_round_trips(pinned_shell());
    ShellFile bare = scaled_shell_file(test::unit_tetrahedron(), 0.5f);
    bare.report_json.clear();
    bare.parameters_json.clear();
    expect_round_trips(bare);
}

TEST(ShellGeometry, APosedShellKeepsItsRestBitForBit)
{
    ShellFile file = scaled_shell_file(test::icosphere(1.0, 2), 0.5f);
    for (std::size_t k = 0; k < file.stack.surfaces(); ++k) {
        file.rest.surface.push_back(file.stack.surface(k));
        for (Vec3s& p : file.rest.surface.back())
            p = Vec3s(p[1] / 3, -p[2], p[0] + 5);
    }
    expect_round_trips(file);
    const ShellFile read = shell_of_geometry(shell_geometry(file), "s");
    EXPECT_EQ(read.rest.surface, file.rest.surface);
    EXPECT_TRUE(read.rest.velocity.empty());
    file.rest.velocity.surface = file.rest.surface;
    EXPECT_EQ(shell_of_geometry(shell_geometry(file), "s").rest.velocity.surface,
              file.rest.surface);
    file.rest = {};
    EXPECT_FALSE(shell_of_geometry(shell_geometry(file), "s").rest.posed());
}

Vec3d position(const HoudiniGeometry& geometry, std::size_t vertex)
{
    const auto& p = std::get<std::vector<float>>(find(geometry.point_attributes, "P")->values);
    const std::size_t point = geometry.vertex_point[vertex];
    return {p[3 * point], p[3 * point + 1], p[3 * point + 2]};
}

TEST(ShellGeometry, HasHoudinisOrientation)
{
    const ShellFile file = scaled_shell_file(test::icosphere(1.0, 1), 0.5f);
    const HoudiniGeometry geometry = shell_geometry(file);
    std::size_t vertex = 0, tets = 0;
    double outer = 0, inner = 0, shell = 0;
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i) {
        const auto corner = [&](std::size_t k) { return position(geometry, vertex + k); };
        if (geometry.primitives[i].type == PrimitiveType::tetrahedron) {
            const double det =
                (corner(1) - corner(0)).dot((corner(2) - corner(0)).cross(corner(3) - corner(0)));
            EXPECT_LT(det, 0.0);
            shell -= det / 6;
            ++tets;
        } else {
            const double det = corner(0).dot(corner(1).cross(corner(2)));
            // Clockwise seen from outside, and outside is away from the origin.
            EXPECT_LT(det, 0.0);
            (find(geometry.primitive_groups, "outer")->members[i] ? outer : inner) -= det / 6;
        }
        vertex += geometry.primitives[i].vertices;
    }
    EXPECT_EQ(tets, 3u * 80u);
    EXPECT_NEAR(inner, outer / 8, 1e-6);
    EXPECT_NEAR(shell, outer - inner, 1e-6);
}

std::size_t members(const std::vector<Group>& groups, const char* name)
{
    const Group* group = find(groups, name);
    return group ? static_cast<std::size_t>(
                       std::count(group->members.begin(), group->members.end(), true))
                 : SIZE_MAX;
}

TEST(ShellGeometry, AttributesAndGroupsSayWhatThePillarsAre)
{
    const HoudiniGeometry g = shell_geometry(pinned_shell());
    ASSERT_EQ(g.points, 8u + 5u);
    const auto floats = [&](const char* name) {
        return std::get<std::vector<float>>(find(g.point_attributes, name)->values);
    };
    const auto& source =
        std::get<std::vector<std::int32_t>>(find(g.point_attributes, "source_vertex")->values);
    const auto& reason = std::get<Strings>(find(g.point_attributes, "stop_reason")->values);
    const auto &pinned = find(g.point_groups, "pinned")->members,
               &inner = find(g.point_groups, "inner")->members;
    const std::vector<float> p = floats("P"), n = floats("N");
    EXPECT_EQ(floats("rest"), p);
    for (std::size_t i = 0; i < g.points; ++i) {
        EXPECT_EQ(inner[i], i >= 8);
        EXPECT_EQ(floats("depth")[i], i < 8 ? 0.0f : 1.0f);
        EXPECT_EQ(reason.at(i), pinned[i] ? "pinned" : "thickness");
        const Vec3d here(p[3 * i], p[3 * i + 1], p[3 * i + 2]);
        // The centre of scaling is the origin, so a pillar is as long as its lower end is far away.
        const double length = pinned[i] ? 0.0 : here.length() / (i < 8 ? 2 : 1);
        EXPECT_NEAR(floats("thickness")[i], length, 1e-6) << i;
        EXPECT_NEAR(Vec3d(n[3 * i], n[3 * i + 1], n[3 * i + 2]).length(), 1.0, 1e-6) << i;
        EXPECT_EQ(source[i] == static_cast<std::int32_t>(i), i < 8);
    }
    EXPECT_EQ(members(g.point_groups, "outer"), 8u);
    EXPECT_EQ(members(g.point_groups, "pinned"), 3u);
    const std::size_t tets = members(g.primitive_groups, "shell");
    EXPECT_EQ(tets + 24, g.primitives.size());
    EXPECT_EQ(members(g.primitive_groups, "outer"), 12u);
    EXPECT_EQ(members(g.primitive_groups, "inner"), 12u);
    EXPECT_EQ(members(g.primitive_groups, "pinned"), 2u);
    EXPECT_EQ(held<std::int32_t>(g.primitive_attributes, "layer"),
              (std::vector<std::int32_t>(g.primitives.size(), 0)));
    const auto& quality =
        std::get<std::vector<float>>(find(g.primitive_attributes, "quality")->values);
    EXPECT_EQ(quality[tets], 0.0f); // the prism without tets
    for (std::size_t i = 0; i < tets; ++i)
        EXPECT_GE(quality[i], 0.0f);
}

TEST(ShellGeometry, DetailHasTheFiguresOfTheReport)
{
    const HoudiniGeometry g = shell_geometry(pinned_shell());
    EXPECT_EQ(held<double>(g.detail_attributes, "fill"), (std::vector<double>{0.25}));
    EXPECT_EQ(held<std::int32_t>(g.detail_attributes, "certified"), (std::vector<std::int32_t>{1}));
    EXPECT_EQ(held<std::int32_t>(g.detail_attributes, "pinned_vertices"),
              (std::vector<std::int32_t>{3}));
    EXPECT_EQ(find(g.detail_attributes, "shell_volume"), nullptr);
}

template <typename Change> std::string refusal_after(const Change& change)
{
    return refusal_of_changed(pinned_shell(), change);
}

TEST(ShellGeometry, SaysWhichCountContradicts)
{
    has(refusal_after([](auto& g) { g.detail_attributes.clear(); }), "holds no shell");
    has(refusal_after([](auto& g) {
            values_of<std::int32_t>(g.detail_attributes, "vdb_shell_schema")[0] = 99;
        }),
        "\"vdb_shell_schema\" is 99, schemas 1 to");
    has(refusal_after([](auto& g) {
            values_of<std::int32_t>(g.detail_attributes, "vdb_shell_prisms")[0] = 11;
        }),
        "11 prisms");
    has(refusal_after([](auto& g) {
            values_of<std::int32_t>(g.detail_attributes, "vdb_shell_vertices")[0] = 14;
        }),
        "\"vdb_shell_vertices\" is 14, which is not in [0, 13]");
}

TEST(ShellGeometry, SaysWhichElementContradicts)
{
    has(refusal_after(
            [](auto& g) { values_of<std::int32_t>(g.point_attributes, "source_vertex")[9] = 8; }),
        "\"source_vertex\" of point 9 is 8 of 8");
    has(refusal_after([](auto& g) {
            const auto& pinned = find(g.point_groups, "pinned")->members;
            const auto free = std::find(pinned.begin(), pinned.end(), false) - pinned.begin();
            values_of<float>(g.point_attributes, "P")[static_cast<std::size_t>(3 * free)] += 1;
        }),
        "checksum");
    has(refusal_after([](auto& g) { values_of<float>(g.point_attributes, "P")[27] += 1; }),
        "\"P\" of point 9");
    has(refusal_after(
            [](auto& g) { values_of<std::int32_t>(g.primitive_attributes, "prism").back() = 12; }),
        "is 12 of 12");
    has(refusal_after([](auto& g) {
            std::int32_t& last =
                values_of<std::int32_t>(g.primitive_attributes, "split_order").back();
            last = (last + 1) % 3;
        }),
        "split_order");
    has(refusal_after([](auto& g) { g.vertex_point.back() = g.vertex_point[0]; }), "prism 11");
    has(refusal_after([](auto& g) { std::swap(g.vertex_point[2], g.vertex_point[3]); }),
        "checksum");
    has(refusal_after([](auto& g) { g.point_attributes.pop_back(); }),
        "point attribute \"stop_reason\" is missing");
    has(refusal_after([](auto& g) { g.point_attributes[6].values = std::vector<float>(13); }),
        "\"source_vertex\" is not of the type");
    has(refusal_after(
            [](auto& g) { std::get<Strings>(g.point_attributes.back().values).table[0] = "whim"; }),
        "\"whim\"");
}

TEST(ShellGeometry, CheckCertifiesWhatWasReadBack)
{
    const test::TemporaryFolder folder;
    ShellOptions options;
    options.level_set.resolution = 16;
    options.coverage.samples = 0;
    test::expect_verified_files(folder, test::file_of_built(options, test::icosphere(1.0, 2)));
}

TEST(ShellGeometry, RoundTripsOnEveryCleanMesh)
{
    VDB_SHELL_NEEDS_REAL_MESHES();
    for (const std::string& name : test::clean_meshes()) {
        SCOPED_TRACE(name);
        const TriangleMesh mesh = read_mesh(test::real_meshes() / (name + ".obj")).mesh;
        expect_round_trips(scaled_shell_file(mesh, 0.99f, {0}));
    }
}

} // namespace
} // namespace vdb_shell::houdini

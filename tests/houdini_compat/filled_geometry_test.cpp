// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/shell_geometry.h"
#include "vdb_shell/report/report.h"
#include "vdb_shell/write/verify_file.h"

#include "houdini_compat/geometries.h"
#include "houdini_compat/round_trip.h"
#include "support/filled.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

// Tets of a core in Houdini's geometry.

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using test::has;
using test::refusal_of_changed;
using test::values_of;

ShellFile filled(ShellStack stack)
{
    ShellFile file;
    file.stack = std::move(stack);
    file.tets = make_tets(file.stack);
    file.core = test::cone_core(file.stack, file.tets, Vec3s(0.01f, 0.02f, 0.03f));
    return file;
}

ShellFile filled_ball()
{
    return filled(test::hollow_ball());
}

/// Without a tet: the surface's own vertices are the core's.
ShellFile filled_empty_shell()
{
    TriangleMesh mesh = test::icosphere(1.0, 1);
    for (Vec3s& p : mesh.points)
        p += Vec3s(0.01f, 0, 0);
    return filled(test::empty_shell(mesh));
}

ShellFile filled_tapered_ball()
{
    const TriangleMesh mesh = test::icosphere(1.0, 1);
    std::vector<Vec3s> inner = mesh.points;
    for (Vec3s& p : inner)
        p *= 0.5f;
    // Two neighbours share a point.
    inner[mesh.triangles[0][0]] = inner[mesh.triangles[0][1]];
    return filled(test::tapered_stack({mesh.points, inner}, mesh.triangles));
}

void expect_same_core(const ShellFile& found, const ShellFile& file)
{
    EXPECT_TRUE(test::same_values(found.core.points, file.core.points));
    EXPECT_EQ(found.core.source_vertex, file.core.source_vertex);
    EXPECT_EQ(found.core.tets, file.core.tets);
    EXPECT_TRUE(test::same_values(found.rest.core, file.rest.core));
    EXPECT_TRUE(test::same_values(found.rest.velocity.core, file.rest.velocity.core));
}

ShellFile read_back(const ShellFile& file)
{
    return shell_of_geometry(shell_geometry(file), "x.geo");
}

TEST(FilledGeometry, EveryFormGivesTheCoreBackBitForBit)
{
    for (const ShellFile& file : {filled_ball(), filled_empty_shell(), filled_tapered_ball()}) {
        test::expect_round_trips(file);
        expect_same_core(read_back(file), file);
    }
}

TEST(FilledGeometry, APosedCoreKeepsItsRestAndVelocity)
{
    ShellFile file = filled_ball();
    for (std::size_t k = 0; k < file.stack.surfaces(); ++k)
        file.rest.surface.emplace_back(file.stack.surface(k).size(), Vec3s(1, 2, float(k)));
    file.rest.core.assign(file.core.points.size(), Vec3s(3, 4, 5));
    expect_same_core(read_back(file), file);
    file.rest.velocity.surface = file.rest.surface;
    file.rest.velocity.core.assign(file.core.points.size(), Vec3s(6, 7, 8));
    test::expect_round_trips(file);
    expect_same_core(read_back(file), file);
}

TEST(FilledGeometry, WhereAPillarEndedAtACoreComesBackBesideAFilling)
{
    ShellFile file = filled_ball();
    file.core_feet.resize(file.stack.surface(0).size());
    file.core_feet[3] = {0, 7, Vec3s(0.25f, 0.5f, 0.25f), 0.125f};
    const ShellFile found = read_back(file);
    ASSERT_EQ(found.core_feet.size(), file.core_feet.size());
    EXPECT_EQ(found.core_feet[3].triangle, 7);
    EXPECT_EQ(found.core_feet[2].triangle, -1);
    expect_same_core(found, file);
}

/// Three vertices of a surface that was remeshed.
InputPoints some_input()
{
    return {{Vec3s(1, 2, 3), Vec3s(-0.0f, 0, 0), Vec3s(4, 5, 6)},
            {{0, 1, 2}, {2, 5, 7}, {1, 0, 3}},
            {Vec3s(0.25f, 0.5f, 0.25f), Vec3s(1, 0, 0), Vec3s(0, 0.125f, 0.875f)}};
}

TEST(FilledGeometry, TheSurfaceBeforeRemeshingComesBackWithACoreAndWithout)
{
    for (ShellFile file : {filled_ball(), filled_tapered_ball()})
        for (const bool with_core : {true, false}) {
            if (!with_core)
                file.core = {};
            file.input = some_input();
            test::expect_round_trips(file);
            const ShellFile found = read_back(file);
            expect_same_core(found, file);
            EXPECT_TRUE(test::same_values(found.input.points, file.input.points));
            EXPECT_EQ(found.input.corners, file.input.corners);
            EXPECT_TRUE(test::same_values(found.input.weights, file.input.weights));
            const HoudiniGeometry g = shell_geometry(file);
            const auto& members = find(g.point_groups, "input_points")->members;
            EXPECT_EQ(std::count(members.begin(), members.end(), true), 3);
        }
    EXPECT_TRUE(read_back(filled_ball()).input.empty());
}

TEST(FilledGeometry, ACornerThatIsNoVertexIsRefused)
{
    ShellFile file = filled_ball();
    file.input = some_input();
    HoudiniGeometry g = shell_geometry(file);
    auto corners = std::find_if(g.point_attributes.begin(), g.point_attributes.end(),
                                [](const Attribute& a) { return a.name == "input_corners"; });
    std::get<std::vector<std::int32_t>>(corners->values).back() = 42;
    EXPECT_THROW(shell_of_geometry(g, "x.geo"), ReadError);
    file.input.corners[0][0] = 42;
    EXPECT_THROW(shell_geometry(file), InvalidOption);
}

TEST(FilledGeometry, TheTetsFillTheSolidInHoudinisOrientation)
{
    const ShellFile file = filled_ball();
    const HoudiniGeometry g = shell_geometry(file);
    const auto& p = std::get<std::vector<float>>(find(g.point_attributes, "P")->values);
    const auto &shell = find(g.primitive_groups, "shell")->members,
               &core = find(g.primitive_groups, "core_tets")->members,
               &outer = find(g.primitive_groups, "outer")->members;
    std::size_t vertex = 0;
    double tets = 0, solid = 0;
    for (std::size_t i = 0; i < g.primitives.size(); ++i) {
        const auto corner = [&](std::size_t k) {
            const std::size_t at = 3 * std::size_t(g.vertex_point[vertex + k]);
            return Vec3d(p[at], p[at + 1], p[at + 2]);
        };
        if (shell[i] || core[i]) {
            ASSERT_EQ(g.primitives[i].type, PrimitiveType::tetrahedron);
            const double det =
                (corner(1) - corner(0)).dot((corner(2) - corner(0)).cross(corner(3) - corner(0)));
            EXPECT_LT(det, 0.0);
            tets -= det / 6;
        } else if (outer[i])
            solid -= corner(0).dot(corner(1).cross(corner(2))) / 6;
        vertex += g.primitives[i].vertices;
    }
    EXPECT_EQ(std::count(core.begin(), core.end(), true), std::ptrdiff_t(file.core.tets.size()));
    EXPECT_NEAR(tets, solid, 1e-6);
}

TEST(FilledGeometry, CheckProvesTheCoreAnew)
{
    const auto holds = [](const ShellFile& file) {
        const std::vector<Verification> entries = verify_shell(file);
        return std::all_of(entries.begin(), entries.end(), [](const auto& e) { return e.holds; });
    };
    ShellFile file = filled_ball();
    ShellReport report;
    report.signs = count_tet_signs(file.tets);
    report.shell_volume = tet_volume(file.tets);
    report.certificate = certify_stack(file.stack, PrismTest::twelve_tets);
    report.core_fill.emplace();
    report.core_fill->tets = file.core.tets.size();
    TetMesh alone = joined_tets(file.tets, file.core);
    alone.tets = file.core.tets;
    report.core_fill->volume = tet_volume(alone);
    file.report_json = report_json(report);
    EXPECT_TRUE(holds(read_back(file)));
    file.core.tets.pop_back();
    EXPECT_FALSE(holds(read_back(file)));
}

template <typename Change> std::string refusal_of_filled(const Change& change)
{
    return refusal_of_changed(filled_ball(), change);
}

TEST(FilledGeometry, SaysWhatOfTheCoreContradicts)
{
    has(refusal_of_filled([](auto& g) {
            values_of<std::int32_t>(g.detail_attributes, "vdb_shell_core_tets")[0] = 1 << 20;
        }),
        "\"vdb_shell_core_tets\" is 1048576");
    has(refusal_of_filled([](auto& g) {
            values_of<std::int32_t>(g.detail_attributes, "vdb_shell_core_tets")[0] += 1;
        }),
        "is no tetrahedron of the core");
    has(refusal_of_filled([](auto& g) {
            values_of<std::int32_t>(g.detail_attributes, "vdb_shell_core_tets")[0] -= 1;
        }),
        "is a point behind the shell's");
    has(refusal_of_filled([](auto& g) {
            values_of<std::int32_t>(g.point_attributes, "source_vertex").back() = -2;
        }),
        "\"source_vertex\" of a point of the core is -2");
    has(refusal_of_filled([](auto& g) { g.vertex_point[0] = std::uint32_t(g.points - 1); }),
        "is a point behind the shell's");
    has(refusal_of_filled(
            [](auto& g) { std::swap(g.vertex_point.back(), *(g.vertex_point.end() - 2)); }),
        "checksum");
    // Pinned vertices are of no tet: the triangle between them is the core's own.
    HoudiniGeometry g = shell_geometry(filled_empty_shell());
    g.vertex_point.back() = 0;
    EXPECT_THROW(shell_of_geometry(g, "x.geo"), ReadError);
}

TEST(FilledGeometry, ACoreThatDoesNotFitIsNotWritten)
{
    ShellFile file = filled_ball();
    file.core.tets[0][0] = std::uint32_t(file.tets.points.size() + file.core.points.size());
    EXPECT_THROW(shell_geometry(file), InvalidOption);
}

} // namespace
} // namespace vdb_shell::houdini

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/remesh.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"

#include "resample/sound.h"
#include "support/cancelled.h"
#include "support/shapes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>

namespace vdb_shell::test
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

constexpr double kDegree = 3.141592653589793 / 180;

RemeshOptions to_length(double length)
{
    RemeshOptions options;
    options.edge_length = length;
    return options;
}

void expect_within_tolerance(const RemeshResult& result, const TriangleMesh& input)
{
    const double tolerance = result.report.tolerance;
    EXPECT_FALSE(result.report.kept_input);
    EXPECT_LE(result.report.input_to_result.max, tolerance);
    EXPECT_LE(result.report.result_to_input.max, tolerance);
    // At other points than those that were looked at.
    const double spacing = std::max(0.3 * tolerance, 0.01);
    EXPECT_LE(surface_distance(input, result.mesh, spacing).max, 1.05 * tolerance);
    EXPECT_LE(surface_distance(result.mesh, input, spacing).max, 1.05 * tolerance);
}

Vec3d place_on(const TriangleMesh& mesh, const SurfacePoint& at)
{
    Vec3d p(0.0);
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(at.corners[k], mesh.triangles[at.triangle][k]);
        EXPECT_GE(at.weights[std::size_t(k)], 0);
        p += Vec3d(mesh.points[at.corners[k]]) * at.weights[std::size_t(k)];
        sum += at.weights[std::size_t(k)];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    return p;
}

TEST(Remesh, OfASphereIsNearlyEquilateralAndOfOneSize)
{
    const TriangleMesh sphere = icosphere(1.0, 4); // 5120 triangles, edges about 0.07
    for (const double length : {0.25, 0.1}) {
        const RemeshResult result = remesh(sphere, to_length(length));
        expect_sound(result.mesh);
        expect_within_tolerance(result, sphere);
        EXPECT_GT(result.report.shape.min_angle_radians, 30 * kDegree);
        EXPECT_GT(result.report.shape.mean_min_angle_radians, 50 * kDegree);
        EXPECT_GT(result.report.edges_in_range, 0.97);
        EXPECT_NEAR(result.report.shape.mean_edge, length, 0.1 * length);
        // Triangles with their corners on the sphere lie l^2 / 6 below it in their middles, and
        // that is also about how much of the radius the volume loses.
        const double volume = signed_volume(result.mesh.points, result.mesh.triangles);
        EXPECT_NEAR(volume, 4.0 / 3.0 * 3.14159265, 4 * 3.14159265 * length * length / 4 + 0.01);
        for (const Vec3s& p : result.mesh.points)
            EXPECT_NEAR(p.length(), 1, 0.0012); // the sagitta of the input
    }
}

/// Edges at which the surface turns by more than 60 degrees.
std::vector<std::array<Vec3s, 2>> sharp_edges(const TriangleMesh& mesh)
{
    std::map<std::array<std::uint32_t, 2>, Vec3d> normal;
    std::vector<std::array<Vec3s, 2>> sharp;
    for (const Vec3I& t : mesh.triangles) {
        Vec3d n = (Vec3d(mesh.points[t[1]]) - Vec3d(mesh.points[t[0]]))
                      .cross(Vec3d(mesh.points[t[2]]) - Vec3d(mesh.points[t[0]]));
        n.normalize();
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            const auto [seen, first] = normal.insert({{std::min(a, b), std::max(a, b)}, n});
            if (!first && seen->second.dot(n) < 0.5)
                sharp.push_back({mesh.points[a], mesh.points[b]});
        }
    }
    return sharp;
}

TEST(Remesh, KeepsTheEdgesAndCornersOfACubeExactly)
{
    for (const TriangleMesh& cube :
         {box({0, 0, 0}, {1, 1, 1}), gridded_box({0, 0, 0}, {1, 1, 1}, 7)}) {
        const RemeshResult result = remesh(cube, to_length(0.15));
        expect_sound(result.mesh);
        expect_within_tolerance(result, cube);
        EXPECT_EQ(result.report.corners, 8U);
        EXPECT_EQ(result.report.feature_curves, 12U);
        EXPECT_GT(result.report.shape.min_angle_radians, 30 * kDegree);
        const auto on_side = [](float x) { return x == 0.0F || x == 1.0F; };
        std::size_t corners = 0;
        for (const Vec3s& p : result.mesh.points) {
            EXPECT_TRUE(on_side(p[0]) || on_side(p[1]) || on_side(p[2])) << p;
            corners += on_side(p[0]) && on_side(p[1]) && on_side(p[2]);
        }
        EXPECT_EQ(corners, 8U);
        // All that is sharp lies on the cube's edges, and covers them.
        double length = 0;
        for (const auto& [a, b] : sharp_edges(result.mesh)) {
            int shared = 0;
            for (int k = 0; k < 3; ++k)
                shared += on_side(a[k]) && a[k] == b[k];
            EXPECT_EQ(shared, 2) << a << b;
            length += (b - a).length();
        }
        EXPECT_NEAR(length, 12, 1e-4);
        EXPECT_NEAR(signed_volume(result.mesh.points, result.mesh.triangles), 1, 1e-6);
    }
}

TEST(Remesh, KeepsTheGenusOfATorusAndTheNumberOfComponents)
{
    const TriangleMesh tori = joined(torus(1.0, 0.3, 48, 16), torus(5.0, 0.4, 96, 12));
    const RemeshResult result = remesh(tori, to_length(0.2));
    const MeshCheck check = expect_sound(result.mesh);
    expect_within_tolerance(result, tori);
    ASSERT_EQ(check.components.size(), 2U);
    EXPECT_EQ(check.components[0].euler, 0);
    EXPECT_EQ(check.components[1].euler, 0);
    EXPECT_GT(result.report.shape.min_angle_radians, 25 * kDegree);
}

TEST(Remesh, KeepsTheRimsOfACylinderAsCircles)
{
    // A polygon of 40 sides, as closed curves without a corner.
    std::vector<openvdb::Vec2d> circle;
    for (int i = 0; i < 40; ++i)
        circle.emplace_back(std::cos(i * 9 * kDegree), std::sin(i * 9 * kDegree));
    const TriangleMesh cylinder = extruded(circle, {0, 1, 2});
    const RemeshResult result = remesh(cylinder, to_length(0.3));
    expect_sound(result.mesh);
    expect_within_tolerance(result, cylinder);
    EXPECT_EQ(result.report.corners, 0U);
    EXPECT_EQ(result.report.feature_curves, 2U);
    double length = 0;
    for (const auto& [a, b] : sharp_edges(result.mesh)) {
        EXPECT_TRUE((a[2] == 0 && b[2] == 0) || (a[2] == 2 && b[2] == 2)) << a << b;
        length += (b - a).length();
    }
    EXPECT_NEAR(length, 4 * 3.14159265, 0.1);
}

TEST(Remesh, GoesByTheToleranceBeforeTheLength)
{
    const TriangleMesh shape = torus(1.0, 0.3, 64, 32);
    std::size_t last = std::numeric_limits<std::size_t>::max();
    for (const double tolerance : {0.004, 0.02, 0.1}) {
        RemeshOptions options = to_length(0.5);
        options.tolerance = tolerance;
        const RemeshResult result = remesh(shape, options);
        EXPECT_EQ(expect_sound(result.mesh).components[0].euler, 0);
        expect_within_tolerance(result, shape);
        EXPECT_LT(result.mesh.triangles.size(), last); // more tolerance, fewer triangles
        last = result.mesh.triangles.size();
    }
}

TEST(Remesh, MapsReproduceThePointsWithinTheTolerance)
{
    const TriangleMesh shape = torus(1.0, 0.4, 40, 20);
    const RemeshResult result = remesh(shape, to_length(0.18));
    ASSERT_EQ(result.map.input_on_result.size(), shape.points.size());
    ASSERT_EQ(result.map.result_on_input.size(), result.mesh.points.size());
    for (std::size_t v = 0; v < shape.points.size(); ++v)
        EXPECT_LE((place_on(result.mesh, result.map.input_on_result[v]) - Vec3d(shape.points[v]))
                      .length(),
                  result.report.tolerance);
    for (std::size_t v = 0; v < result.mesh.points.size(); ++v)
        EXPECT_LE((place_on(shape, result.map.result_on_input[v]) - Vec3d(result.mesh.points[v]))
                      .length(),
                  1e-5);
}

TEST(Remesh, MapsAThinPlateSideBySide)
{
    // Thinner than the tolerance: the nearest triangle may be on the other side, but the map is
    // not.
    const TriangleMesh plate = gridded_box({0, 0, 0}, {1, 1, 0.02}, 12);
    const RemeshResult result = remesh(plate, to_length(0.15));
    EXPECT_GT(result.report.tolerance, 0.02);
    expect_sound(result.mesh);
    for (std::size_t v = 0; v < plate.points.size(); ++v) {
        const Vec3s& p = plate.points[v];
        if (p[0] < 0.01 || p[0] > 0.99 || p[1] < 0.01 || p[1] > 0.99)
            continue;
        EXPECT_NEAR(place_on(result.mesh, result.map.input_on_result[v])[2], p[2], 1e-6) << p;
    }
}

TEST(Remesh, ComesNearTheNumberThatIsWanted)
{
    const TriangleMesh shape = torus(1.0, 0.4, 48, 24);
    for (const std::size_t wanted : {600U, 5000U}) {
        RemeshOptions options;
        options.triangles = wanted;
        const RemeshResult result = remesh(shape, options);
        expect_sound(result.mesh);
        EXPECT_NEAR(double(result.mesh.triangles.size()), double(wanted), 0.08 * double(wanted));
        EXPECT_EQ(result.report.wanted, wanted);
    }
}

TEST(Remesh, SameBytesForAnyNumberOfThreads)
{
    const TriangleMesh shape = gridded_box({0, 0, 0}, {1, 2, 0.7}, 9);
    const RemeshResult many = remesh(shape, to_length(0.2));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const RemeshResult single = remesh(shape, to_length(0.2));
    EXPECT_EQ(many.mesh.points, single.mesh.points);
    EXPECT_EQ(many.mesh.triangles, single.mesh.triangles);
    for (std::size_t v = 0; v < shape.points.size(); ++v) {
        EXPECT_EQ(many.map.input_on_result[v].triangle, single.map.input_on_result[v].triangle);
        EXPECT_EQ(many.map.input_on_result[v].weights, single.map.input_on_result[v].weights);
    }
}

TEST(Remesh, KeepsADentThatAnotherBodyReachesInto)
{
    // The dent is shallower than the tolerance: but for the thorn in it, it would be filled.
    TriangleMesh dented = gridded_box({0, 0, -1}, {1, 1, 0}, 8);
    for (Vec3s& p : dented.points)
        if (p[2] == 0 && (p - Vec3s(0.5F, 0.5F, 0)).length() < 0.01F)
            p[2] = -0.1F;
    TriangleMesh thorn = unit_tetrahedron(); // its corner at 0, turned over, is the point
    for (Vec3s& p : thorn.points)
        p = Vec3s(0.5F, 0.5F, -0.05F) + Vec3s(0.02F * p[0], 0.02F * p[1], 0) +
            Vec3s(0, 0, p == Vec3s(0.0F) ? 0 : 1.0F);
    const auto remeshed = [](const TriangleMesh& mesh) {
        RemeshOptions options = to_length(0.5);
        options.tolerance = 0.3;
        return remesh(mesh, options).mesh;
    };
    const auto has_dent = [](const TriangleMesh& mesh) {
        return std::any_of(mesh.points.begin(), mesh.points.end(), [](const Vec3s& p) {
            return p[2] < -0.05F && p[2] > -0.5F && std::abs(p[0] - 0.5F) < 0.2F &&
                   std::abs(p[1] - 0.5F) < 0.2F;
        });
    };
    EXPECT_FALSE(has_dent(remeshed(dented)));
    const TriangleMesh both = remeshed(joined(dented, thorn));
    expect_sound(both);
    EXPECT_TRUE(has_dent(both));
}

TEST(Remesh, MakesGoodTrianglesOfAPlateOfNeedles)
{
    const TriangleMesh plate = needled_plate(100);
    ASSERT_GT(triangle_figures(plate).under_20_degrees, plate.triangles.size() / 2);
    RemeshOptions options;
    options.triangles = 2000;
    const RemeshResult result = remesh(plate, options);
    expect_sound(result.mesh);
    expect_within_tolerance(result, plate);
    EXPECT_NEAR(double(result.mesh.triangles.size()), 2000, 200);
    EXPECT_LT(result.report.shape.under_20_degrees, 20);
    EXPECT_GT(result.report.shape.mean_min_angle_radians, 45 * kDegree);
}

TEST(Remesh, CutsWhereTheSurfacesAreTooFarApartInsteadOfStartingAnew)
{
    // Narrow hills, so that between the points at which operations look a few places are too far
    // from the other surface.
    TriangleMesh hills = icosphere(1.0, 4);
    for (Vec3s& p : hills.points) {
        const Vec3d at = 9.0 * Vec3d(p);
        p *= float(1 + 0.3 * std::sin(at[0]) * std::sin(at[1]) * std::sin(at[2] + 1));
    }
    RemeshOptions options;
    options.triangles = 800;
    const RemeshResult result = remesh(hills, options);
    expect_sound(result.mesh);
    expect_within_tolerance(result, hills);
    EXPECT_EQ(result.report.repeats, 0);
}

TEST(Remesh, AToleranceThatNothingCanKeepGivesTheInput)
{
    const TriangleMesh shape = icosphere(1.0, 1);
    RemeshOptions options = to_length(0.3);
    options.tolerance = 1e-9; // under the rounding of the points
    const RemeshResult result = remesh(shape, options);
    EXPECT_LE(result.report.input_to_result.max, 1e-9);
    EXPECT_LE(result.report.result_to_input.max, 1e-9);
    for (std::size_t v = 0; v < shape.points.size(); ++v)
        EXPECT_LE((place_on(result.mesh, result.map.input_on_result[v]) - Vec3d(shape.points[v]))
                      .length(),
                  1e-9);
}

std::string refusal(const std::function<void()>& job)
{
    try {
        job();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(Remesh, RefusesOptionsByName)
{
    const TriangleMesh sphere = icosphere(1.0, 1);
    const auto said = [&](const RemeshOptions& options, const std::string& text) {
        const std::string message = refusal([&] { remesh(sphere, options); });
        EXPECT_NE(message.find(text), std::string::npos) << message;
    };
    said({}, "neither edge_length nor triangles");
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        said(to_length(bad), "edge_length is");
    RemeshOptions options;
    options.triangles = 3;
    said(options, "triangles is 3");
    // Known beforehand; to make them would take all memory.
    options.triangles = 4294967295U;
    said(options, "triangles is 4294967295");
    said(to_length(1e-6), "2^30");
    options.edge_length = 0.1;
    options.triangles = 100;
    said(options, "both given");
    options = to_length(0.1);
    options.tolerance = 0;
    said(options, "tolerance is 0");
    options = to_length(0.1);
    options.feature_angle_radians = 3.2;
    said(options, "feature_angle_radians is 3.2");
}

TEST(Remesh, RefusesSurfacesThatAreOpenOrCross)
{
    const TriangleMesh sphere = icosphere(1.0, 1);
    const auto message = [](const TriangleMesh& mesh) {
        return refusal([&] { remesh(mesh, to_length(0.2)); });
    };
    EXPECT_NE(message(without_triangle(sphere, 5)).find("remesh: "), std::string::npos);
    EXPECT_NE(message(without_triangle(sphere, 5)).find("3 boundary edges"), std::string::npos);
    EXPECT_NE(message(joined(sphere, translated(sphere, {0.5, 0.1, 0}))).find("cross or touch"),
              std::string::npos);
    EXPECT_NE(message({}).find("no triangles"), std::string::npos);
}

TEST(Remesh, CanBeCancelled)
{
    const TriangleMesh sphere = icosphere(1.0, 2);
    expect_cancelled(
        [&](Interrupter* interrupter) { remesh(sphere, to_length(0.3), interrupter); });
}

} // namespace
} // namespace vdb_shell::test

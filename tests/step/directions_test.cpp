// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/step/directions.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/field/level_set.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

openvdb::FloatGrid::Ptr field_of(const TriangleMesh& mesh, int resolution = 32)
{
    LevelSetOptions options;
    options.resolution = resolution;
    return mesh_to_level_set(mesh, options);
}

TEST(PseudoNormals, DoNotDependOnHowACubesFacesAreCut)
{
    // Each corner has three right angles, whichever way the diagonals run.
    const TriangleMesh mesh = test::box(Vec3d(-1.0), Vec3d(1.0));
    const auto normals = pseudo_normals(mesh);
    for (std::size_t v = 0; v < normals.size(); ++v)
        EXPECT_LT((normals[v] - Vec3d(mesh.points[v]).unit()).length(), 1e-12);
    for (const double visibility : visibility_of(mesh, normals))
        EXPECT_NEAR(visibility, 1 / std::sqrt(3.0), 1e-12);
}

TEST(PseudoNormals, AreZeroWhereTrianglesCancelOrThereAreNone)
{
    TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}}, {{0, 1, 2}, {0, 2, 1}}};
    for (const Vec3d& n : pseudo_normals(sheet))
        EXPECT_EQ(n, Vec3d(0.0));
    const Directions directions = compute_directions(sheet, *openvdb::FloatGrid::create(), {});
    for (const double visibility : directions.visibility)
        EXPECT_LE(visibility, 0);
}

TEST(PseudoNormals, IgnoreTrianglesWithoutArea)
{
    TriangleMesh mesh = test::unit_tetrahedron();
    const auto before = pseudo_normals(mesh);
    mesh.triangles.emplace_back(0, 0, 1);
    const auto after = pseudo_normals(mesh);
    for (std::size_t v = 0; v < before.size(); ++v)
        EXPECT_NEAR((after[v] - before[v]).length(), 0, 1e-15);
}

TEST(Visibility, IsNegativeBehindAFace)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    const std::vector<Vec3d> outward(4, Vec3d(0, 0, 1));
    // Vertex 3 touches x = 0, y = 0 and the slanted face; vertex 0 also the floor, seen from
    // behind.
    const auto visibility = visibility_of(mesh, outward);
    EXPECT_NEAR(visibility[0], -1, 1e-15);
    EXPECT_NEAR(visibility[3], 0, 1e-15);
}

TEST(Directions, PointInwardFromBothSources)
{
    const TriangleMesh mesh = test::icosphere(1, 3);
    const auto field = field_of(mesh);
    for (const auto source : {DirectionSource::pseudo_normal, DirectionSource::gradient}) {
        DirectionOptions options;
        options.source = source;
        const Directions directions = compute_directions(mesh, *field, options);
        for (std::size_t v = 0; v < mesh.points.size(); ++v) {
            EXPECT_NEAR(directions.inward[v].length(), 1, 1e-12);
            EXPECT_GT(directions.inward[v].dot(-Vec3d(mesh.points[v]).unit()), std::cos(0.05));
            EXPECT_GT(directions.visibility[v], 0.9);
        }
    }
}

TEST(Directions, GradientOutsideTheBandIsNoDirection)
{
    const TriangleMesh mesh = test::icosphere(1, 2);
    const auto field = field_of(mesh);
    DirectionOptions options;
    options.source = DirectionSource::gradient;
    const auto moved = test::translated(mesh, Vec3d(10, 0, 0));
    for (const Vec3d& d : compute_directions(moved, *field, options).inward)
        EXPECT_EQ(d, Vec3d(0.0));
}

TEST(Directions, PerturbationStaysInItsConeAndSpreadsOverIt)
{
    const TriangleMesh mesh = test::icosphere(1, 4);
    const auto field = field_of(mesh, 16);
    DirectionOptions options;
    const auto straight = compute_directions(mesh, *field, options);
    options.perturbation_radians = 0.2;
    const auto tilted = compute_directions(mesh, *field, options);
    int beyond_half = 0;
    Vec3d mean(0.0);
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
        EXPECT_NEAR(tilted.inward[v].length(), 1, 1e-12);
        const double angle = std::acos(std::min(1.0, straight.inward[v].dot(tilted.inward[v])));
        EXPECT_LE(angle, 0.2 + 1e-7);
        beyond_half += angle > 0.1;
        mean += tilted.inward[v] - straight.inward[v];
    }
    // Uniform over the disk: three quarters lie beyond half its radius.
    const double count = static_cast<double>(mesh.points.size());
    EXPECT_NEAR(beyond_half / count, 0.75, 0.05);
    EXPECT_LT(mean.length() / count, 0.02);
}

TEST(Directions, SameSeedSameDirectionsForAnyNumberOfThreads)
{
    const TriangleMesh mesh = test::torus(1, 0.4, 30, 20);
    const auto field = field_of(mesh);
    DirectionOptions options;
    options.source = DirectionSource::gradient;
    options.perturbation_radians = 0.1;
    const auto made_by = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return compute_directions(mesh, *field, options);
    };
    const Directions one = made_by(1);
    for (const std::size_t threads : {2, 7}) {
        EXPECT_EQ(one.inward, made_by(threads).inward);
        EXPECT_EQ(one.visibility, made_by(threads).visibility);
    }
    options.seed = 2;
    EXPECT_NE(one.inward, made_by(1).inward);
}

TEST(Directions, RefuseATiltOutOfRange)
{
    const TriangleMesh mesh = test::unit_tetrahedron();
    for (const double angle : {-0.1, 1.6, std::nan("")}) {
        DirectionOptions options;
        options.perturbation_radians = angle;
        EXPECT_THROW(compute_directions(mesh, *openvdb::FloatGrid::create(), options),
                     InvalidOption);
    }
}

} // namespace
} // namespace vdb_shell

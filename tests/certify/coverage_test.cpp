// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/coverage.h"

#include "support/shapes.h"
#include "support/shells.h"
#include "support/stacks.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/shell/tessellate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <tuple>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

TetMesh default_tets(const PrismShell& shell)
{
    return make_tets(shell, split_prisms(shell, {}));
}

double volume_of(const TriangleMesh& mesh)
{
    return signed_volume(mesh.points, mesh.triangles);
}

auto counts(const Coverage& c)
{
    return std::make_tuple(c.samples, c.in_none, c.in_one, c.in_several, c.outside_covered);
}

TEST(Coverage, AgreesWithTheExactVolumeOfASphereShell)
{
    const TriangleMesh sphere = test::icosphere(2, 3);
    const PrismShell shell = test::radial_shell(sphere, [](std::size_t) { return 0.6; });
    const TetMesh tets = default_tets(shell);
    const double exact = tet_volume(tets) / volume_of(sphere);
    EXPECT_NEAR(exact, 1 - std::pow(0.7, 3), 1e-6); // similar polyhedra
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Coverage c = estimate_coverage(sphere, tets, {100000, seed});
        EXPECT_EQ(c.samples, 100000U);
        EXPECT_EQ(c.in_none + c.in_one + c.in_several, c.samples);
        EXPECT_EQ(c.in_several, 0U);
        EXPECT_EQ(c.outside_covered, 0U);
        EXPECT_NEAR(c.standard_error, std::sqrt(exact * (1 - exact) / 1e5), 1e-5);
        EXPECT_NEAR(c.covered_share, exact, 4 * c.standard_error) << "seed " << seed;
    }
}

double common_volume(const Bounds& a, const Bounds& b)
{
    double volume = 1;
    for (int axis = 0; axis < 3; ++axis)
        volume *= std::max(0.0, std::min(a.high[axis], b.high[axis]) -
                                    std::max(a.low[axis], b.low[axis]));
    return volume;
}

Bounds shrunk(const Bounds& box, double by)
{
    return {box.low + Vec3d(by), box.high - Vec3d(by)};
}

PrismShell box_shell(const TriangleMesh& mesh, const std::vector<Bounds>& boxes, double thickness)
{
    return test::shell_along(
        mesh,
        [&](const Vec3d& p) {
            for (const Bounds& box : boxes) {
                const Vec3d from_centre = p - 0.5 * (box.low + box.high);
                const Vec3d half = 0.5 * (box.high - box.low);
                bool corner = true;
                for (int axis = 0; axis < 3; ++axis)
                    corner = corner && std::abs(from_centre[axis]) == half[axis];
                if (corner)
                    return -Vec3d(std::copysign(1, from_centre[0]),
                                  std::copysign(1, from_centre[1]),
                                  std::copysign(1, from_centre[2]))
                                .unit();
            }
            return Vec3d(0.0);
        },
        [=](std::size_t) { return std::sqrt(3.0) * thickness; });
}

TEST(Coverage, FindsTheKnownOverlapOfTwoLimbs)
{
    // Two boxes that cross, and their shells of equal thickness: everything is a sum of boxes.
    const Bounds a{Vec3d(0, 0, 0), Vec3d(4, 1, 1)}, b{Vec3d(2.5, -2, 0.25), Vec3d(3.5, 3, 1.5)};
    const double h = 0.25;
    const TriangleMesh mesh = test::joined(test::box(a.low, a.high), test::box(b.low, b.high));
    const TetMesh tets = default_tets(box_shell(mesh, {a, b}, h));
    const Bounds ai = shrunk(a, h), bi = shrunk(b, h);
    const double solid = volume_of(mesh) - common_volume(a, b);
    const double overlap =
        common_volume(a, b) - common_volume(ai, b) - common_volume(a, bi) + common_volume(ai, bi);
    const double covered = tet_volume(tets) - overlap;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Coverage c = estimate_coverage(mesh, tets, {200000, seed});
        EXPECT_NEAR(c.covered_share, covered / solid, 4 * c.standard_error);
        EXPECT_NEAR(c.overlap_share, overlap / solid, 4 * c.overlap_standard_error);
        EXPECT_GT(c.overlap_share, 0.02);
        EXPECT_EQ(c.outside_covered, 0U);
    }
}

TEST(Coverage, MeasuresAShellOutsideTheSolid)
{
    // Extruded outward: every tet inverted, all of it outside.
    const TriangleMesh sphere = test::icosphere(1, 2);
    const PrismShell shell = test::shell_along(
        sphere, [](const Vec3d& p) { return p.unit(); }, [](std::size_t) { return 0.5; });
    const TetMesh tets = default_tets(shell);
    const double exact = -tet_volume(tets) / volume_of(sphere);
    EXPECT_NEAR(exact, std::pow(1.5, 3) - 1, 1e-6);
    const Coverage c = estimate_coverage(sphere, tets, {100000, 5});
    EXPECT_EQ(c.in_none, c.samples);
    EXPECT_EQ(c.covered_share, 0);
    // Ratio of two counts of the same draws: relative variance 1/out + 1/in.
    EXPECT_NEAR(c.outside_share, exact, 4 * std::sqrt(exact * (1 + exact) / 1e5));
}

TEST(Coverage, DoesNotCountACavityAsSolid)
{
    // A shell that is thicker than the wall: what lies in the cavity is outside.
    const TriangleMesh outer = test::icosphere(2, 2), hollow = test::icosphere(1, 2);
    const TriangleMesh wall = test::joined(outer, test::reversed(hollow));
    const PrismShell shell = test::radial_shell(outer, [](std::size_t) { return 1.5; });
    const Coverage c = estimate_coverage(wall, default_tets(shell), {50000, 2});
    EXPECT_EQ(c.in_one + c.in_none, c.samples);
    EXPECT_LE(c.in_none, 5U);             // points exactly on a face
    const double exact = (1 - 0.125) / 7; // radii 2, 1 and 0.5 of similar polyhedra
    EXPECT_NEAR(c.outside_share, exact, 4 * std::sqrt(exact * (1 + exact) / 5e4));
}

TEST(Coverage, HandlesASolidThatFillsLittleOfItsBox)
{
    // A plate along no axis, so that most cells near it are mostly outside.
    TriangleMesh plate = test::box({-1, -1, -0.01}, {1, 1, 0.01});
    const Vec3d u = Vec3d(1, 1, 1).unit(), v = Vec3d(1, -1, 0).unit(), w = u.cross(v);
    for (openvdb::Vec3s& p : plate.points)
        p = openvdb::Vec3s(double(p[0]) * v + double(p[1]) * w + double(p[2]) * u);
    const PrismShell shell = test::shell_along(
        plate, [&](const Vec3d& p) { return p.dot(u) > 0 ? -u : u; },
        [](std::size_t) { return 0.005; });
    // Neither shell of the two sides reaches the middle; the prisms of the rim are flat.
    const TetMesh tets = default_tets(shell);
    const Coverage c = estimate_coverage(plate, tets, {50000, 3});
    EXPECT_EQ(c.samples, 50000U);
    EXPECT_NEAR(c.covered_share, 0.5, 4 * c.standard_error + 1e-5);
}

TEST(Coverage, IsTheSameForAnyNumberOfThreads)
{
    const TriangleMesh torus = test::torus(3, 1, 30, 15);
    const TetMesh tets = default_tets(
        test::torus_shell(torus, 3, [](std::size_t v) { return v % 7 == 0 ? 1.6 : 0.5; }));
    std::vector<Coverage> results;
    for (const std::size_t threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        results.push_back(estimate_coverage(torus, tets, {30000, 9}));
    }
    EXPECT_GT(results[0].in_several, 0U);
    EXPECT_EQ(counts(results[0]), counts(results[1]));
    EXPECT_EQ(counts(results[0]), counts(results[2]));
    EXPECT_NE(counts(results[0]), counts(estimate_coverage(torus, tets, {30000, 10})));
}

/// The unit cube in cubes of edge 1 / `parts`, each cut into the six tets between its corners whose
/// coordinates are ordered alike (Kuhn).
TetMesh tets_of_cube(int parts)
{
    TetMesh mesh;
    const auto corner = [parts](const openvdb::Coord& at) {
        return std::uint32_t((at[0] * (parts + 1) + at[1]) * (parts + 1) + at[2]);
    };
    openvdb::CoordBBox corners(openvdb::Coord(0), openvdb::Coord(parts));
    for (const openvdb::Coord& at : corners)
        mesh.points.emplace_back(at.asVec3d() / parts);
    openvdb::CoordBBox cubes(openvdb::Coord(0), openvdb::Coord(parts - 1));
    for (const openvdb::Coord& cube : cubes) {
        std::array<int, 3> axes{0, 1, 2};
        do {
            openvdb::Coord at = cube;
            openvdb::Vec4I tet(corner(at), 0, 0, 0);
            for (int i = 0; i < 3; ++i) {
                ++at[axes[std::size_t(i)]];
                tet[i + 1] = corner(at);
            }
            mesh.tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
    }
    return mesh;
}

TEST(Coverage, FewLargeTetsAndManySmallOnesHoldEachPointOfTheSolidOnce)
{
    const TriangleMesh cube = test::box({0, 0, 0}, {1, 1, 1});
    for (const int parts : {1, 3, 16}) {
        const TetMesh tets = tets_of_cube(parts);
        EXPECT_EQ(tets.tets.size(), std::size_t(6 * parts * parts * parts));
        // A point on a common face, one of some hundred thousand, would be in none: here none is.
        const Coverage c = estimate_coverage(cube, tets, {20000, 3});
        EXPECT_EQ(c.in_none, 0U) << parts;
        EXPECT_EQ(c.in_one, c.samples) << parts;
    }
}

TEST(Coverage, DoesNotDependOnHowATetIsTurned)
{
    const TriangleMesh sphere = test::icosphere(1, 2);
    TetMesh tets = default_tets(test::radial_shell(sphere, [](std::size_t) { return 0.3; }));
    const Coverage before = estimate_coverage(sphere, tets, {20000, 4});
    for (openvdb::Vec4I& tet : tets.tets)
        std::swap(tet[1], tet[2]);
    EXPECT_EQ(counts(before), counts(estimate_coverage(sphere, tets, {20000, 4})));
}

TEST(Coverage, OfNoTetsIsNothingAndOfNoSamplesIsEmpty)
{
    const TriangleMesh box = test::box({0, 0, 0}, {1, 2, 3});
    const Coverage none = estimate_coverage(box, TetMesh(), {1000, 1});
    EXPECT_EQ(none.samples, 1000U);
    EXPECT_EQ(none.in_none, 1000U);
    EXPECT_EQ(estimate_coverage(box, TetMesh(), {0, 1}).samples, 0U);
}

TEST(Coverage, RefusesASolidWithoutVolume)
{
    const TriangleMesh inward = test::reversed(test::box({0, 0, 0}, {1, 2, 3}));
    try {
        estimate_coverage(inward, TetMesh(), {1000, 1});
        FAIL() << "an inward surface was accepted";
    } catch (const GeometryError& error) {
        EXPECT_NE(std::string(error.what()).find("-6"), std::string::npos) << error.what();
    }
}

TEST(Coverage, CanBeCancelled)
{
    test::StopAtOnce interrupter;
    EXPECT_THROW(
        estimate_coverage(test::box({0, 0, 0}, {1, 1, 1}), TetMesh(), {1000, 1}, &interrupter),
        Cancelled);
}

} // namespace

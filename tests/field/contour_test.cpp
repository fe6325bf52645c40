// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/field/contour.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/field/level_set.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/resample/surface_distance.h"

#include "core/grid_instances.h"
#include "field/marching_tets.h"
#include "resample/simplify.h"
#include "support/cancelled.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vdb_shell::test
{
namespace
{

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Vec3d;

void expect_sound(const TriangleMesh& mesh)
{
    const MeshCheck check = check_mesh(mesh);
    EXPECT_EQ(check.boundary_edges.count, 0U);
    EXPECT_EQ(check.non_manifold_edges.count, 0U);
    EXPECT_EQ(check.non_manifold_vertices.count, 0U);
    EXPECT_EQ(check.inconsistent_edges.count, 0U);
    EXPECT_EQ(check.degenerate_triangles.count, 0U);
    EXPECT_EQ(check.duplicate_triangles.count, 0U);
    EXPECT_EQ(check.self_intersections.count, 0U);
    EXPECT_EQ(check.inside_out_components(), 0U);
}

/// A cube of n^3 voxels by a formula on the voxel, within a rim that is outside.
template <typename Value> FloatGrid::Ptr cube_field(int n, const Value& value)
{
    auto grid = FloatGrid::create(1.0f);
    auto values = grid->getAccessor();
    for (int i = -1; i <= n; ++i)
        for (int j = -1; j <= n; ++j)
            for (int k = -1; k <= n; ++k) {
                const bool rim = std::min({i, j, k}) < 0 || std::max({i, j, k}) == n;
                values.setValue({i, j, k}, rim ? 0.5f : value(Coord(i, j, k)));
            }
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

/// Any of 2^1000 patterns of signs, with values of 1 inside and `outside` outside.
FloatGrid::Ptr random_signs(std::uint32_t seed, float outside)
{
    std::mt19937 random(seed);
    return cube_field(10, [&](const Coord&) { return random() % 2 ? outside : -1.0f; });
}

TriangleMesh tets_of(const FloatGrid& field)
{
    const IndexSurface surface = marching_tets(field);
    TriangleMesh mesh;
    for (const Vec3d& p : surface.points)
        mesh.points.emplace_back(p);
    mesh.triangles = surface.triangles;
    return mesh;
}

FloatGrid::Ptr sphere_by_formula(double radius, double voxel)
{
    LevelSetOptions options;
    options.voxel_size = voxel;
    options.interior_depth = 3 * voxel;
    return mesh_to_level_set(icosphere(radius, 4), options);
}

TEST(MarchingTets, AnyPatternOfSignsIsClosedManifoldAndEmbedded)
{
    for (std::uint32_t seed = 1; seed <= 6; ++seed)
        expect_sound(tets_of(*random_signs(seed, 1.0f)));
}

TEST(MarchingTets, ValuesThatPutPointsNextToTheVoxelsDoNotMatter)
{
    for (const float outside : {1e-7f, 1e7f, 0.0f})
        expect_sound(tets_of(*random_signs(3, outside)));
}

TEST(MarchingTets, OneVoxelInsideIsAClosedSurfaceOfPositiveVolume)
{
    const auto grid =
        cube_field(3, [](const Coord& c) { return c == Coord(1, 1, 1) ? -1.0f : 1.0f; });
    const TriangleMesh mesh = tets_of(*grid);
    expect_sound(mesh);
    // The voxel's 14 edges in Kuhn's grid are cut in their middles: 24 tets, 24 triangles.
    EXPECT_EQ(mesh.points.size(), 14U);
    EXPECT_EQ(mesh.triangles.size(), 24U);
    EXPECT_GT(signed_volume(mesh.points, mesh.triangles), 0.0);
}

TEST(MarchingTets, ALinearFieldIsMetExactly)
{
    const Vec3d normal = Vec3d(1, 2, 3).unit();
    const auto grid = cube_field(12, [&](const Coord& c) {
        return static_cast<float>(normal.dot(c.asVec3d() - Vec3d(5.5)));
    });
    std::size_t looked_at = 0;
    for (const Vec3d& p : marching_tets(*grid).points) {
        const bool near_rim = std::min({p[0], p[1], p[2]}) < 0 || std::max({p[0], p[1], p[2]}) > 11;
        if (near_rim)
            continue;
        // Moved along an edge of up to sqrt(3) by the clearance of 0.15.
        EXPECT_LT(std::abs(normal.dot(p - Vec3d(5.5))), 0.15 * std::sqrt(3.0) + 1e-6);
        ++looked_at;
    }
    // The plane cuts an edge of each column of voxels along z, of two just at its end.
    EXPECT_GE(looked_at, 12u * 12u - 2u);
}

TEST(MarchingTets, WallsThroughVoxelCentresCanBeSimplified)
{
    // A box whose walls run through voxel centres: values of 0, which are outside.
    const auto box = cube_field(25, [](const Coord& c) {
        const Vec3d from_middle = c.asVec3d() - Vec3d(12.0);
        return static_cast<float>(std::max({std::abs(from_middle[0]), std::abs(from_middle[1]),
                                            std::abs(from_middle[2])}) -
                                  9.0);
    });
    const TriangleMesh walls = tets_of(*box);
    const TriangleMesh simple = simplify(walls, {0.5, 6.0}, nullptr).mesh;
    expect_sound(simple);
    // The collapses end at edges of up to twice 6: at least two triangles for 144 squares of area.
    EXPECT_LT(simple.triangles.size(), walls.triangles.size() / 20);
    EXPECT_LT(surface_distance(walls, simple, 1.0).max, 0.5);
}

TEST(Contour, IsSoundWhereVolumeToMeshIsNot)
{
    const auto grid = random_signs(5, 1e-7f);
    ContourReport report;
    const TriangleMesh mesh = contour(*grid, {0.5, false}, &report);
    EXPECT_EQ(report.method, ContourMethod::marching_tets);
    EXPECT_GT(report.volume_to_mesh_defects, 0U);
    expect_sound(mesh);
}

TEST(Contour, ASphereHasItsVolumeAndStaysWithinTheAdaptivity)
{
    const double voxel = 0.05;
    const auto grid = sphere_by_formula(1.0, voxel);
    for (const double adaptivity : {0.0, 0.25, 1.0}) {
        ContourReport report;
        const TriangleMesh mesh = contour(*grid, {adaptivity, false}, &report);
        expect_sound(mesh);
        EXPECT_EQ(report.components, 1U);
        for (const openvdb::Vec3s& p : mesh.points)
            EXPECT_NEAR(Vec3d(p).length(), 1.0, 0.1 * voxel);
        const TriangleMesh ball = icosphere(1.0, 4);
        EXPECT_LT(surface_distance(ball, mesh, voxel).max, (adaptivity + 0.1) * voxel);
        EXPECT_EQ(report.simplified_triangles, mesh.triangles.size());
        EXPECT_EQ(mesh.triangles.size() == report.triangles, adaptivity == 0.0);
    }
}

TEST(Contour, FollowsAnyLinearTransform)
{
    const auto grid = sphere_by_formula(1.0, 0.1);
    const auto squeezed = grid->deepCopy();
    squeezed->transform().postScale(Vec3d(1, 2, 0.5));
    squeezed->transform().postRotate(0.7, openvdb::math::Y_AXIS);
    squeezed->transform().postTranslate(Vec3d(3, -1, 2));
    const TriangleMesh round = contour(*grid, {0, false}), egg = contour(*squeezed, {0, false});
    expect_sound(egg);
    // The quads are not flat and their shorter diagonals differ: a thousandth of the volume.
    EXPECT_NEAR(signed_volume(egg.points, egg.triangles),
                signed_volume(round.points, round.triangles), 4e-3);
}

TEST(Contour, AMirroredTransformStillFacesOutward)
{
    const auto grid = sphere_by_formula(1.0, 0.1);
    grid->transform().postScale(Vec3d(-1, 1, 1));
    const TriangleMesh mesh = contour(*grid);
    expect_sound(mesh);
    EXPECT_NEAR(signed_volume(mesh.points, mesh.triangles), 4.0 / 3.0 * M_PI, 0.1);
}

TEST(Contour, OuterOnlyFillsVoidsAndDropsWhatIsInThem)
{
    const auto grid = cube_field(31, [](const Coord& c) {
        const double r = (c.asVec3d() - Vec3d(15)).length();
        // A ball of 3 in a void of 8 in a ball of 13.
        return static_cast<float>(std::min(r - 3, std::max(r - 13, 8 - r)));
    });
    ContourReport report;
    EXPECT_EQ(check_mesh(contour(*grid, {0, false})).components.size(), 3U);
    const TriangleMesh outer = contour(*grid, {0, true}, &report);
    expect_sound(outer);
    EXPECT_EQ(report.components, 1U);
    EXPECT_EQ(report.dropped_components, 2U);
    const double ball = 4.0 / 3.0 * M_PI * 13 * 13 * 13;
    EXPECT_NEAR(signed_volume(outer.points, outer.triangles), ball, 0.02 * ball);
}

TEST(Contour, RefusesWhatHasNoSurfaceOrAnOpenOne)
{
    EXPECT_THROW(contour(*FloatGrid::create(1.0f)), GeometryError);
    EXPECT_THROW(contour(*sphere_by_formula(1.0, 0.1), {-1.0, false}), InvalidOption);
}

TEST(Simplify, KeepsPointsWhereTheyWereAndWallsApart)
{
    // Two plates 0.01 apart, tolerance 0.1: only holding what touches keeps them apart.
    const TriangleMesh plates =
        joined(gridded_box({0, 0, 0}, {4, 4, 1}, 12), gridded_box({0, 0, 1.01}, {4, 4, 2}, 12));
    const Simplified simple = simplify(plates, {0.1, 2.0}, nullptr);
    expect_sound(simple.mesh);
    EXPECT_LT(simple.mesh.triangles.size(), plates.triangles.size());
    for (const openvdb::Vec3s& p : simple.mesh.points)
        EXPECT_NE(std::find(plates.points.begin(), plates.points.end(), p), plates.points.end());
    EXPECT_LT(surface_distance(plates, simple.mesh, 0.05).max, 0.1 * (1 + 1e-6));
}

TEST(Simplify, TurbulentSurfacesStayEmbedded)
{
    const TriangleMesh turbulent = tets_of(*random_signs(8, 1.0f));
    const Simplified simple = simplify(turbulent, {1.0, 10.0}, nullptr);
    expect_sound(simple.mesh);
    EXPECT_LT(simple.mesh.triangles.size(), turbulent.triangles.size());
}

TEST(Contour, CanBeCancelled)
{
    const auto sphere = sphere_by_formula(1.0, 0.1);
    // Done by tetrahedra, after the first way has failed.
    const auto signs = random_signs(5, 1e-7f);
    for (const FloatGrid* field : {sphere.get(), signs.get()})
        expect_cancelled(
            [&](Interrupter* interrupter) { contour(*field, {}, nullptr, interrupter); });
}

} // namespace
} // namespace vdb_shell::test

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/field/narrow_band.h"

#include "core/grid_instances.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"

#include <gmock/gmock-matchers.h>
#include <gtest/gtest.h>
#include <openvdb/math/Proximity.h>
#include <tbb/global_control.h>

#include <cmath>
#include <functional>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using ::testing::HasSubstr;

openvdb::FloatGrid::Ptr band_of(const TriangleMesh& mesh, double voxel)
{
    LevelSetOptions options;
    options.voxel_size = voxel;
    return mesh_to_narrow_band(mesh, options);
}

/// Signed distance to an axis-aligned box.
double box_distance(const Vec3d& p, const Vec3d& low, const Vec3d& high)
{
    double outside = 0, inside = -1e300;
    for (int k = 0; k < 3; ++k) {
        const double off = std::max(low[k] - p[k], p[k] - high[k]);
        outside += off > 0 ? off * off : 0;
        inside = std::max(inside, off);
    }
    return outside > 0 ? std::sqrt(outside) : inside;
}

/// Looks at every voxel of the box around the band, active or not.
void expect_field(const openvdb::FloatGrid& grid, const std::function<double(const Vec3d&)>& exact)
{
    const double voxel = grid.voxelSize()[0], band = grid.background();
    openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
    box.expand(2);
    auto values = grid.getConstAccessor();
    int wrong = 0;
    for (auto at = box.begin(); at && wrong < 5; ++at) {
        const double expected = exact(voxel * (*at).asVec3d());
        float found = 0;
        const bool active = values.probeValue(*at, found);
        const bool near = std::abs(std::abs(expected) - band) < 1e-5 * voxel;
        const bool good =
            near || (active == (std::abs(expected) < band) &&
                     std::abs(found - std::clamp(expected, -band, band)) < 1e-5 * voxel);
        EXPECT_TRUE(good) << *at << " is " << found << ", expected " << expected;
        wrong += good ? 0 : 1;
    }
}

/// By looking at all triangles, and the solid angle that they cover.
double brute_force(const TriangleMesh& mesh, const Vec3d& p)
{
    double nearest = 1e300, angle = 0;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        const Vec3d a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
        Vec3d uvw;
        const Vec3d on = openvdb::math::closestPointOnTriangleToPoint(a, b, c, p, uvw);
        nearest = std::min(nearest, (on - p).length());
        const Vec3d x = a - p, y = b - p, z = c - p;
        const double lx = x.length(), ly = y.length(), lz = z.length();
        angle += 2 * std::atan2(x.dot(y.cross(z)),
                                lx * ly * lz + x.dot(y) * lz + y.dot(z) * lx + z.dot(x) * ly);
    }
    return angle > 6.28 ? -nearest : nearest;
}

TEST(NarrowBand, IsTheDistanceToABox)
{
    const Vec3d low(-0.31, 0.02, -1), high(0.4, 1.03, 0.5);
    const auto grid = band_of(test::box(low, high), 0.05);
    expect_field(*grid, [&](const Vec3d& p) { return box_distance(p, low, high); });
    EXPECT_EQ(grid->getName(), "surface");
    EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_FLOAT_EQ(grid->background(), 0.15F);
}

TEST(NarrowBand, CavitiesAndWhatStandsInThem)
{
    const auto half = [](double r) { return Vec3d(r); };
    TriangleMesh mesh = test::box(-half(1), half(1));
    mesh = test::joined(mesh, test::reversed(test::box(-half(0.6), half(0.6))));
    mesh = test::joined(mesh, test::box(-half(0.3), half(0.3)));
    expect_field(*band_of(mesh, 0.06), [&](const Vec3d& p) {
        const double outer = box_distance(p, -half(1), half(1));
        const double cavity = box_distance(p, -half(0.6), half(0.6));
        const double core = box_distance(p, -half(0.3), half(0.3));
        return std::min(std::max(outer, -cavity), core);
    });
}

TEST(NarrowBand, IsWhatAllTrianglesSay)
{
    const Vec3d axis = Vec3d(1, 2, 3).unit();
    const std::vector<openvdb::Vec2d> notched{{0, 0}, {1, 0}, {1, 1}, {0.55, 0.6}, {0, 1}};
    for (const TriangleMesh& shape : {test::torus(1, 0.4, 14, 9), test::icosphere(1, 2),
                                      test::extruded(notched, {0, 0.3, 1})}) {
        const TriangleMesh mesh = test::turned(shape, axis, 0.7);
        const Bounds bounds = bounds_of(mesh.points);
        const double voxel = (bounds.high - bounds.low).length() / 40;
        expect_field(*band_of(mesh, voxel), [&](const Vec3d& p) { return brute_force(mesh, p); });
    }
}

TEST(NarrowBand, TrianglesSmallerThanVoxels)
{
    const TriangleMesh mesh = test::icosphere(1, 4);
    expect_field(*band_of(mesh, 0.15), [&](const Vec3d& p) { return brute_force(mesh, p); });
}

TEST(NarrowBand, SameBitsForAnyNumberOfThreads)
{
    const TriangleMesh mesh = test::torus(1, 0.4, 40, 20);
    const auto all = band_of(mesh, 0.02);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const auto alone = band_of(mesh, 0.02);
    ASSERT_TRUE(all->tree().hasSameTopology(alone->tree()));
    auto values = alone->getConstAccessor();
    for (auto value = all->cbeginValueAll(); value; ++value)
        ASSERT_EQ(*value, values.getValue(value.getCoord())) << value.getCoord();
}

TEST(NarrowBand, NeedsNoMemoryForTheInside)
{
    LevelSetOptions options;
    options.voxel_size = 0.005;
    options.max_memory_gib = 0.2;
    const TriangleMesh mesh = test::box(Vec3d(0), Vec3d(1));
    EXPECT_THROW(mesh_to_level_set(mesh, options), GeometryError);
    EXPECT_NO_THROW(mesh_to_narrow_band(mesh, options));
}

TEST(NarrowBand, RefusesWhatADenseFieldRefuses)
{
    const TriangleMesh mesh = test::box(Vec3d(0), Vec3d(1));
    const auto refusal = [&](const TriangleMesh& from, const auto& change) -> std::string {
        LevelSetOptions options;
        change(options);
        try {
            mesh_to_narrow_band(from, options);
        } catch (const Error& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(refusal(mesh, [](auto& o) { o.exterior_voxels = 2; }),
                HasSubstr("exterior_voxels is 2"));
    EXPECT_THAT(refusal(mesh, [](auto& o) { o.resolution = 0; }), HasSubstr("resolution is 0"));
    EXPECT_THAT(refusal(mesh, [](auto& o) { o.voxel_size = 2; }),
                HasSubstr("voxel larger than the object"));
    EXPECT_THAT(refusal({}, [](auto&) {}), HasSubstr("0 points"));
    const TriangleMesh between = test::box(Vec3d(0, 0.1, 0), Vec3d(2, 0.4, 2));
    LevelSetOptions coarse;
    coarse.voxel_size = 0.5;
    EXPECT_FALSE(has_inside(*mesh_to_narrow_band(between, coarse)));
}

} // namespace
} // namespace vdb_shell

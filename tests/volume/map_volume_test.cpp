// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/map_volume.h"

#include "core/grid_instances.h"
#include "support/cancelled.h"
#include "support/shapes.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/shell/shell_stack.h"
#include "vdb_shell/volume/shell_sampler.h"

#include <gtest/gtest.h>
#include <openvdb/tools/LevelSetSphere.h>
#include <openvdb/tools/VolumeToMesh.h>
#include <tbb/global_control.h>

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::FloatGrid;
using openvdb::Vec2d;
using openvdb::Vec3d;
using openvdb::Vec3s;

using Texture = std::vector<std::array<Vec2d, 3>>;

/// A slab: the square [0, 2] x [0, 2] at height 1 over the same square at 0.5, of n x n quads. Open
/// at the sides, which the map does not mind. u = x / 2, v = y / 2.
struct Slab {
    ShellStack stack;
    Texture texture;

    explicit Slab(int n = 3)
    {
        PrismShell shell;
        for (int y = 0; y <= n; ++y)
            for (int x = 0; x <= n; ++x) {
                shell.outer.emplace_back(2.0f * float(x) / float(n), 2.0f * float(y) / float(n), 1);
                shell.inner.emplace_back(shell.outer.back()[0], shell.outer.back()[1], 0.5f);
                shell.stop.push_back(StopReason::thickness);
            }
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const auto at = std::uint32_t(y * (n + 1) + x), up = at + std::uint32_t(n) + 1;
                shell.triangles.emplace_back(at, at + 1, up + 1);
                shell.triangles.emplace_back(at, up + 1, up);
            }
        for (const openvdb::Vec3I& t : shell.triangles) {
            auto& corner = texture.emplace_back();
            for (int k = 0; k < 3; ++k)
                corner[std::size_t(k)] =
                    Vec2d(shell.outer[t[k]][0] / 2.0, shell.outer[t[k]][1] / 2.0);
        }
        const PrismSplit split = split_prisms(shell, {});
        stack = one_layer(shell, split);
    }
    ShellMap map() const { return {stack, make_tets(stack)}; }
};

/// 20 x 20 x 10 voxels of side 0.1, with values of f at the middle of each in shares of the tile.
template <typename Function> FloatGrid::Ptr texture_of(const Function& f)
{
    const auto grid = FloatGrid::create(0.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    grid->setName("bricks");
    for (int x = 0; x < 20; ++x)
        for (int y = 0; y < 20; ++y)
            for (int z = 0; z < 10; ++z)
                grid->tree().setValue({x + 5, y - 3, z},
                                      float(f((x + 0.5) / 20, (y + 0.5) / 20, (z + 0.5) / 10)));
    return grid;
}

MapOptions voxels_of(double size)
{
    MapOptions options;
    options.voxel_size = size;
    return options;
}

/// That many voxels lie inside the slab at the least, whether or not its faces belong to it.
std::size_t voxels_in_slab(double size)
{
    const auto along = [&](double length) { return std::size_t(std::ceil(length / size)) - 1; };
    return along(2) * along(2) * along(0.5);
}

const FloatGrid& floats(const GridBasePtr& grid)
{
    return dynamic_cast<const FloatGrid&>(*grid);
}

TEST(MapVolume, PutsEachVoxelWhereItsTextureCoordinatesSay)
{
    const Slab slab;
    MapFigures figures;
    const GridBasePtr made =
        map_volume(*texture_of([](double u, double v, double w) { return 1 + u + 2 * v + 4 * w; }),
                   slab.map(), slab.texture, voxels_of(0.07), figures);
    EXPECT_EQ(made->getName(), "bricks");
    EXPECT_EQ(figures.active, made->activeVoxelCount());
    EXPECT_GT(figures.active, 5000U);
    for (auto value = floats(made).cbeginValueOn(); value; ++value) {
        const Vec3d p = made->indexToWorld(value.getCoord());
        const double u = p[0] / 2, v = p[1] / 2, w = (p[2] - 0.5) / 0.5;
        // Within half a voxel of the tile's border the next tile comes in.
        if (std::min({u, v, 1 - u, 1 - v}) < 0.025 || std::min(w, 1 - w) < 0.05)
            continue;
        ASSERT_NEAR(*value, 1 + u + 2 * v + 4 * w, 1e-5) << p;
    }
}

TEST(MapVolume, TilesWithoutASeam)
{
    const Slab slab;
    MapOptions options = voxels_of(0.03);
    options.repeat_u = 3;
    MapFigures figures;
    const auto wave = [](double u) { return 2 + std::sin(2 * M_PI * u); };
    const GridBasePtr made =
        map_volume(*texture_of([&](double u, double, double) { return wave(u); }), slab.map(),
                   slab.texture, options, figures);
    std::size_t looked_at = 0;
    for (auto value = floats(made).cbeginValueOn(); value; ++value, ++looked_at)
        // A sine sampled twenty times a period: the chord's error is (pi / 20)^2 / 2.
        ASSERT_NEAR(*value, wave(3 * made->indexToWorld(value.getCoord())[0] / 2), 0.0125);
    EXPECT_GE(looked_at, voxels_in_slab(0.03));
}

TEST(MapVolume, LiesBetweenTheDepthsThatAreAskedFor)
{
    const Slab slab;
    MapOptions options = voxels_of(0.02);
    options.from_depth = 0.25, options.to_depth = 0.75;
    MapFigures figures;
    const GridBasePtr made = map_volume(*texture_of([](double, double, double w) { return 1 + w; }),
                                        slab.map(), slab.texture, options, figures);
    EXPECT_GT(figures.active, 0U);
    for (auto value = floats(made).cbeginValueOn(); value; ++value) {
        const double z = made->indexToWorld(value.getCoord())[2], w = (z - 0.625) / 0.25;
        ASSERT_GE(w, -1e-6);
        ASSERT_LE(w, 1 + 1e-6);
        if (std::min(w, 1 - w) > 0.05) {
            ASSERT_NEAR(*value, 1 + w, 1e-5);
        }
    }
}

TEST(MapVolume, AFineCheckerboardBecomesGreyAndNotNoise)
{
    const Slab slab;
    MapOptions options = voxels_of(0.093);
    options.repeat_u = options.repeat_v = 20;
    MapFigures figures;
    // About nineteen voxels of the texture on one: fields of two.
    const auto texture = texture_of(
        [](double u, double v, double) { return 1.0 + (int(u * 10) + int(v * 10)) % 2; });
    const GridBasePtr made = map_volume(*texture, slab.map(), slab.texture, options, figures);
    EXPECT_EQ(figures.limited_samples, figures.active);
    options.most_samples = 20;
    const GridBasePtr full = map_volume(*texture, slab.map(), slab.texture, options, figures);
    EXPECT_EQ(figures.limited_samples, 0U);
    std::size_t looked_at = 0;
    for (auto value = floats(full).cbeginValueOn(); value; ++value, ++looked_at)
        // Of nineteen voxels a field may be left without its counterpart, along each axis.
        ASSERT_NEAR(*value, 1.5, 0.01);
    EXPECT_GE(looked_at, voxels_in_slab(0.093));
    options.most_samples = 1;
    const GridBasePtr point = map_volume(*texture, slab.map(), slab.texture, options, figures);
    double farthest = 0;
    for (auto value = floats(point).cbeginValueOn(); value; ++value)
        farthest = std::max(farthest, std::abs(*value - 1.5));
    EXPECT_GT(farthest, 0.4);
}

TEST(MapVolume, StretchIsOneOfASimilarityAndMoreOfAnother)
{
    // The texture is 2 x 2 x 1 long, as a copy of twice the slab's height.
    const Slab slab;
    MapFigures figures;
    MapOptions options = voxels_of(0.07);
    const auto texture = texture_of([](double, double, double) { return 1.0; });
    map_volume(*texture, slab.map(), slab.texture, options, figures);
    // Singular values 1, 1, 1/2 and the volumes' ratio 1/2.
    EXPECT_NEAR(figures.stretch, std::sqrt(2.25 / 3) / std::cbrt(0.5), 1e-6);
    options.repeat_depth = 0.5;
    map_volume(*texture, slab.map(), slab.texture, options, figures);
    EXPECT_NEAR(figures.stretch, 1, 1e-6);
    EXPECT_EQ(figures.mirrored, 0U);
}

TEST(MapVolume, MassIsThatOfTheTilesWhereItIsKept)
{
    const Slab slab;
    MapOptions options = voxels_of(0.02);
    options.keep_mass = true;
    MapFigures figures;
    const GridBasePtr made = map_volume(*texture_of([](double, double, double) { return 3.0; }),
                                        slab.map(), slab.texture, options, figures);
    std::size_t looked_at = 0;
    for (auto value = floats(made).cbeginValueOn(); value; ++value, ++looked_at)
        ASSERT_NEAR(*value, 6, 1e-4);
    EXPECT_GE(looked_at, voxels_in_slab(0.02));
}

TEST(MapVolume, VectorsAreTurnedAndStretched)
{
    const Slab slab;
    const auto texture = openvdb::Vec3SGrid::create();
    texture->setTransform(openvdb::math::Transform::createLinearTransform(0.1));
    texture->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    texture->fill({{0, 0, 0}, {19, 19, 9}}, Vec3s(1, 2, 4));
    MapFigures figures;
    const auto vectors = [&] {
        const GridBasePtr made =
            map_volume(*texture, slab.map(), slab.texture, voxels_of(0.07), figures);
        return openvdb::gridPtrCast<openvdb::Vec3SGrid>(made);
    };
    const auto turned = vectors();
    EXPECT_EQ(turned->getVectorType(), openvdb::VEC_CONTRAVARIANT_RELATIVE);
    std::size_t looked_at = 0;
    for (auto value = turned->cbeginValueOn(); value; ++value, ++looked_at)
        ASSERT_LT((*value - Vec3s(1, 2, 2)).length(), 1e-4);
    EXPECT_GE(looked_at, voxels_in_slab(0.07));
    texture->setVectorType(openvdb::VEC_INVARIANT);
    const auto kept = vectors();
    EXPECT_EQ(kept->activeVoxelCount(), turned->activeVoxelCount());
    for (auto value = kept->cbeginValueOn(); value; ++value)
        ASSERT_LT((*value - Vec3s(1, 2, 4)).length(), 1e-5);
}

/// A sphere of 20 voxels radius with a band of three; the tile is a cube of its active voxels.
FloatGrid::Ptr sphere_texture()
{
    const FloatGrid::Ptr sphere = openvdb::tools::createLevelSetSphere<FloatGrid>(
        20.0f, openvdb::Vec3f(0), 1.0f, openvdb::LEVEL_SET_HALF_WIDTH);
    sphere->setName("surface");
    return sphere;
}

/// Norms of central differences at voxels within one of the surface: farther out OpenVDB's
/// rebuilding is rougher.
void expect_unit_gradients(const FloatGrid& grid)
{
    const auto at = grid.getConstAccessor();
    const double voxel = grid.voxelSize()[0];
    std::size_t looked_at = 0;
    for (auto value = grid.cbeginValueOn(); value; ++value) {
        if (std::abs(*value) > voxel)
            continue;
        Vec3d gradient(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            openvdb::Coord low = value.getCoord(), high = low;
            --low[axis], ++high[axis];
            gradient[axis] = (at.getValue(high) - at.getValue(low)) / (2 * voxel);
        }
        ++looked_at;
        ASSERT_NEAR(gradient.length(), 1, 0.1) << value.getCoord();
    }
    EXPECT_GT(looked_at, 1000U);
}

TEST(MapVolume, ALevelSetIsOneAgainWithItsSurfaceWhereTheTilesSurfaceIsMappedTo)
{
    const Slab slab;
    const FloatGrid::Ptr sphere = sphere_texture();
    const openvdb::CoordBBox tile = sphere->evalActiveVoxelBoundingBox();
    ASSERT_EQ(tile.dim()[0], tile.dim()[2]);
    const double side = tile.dim()[0];
    constexpr double kVoxelOfTile = 0.0125;
    // Tiles are 0.5 high and as long, then twice as long: spheres, and ellipsoids.
    for (const double repeat : {4.0, 2.0}) {
        MapOptions options = voxels_of(kVoxelOfTile);
        options.repeat_u = options.repeat_v = repeat;
        MapFigures figures;
        const GridBasePtr made = map_volume(*sphere, slab.map(), slab.texture, options, figures);
        ASSERT_EQ(made->getGridClass(), openvdb::GRID_LEVEL_SET);
        EXPECT_NEAR(floats(made).background(), 3 * kVoxelOfTile, 1e-6);
        expect_unit_gradients(floats(made));
        const Vec3d semi_axes = 20 / side * Vec3d(2 / repeat, 2 / repeat, 0.5);
        std::vector<Vec3s> points;
        std::vector<openvdb::Vec4I> quads;
        openvdb::tools::volumeToMesh(floats(made), points, quads);
        EXPECT_GT(points.size(), 1000U);
        double area = 0;
        for (const Vec3s& point : points) {
            const double length = 2 / repeat;
            const Vec3d p(std::fmod(point[0], length) - length / 2,
                          std::fmod(point[1], length) - length / 2, point[2] - 0.75);
            // Nearly the distance from the ellipsoid: over the gradient's length.
            const Vec3d scaled = p / semi_axes;
            const double off =
                (scaled.length() - 1) * scaled.length() / (scaled / semi_axes).length();
            ASSERT_LT(std::abs(off), 0.5 * kVoxelOfTile) << point;
        }
        for (const openvdb::Vec4I& quad : quads)
            area += 0.5 * double((points[quad[2]] - points[quad[0]])
                                     .cross(points[quad[3]] - points[quad[1]])
                                     .length());
        // All of each sphere, and nothing inside.
        const double a = semi_axes[0], c = semi_axes[2];
        const double e = std::sqrt(std::max(0.0, 1 - c * c / (a * a)));
        const double each = e == 0
                                ? 4 * M_PI * a * a
                                : 2 * M_PI * a * a + M_PI * c * c / e * std::log((1 + e) / (1 - e));
        EXPECT_NEAR(area, repeat * repeat * each, 0.02 * repeat * repeat * each);
    }
}

TEST(MapVolume, ALevelSetThatReachesTheEndOfTheShellIsClosedThere)
{
    // The lower halves of four spheres, with their middles in the plane on which the slab ends.
    const Slab slab;
    const FloatGrid::Ptr sphere = sphere_texture();
    constexpr double kVoxelOfTile = 0.0125;
    const double radius = 20.0 / sphere->evalActiveVoxelBoundingBox().dim()[0];
    MapOptions options = voxels_of(kVoxelOfTile);
    options.repeat_u = options.repeat_v = 2;
    options.repeat_depth = 0.5;
    MapFigures figures;
    const GridBasePtr made = map_volume(*sphere, slab.map(), slab.texture, options, figures);
    std::vector<Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(floats(made), points, quads);
    ASSERT_GT(points.size(), 1000U);
    for (const Vec3s& point : points)
        ASSERT_LT(point[2], 1 + kVoxelOfTile);
    double volume = 0;
    for (const openvdb::Vec4I& quad : quads)
        for (const int k : {1, 2})
            volume += Vec3d(points[quad[0]])
                          .cross(Vec3d(points[quad[k]]))
                          .dot(Vec3d(points[quad[k + 1]])) /
                      6;
    // The end is met to a voxel.
    EXPECT_NEAR(std::abs(volume), 4 * 2 * M_PI / 3 * std::pow(radius, 3),
                4 * M_PI * radius * radius * kVoxelOfTile);
}

/// One prism of three positive tets whose map turns back between its ends: the inner triangle is
/// the outer one by a matrix whose trace is below -2 times the root of its determinant.
ShellStack prism_that_turns_back()
{
    constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                   {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (const auto& order : kOrders) {
        PrismShell shell;
        shell.triangles = {{0, 1, 2}};
        const openvdb::Vec2d ends[3] = {{0, 0}, {1, 0}, {0, 1}};
        for (const int k : order) {
            const openvdb::Vec2d& p = ends[k];
            shell.outer.emplace_back(float(p[0]), float(p[1]), 1);
            shell.inner.emplace_back(float(-p[0] + 0.2 * p[1]), float(-0.2 * p[0]), 0);
            shell.stop.push_back(StopReason::thickness);
        }
        if (order[1] != (order[0] + 1) % 3)
            std::swap(shell.triangles[0][1], shell.triangles[0][2]);
        const ShellStack stack = one_layer(shell, split_prisms(shell, {}));
        const TetSigns signs = count_tet_signs(make_tets(stack));
        if (signs.inverted.count + signs.flat.count == 0)
            return stack;
    }
    return {};
}

TEST(MapVolume, IsLinearInTheTetsOfAPrismThatTurnsBack)
{
    const ShellStack stack = prism_that_turns_back();
    ASSERT_EQ(stack.layers.size(), 1U);
    const ShellMap map(stack, make_tets(stack));
    ASSERT_EQ(map.linear_prisms(), 1U);
    // u and v are the outer triangle's x and y: of an inner corner those of the outer one above.
    const PrismShell& shell = stack.layers[0];
    const auto uvw = [&](std::uint32_t point) {
        const bool outer = point < 3;
        const Vec3s& above = shell.outer[outer ? point : point - 3];
        return Vec3d(above[0], above[1], outer ? 1 : 0);
    };
    Texture texture(1);
    for (int k = 0; k < 3; ++k) {
        const Vec3d at = uvw(shell.triangles[0][k]);
        texture[0][std::size_t(k)] = Vec2d(at[0], at[1]);
    }
    MapFigures figures;
    MapOptions options = voxels_of(0.03);
    options.most_samples = 1; // a mean would reach into the next tile
    const GridBasePtr made =
        map_volume(*texture_of([](double u, double v, double w) { return 1 + u + 2 * v + 4 * w; }),
                   map, texture, options, figures);
    const ShellSampler sampler(map);
    std::size_t compared = 0;
    for (auto value = floats(made).cbeginValueOn(); value; ++value) {
        const Vec3d p = made->indexToWorld(value.getCoord());
        const ShellPlace place = sampler.find(p);
        ASSERT_TRUE(place.found());
        const openvdb::Vec4I& tet = map.tets().tets[place.tet];
        // Weights by volumes.
        Vec3d at(0.0);
        double whole = 0;
        for (int k = 0; k < 4; ++k) {
            std::array<Vec3d, 4> corner;
            for (int j = 0; j < 4; ++j)
                corner[std::size_t(j)] = j == k ? p : Vec3d(map.tets().points[tet[j]]);
            const double volume =
                (corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(corner[3] - corner[0]);
            at += volume * uvw(tet[k]);
            whole += volume;
        }
        at /= whole;
        const Vec3d rest = Vec3d(1) - at;
        if (std::min({at[0], at[1], rest[0], rest[1]}) < 0.025 || std::min(at[2], rest[2]) < 0.05)
            continue; // the next tile comes in
        ASSERT_NEAR(*value, 1 + at[0] + 2 * at[1] + 4 * at[2], 1e-5) << p;
        ++compared;
    }
    EXPECT_GT(compared, 1000U);
}

TEST(MapVolume, HasTheSameBitsOnAnyNumberOfThreads)
{
    const Slab slab;
    MapFigures figures;
    const auto on_threads = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return map_volume(*texture_of([](double u, double v, double w) { return u * v + w; }),
                          slab.map(), slab.texture, voxels_of(0.03), figures);
    };
    const GridBasePtr one = on_threads(1);
    const double stretch = figures.stretch;
    const GridBasePtr four = on_threads(4);
    EXPECT_EQ(stretch, figures.stretch);
    EXPECT_EQ(one->activeVoxelCount(), four->activeVoxelCount());
    const auto other = floats(four).getConstAccessor();
    for (auto value = floats(one).cbeginValueOn(); value; ++value)
        ASSERT_EQ(*value, other.getValue(value.getCoord()));
}

TEST(MapVolume, RefusesWhatHasNoTiles)
{
    const Slab slab;
    const ShellMap map = slab.map();
    MapFigures figures;
    const auto texture = texture_of([](double, double, double) { return 1.0; });
    const auto refused = [&](const openvdb::GridBase& grid, const MapOptions& options,
                             const Texture& corner) {
        EXPECT_THROW(map_volume(grid, map, corner, options, figures), InvalidOption);
    };
    refused(*texture, voxels_of(0), slab.texture);
    const auto refused_with = [&](auto set) {
        MapOptions options = voxels_of(0.1);
        set(options);
        refused(*texture, options, slab.texture);
    };
    refused_with([](MapOptions& o) { o.repeat_u = std::nan(""); });
    refused_with([](MapOptions& o) { o.repeat_depth = 1e12; });
    refused_with([](MapOptions& o) { o.most_samples = 3000000000; });
    refused_with([](MapOptions& o) { o.from_depth = o.to_depth = 0.5; });
    refused(*texture, voxels_of(0.1), {});
    refused(*FloatGrid::create(), voxels_of(0.1), slab.texture);
    refused(*openvdb::BoolGrid::create(), voxels_of(0.1), slab.texture);
    MapOptions options = voxels_of(0.1);
    options.from_depth = 0.5, options.to_depth = 0.5;
    refused(*texture, options, slab.texture);
    for (const double size : {1e-8, 1e3, 1e300})
        EXPECT_THROW(map_volume(*texture, map, slab.texture, voxels_of(size), figures),
                     GeometryError)
            << size;
    options = voxels_of(0.1);
    options.repeat_v = 0;
    refused(*texture, options, slab.texture);
    const auto frustum = openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(0), Vec3d(100)), 0.5, 10);
    texture->setTransform(frustum);
    refused(*texture, voxels_of(0.1), slab.texture);
}

TEST(MapVolume, CanBeCancelled)
{
    const Slab slab;
    const ShellMap map = slab.map();
    const auto texture = texture_of([](double, double, double) { return 1.0; });
    MapFigures figures;
    test::expect_cancelled([&](Interrupter* interrupter) {
        map_volume(*texture, map, slab.texture, voxels_of(0.07), figures, interrupter);
    });
}

} // namespace
} // namespace vdb_shell

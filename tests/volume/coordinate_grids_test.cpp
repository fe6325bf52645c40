// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/coordinate_grids.h"

#include "core/grid_instances.h"
#include "support/cancelled.h"
#include "support/shapes.h"
#include "vdb_shell/core/error.h"
#include "volume/ramp.h"
#include "write/hand_made.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace vdb_shell
{
namespace
{

using openvdb::FloatGrid;
using openvdb::Int32Grid;
using openvdb::Vec3d;
using openvdb::Vec3SGrid;

constexpr double kVoxel = 0.04, kInner = 0.5;
// The round shell has 57,000; facets cut less than a tenth off.
constexpr std::size_t kFewestVoxels = 50000;

struct CoordinateBall {
    ShellStack stack;
    TetMesh tets;
    ShellMap map;

    CoordinateBall() : CoordinateBall(test::hand_made_shell(test::icosphere(1.0, 3), kInner)) {}
    explicit CoordinateBall(const test::HandMade& made)
        : stack(one_layer(made.shell, made.split)), tets(made.tets), map(stack, tets)
    {
    }
};

std::map<std::string, GridBasePtr> grids_of(const CoordinateBall& ball, const std::string& volumes,
                                            const std::vector<CornerTexture>* texture = nullptr)
{
    CoordinateOptions options;
    options.volumes = volumes;
    options.voxel_size = kVoxel;
    CoordinateInputs inputs;
    inputs.map = &ball.map;
    inputs.stack = &ball.stack;
    inputs.texture = texture;
    std::map<std::string, GridBasePtr> named;
    for (const GridBasePtr& grid : coordinate_grids(inputs, options))
        named[grid->getName()] = grid;
    return named;
}

template <typename Grid> const Grid& as(const GridBasePtr& grid)
{
    return static_cast<const Grid&>(*grid);
}

TEST(CoordinateGrids, DepthThicknessAndPlaceOfABall)
{
    const CoordinateBall ball;
    auto grids = grids_of(ball, "rest,depth,thickness,density,layer");
    EXPECT_EQ(grids.size(), 6u); // layer_0 too
    const auto& depth = as<FloatGrid>(grids["depth"]);
    EXPECT_GT(depth.activeVoxelCount(), kFewestVoxels);
    for (const auto& [name, grid] : grids)
        EXPECT_EQ(grid->activeVoxelCount(), depth.activeVoxelCount()) << name;
    auto rest = as<Vec3SGrid>(grids["rest"]).getConstAccessor();
    auto thickness = as<FloatGrid>(grids["thickness"]).getConstAccessor();
    auto density = as<FloatGrid>(grids["density"]).getConstAccessor();
    auto layer = as<Int32Grid>(grids["layer"]).getConstAccessor();
    for (auto voxel = depth.cbeginValueOn(); voxel; ++voxel) {
        const openvdb::Coord at = voxel.getCoord();
        const Vec3d point = kVoxel * at.asVec3d();
        EXPECT_LT((Vec3d(rest.getValue(at)) - point).length(), 1e-6);
        // The facets lie within a hundredth of the sphere; pillars point to its centre.
        EXPECT_NEAR(*voxel, (1 - point.length()) / (1 - kInner), 0.03);
        EXPECT_NEAR(thickness.getValue(at), 1 - kInner, 1e-6);
        EXPECT_NEAR(density.getValue(at), 1 - *voxel, 1e-6);
        EXPECT_EQ(layer.getValue(at), 0);
    }
}

TEST(CoordinateGrids, PrismAndNearestTriangleGiveBackThePoint)
{
    const CoordinateBall ball;
    auto grids = grids_of(ball, "prism,nearest,depth");
    const auto& prism = as<Int32Grid>(grids["prism"]);
    auto weights = as<Vec3SGrid>(grids["prism_weights"]).getConstAccessor();
    auto nearest = as<Int32Grid>(grids["nearest"]).getConstAccessor();
    auto near = as<Vec3SGrid>(grids["nearest_weights"]).getConstAccessor();
    auto depth = as<FloatGrid>(grids["depth"]).getConstAccessor();
    const auto on = [&](int triangle, const openvdb::Vec3s& weight, const auto& points) {
        Vec3d sum(0.0);
        for (int k = 0; k < 3; ++k)
            sum +=
                double(weight[k]) * Vec3d(points[ball.stack.triangles()[std::size_t(triangle)][k]]);
        return sum;
    };
    std::size_t looked_at = 0;
    for (auto voxel = prism.cbeginValueOn(); voxel; ++voxel, ++looked_at) {
        const openvdb::Coord at = voxel.getCoord();
        const Vec3d point = kVoxel * at.asVec3d();
        const PrismShell& shell = ball.stack.layers[0];
        const double t = depth.getValue(at);
        const Vec3d there = (1 - t) * on(*voxel, weights.getValue(at), shell.outer) +
                            t * on(*voxel, weights.getValue(at), shell.inner);
        EXPECT_LT((there - point).length(), 1e-5);
        const double distance =
            (on(nearest.getValue(at), near.getValue(at), shell.outer) - point).length();
        for (const auto& corner : shell.outer)
            EXPECT_LE(distance, (Vec3d(corner) - point).length() + 1e-6);
        // The sphere's facets lie between these radii.
        EXPECT_LE(distance, 1 - point.length() + 1e-6);
        EXPECT_GE(distance, 0.985 - point.length());
    }
    EXPECT_GT(looked_at, kFewestVoxels);
}

TEST(CoordinateGrids, TextureCoordinatesAreInterpolatedInTheirTriangle)
{
    const CoordinateBall ball;
    std::vector<CornerTexture> texture(ball.stack.triangles().size());
    for (std::size_t t = 0; t < texture.size(); ++t)
        texture[t] = {openvdb::Vec2d(double(t), 0), openvdb::Vec2d(double(t) + 1, 0),
                      openvdb::Vec2d(double(t), 1)};
    auto grids = grids_of(ball, "uvw,prism,depth", &texture);
    auto uvw = as<Vec3SGrid>(grids["uvw"]).getConstAccessor();
    auto weights = as<Vec3SGrid>(grids["prism_weights"]).getConstAccessor();
    auto depth = as<FloatGrid>(grids["depth"]).getConstAccessor();
    const auto& prism = as<Int32Grid>(grids["prism"]);
    std::size_t looked_at = 0;
    for (auto voxel = prism.cbeginValueOn(); voxel; ++voxel, ++looked_at) {
        const openvdb::Coord at = voxel.getCoord();
        EXPECT_NEAR(uvw.getValue(at)[0], double(*voxel) + weights.getValue(at)[1], 1e-3);
        EXPECT_NEAR(uvw.getValue(at)[1], weights.getValue(at)[2], 1e-6);
        EXPECT_EQ(uvw.getValue(at)[2], depth.getValue(at));
    }
    EXPECT_GT(looked_at, kFewestVoxels);
    EXPECT_THROW(grids_of(ball, "uvw"), InvalidOption);
    texture.pop_back();
    EXPECT_THROW(grids_of(ball, "uvw", &texture), InvalidOption);
}

TEST(CoordinateGrids, RefusesListsAndRampsThatAreNone)
{
    const CoordinateBall ball;
    EXPECT_THROW(grids_of(ball, "depth,nonsense"), InvalidOption);
    EXPECT_THROW(grids_of(ball, "depth,depth"), InvalidOption);
    EXPECT_THROW(grids_of(ball, ""), InvalidOption);
    for (const char* ramp : {"", "1", "0:1:2", "0:x", "0:1,0:2", "1:0,0:1", "0:nan"})
        EXPECT_THROW(ramp_of(ramp, "--density-ramp"), InvalidOption) << ramp;
    const Ramp ramp = ramp_of("0:1,0.5:0,1:4", "r");
    EXPECT_EQ(ramp.at(-1), 1);
    EXPECT_EQ(ramp.at(0.25), 0.5);
    EXPECT_EQ(ramp.at(0.75), 2);
    EXPECT_EQ(ramp.at(2), 4);
}

TEST(CoordinateGrids, CanBeCancelled)
{
    const CoordinateBall ball;
    CoordinateOptions options;
    options.voxel_size = kVoxel;
    CoordinateInputs inputs;
    inputs.map = &ball.map;
    inputs.stack = &ball.stack;
    for (const char* volumes : {"depth", "rest", "nearest"}) {
        SCOPED_TRACE(volumes);
        options.volumes = volumes;
        test::expect_cancelled(
            [&](Interrupter* interrupter) { coordinate_grids(inputs, options, interrupter); });
    }
}

TEST(CoordinateGrids, VoxelsThatDoNotFitAreRefused)
{
    const CoordinateBall ball;
    CoordinateInputs inputs;
    inputs.map = &ball.map;
    inputs.stack = &ball.stack;
    CoordinateOptions options;
    // Far more than any machine has; larger than the shell; between its voxels' centres.
    for (const double size : {1e-8, 1e-6, 2.5, 1e300, 1.9}) {
        options.voxel_size = size;
        EXPECT_THROW(coordinate_grids(inputs, options), GeometryError) << size;
    }
    for (const double size : {0.0, -1.0, std::nan("")}) {
        options.voxel_size = size;
        EXPECT_THROW(coordinate_grids(inputs, options), InvalidOption) << size;
    }
}

} // namespace
} // namespace vdb_shell

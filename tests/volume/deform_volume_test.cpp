// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/deform_volume.h"

#include "core/grid_instances.h"
#include "support/cancelled.h"
#include "vdb_shell/core/error.h"
#include "volume/ball.h"

#include <gtest/gtest.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <cmath>
#include <functional>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::FloatGrid;
using openvdb::Int32Grid;
using openvdb::Vec3d;
using openvdb::Vec3s;
using openvdb::Vec3SGrid;

constexpr double kDeformVoxel = 0.025;

using test::as_it_is;

/// A ball's shell, thick enough to hold what these tests put into it, in a pose.
ShellMap map_of(const std::function<Vec3d(const Vec3d&)>& pose)
{
    return test::ball(pose).map();
}

/// Voxels with centres in the box get value(centre).
template <typename Grid, typename Value>
typename Grid::Ptr filled(const Vec3d& low, const Vec3d& high, const Value& value)
{
    auto grid = Grid::create();
    grid->setTransform(openvdb::math::Transform::createLinearTransform(kDeformVoxel));
    grid->setName("density");
    auto write = grid->getAccessor();
    for (const Coord& at :
         openvdb::CoordBBox(Coord::ceil(low / kDeformVoxel), Coord::floor(high / kDeformVoxel)))
        write.setValueOn(at, value(kDeformVoxel * at.asVec3d()));
    return grid;
}

FloatGrid::Ptr fog(const Vec3d& low, const Vec3d& high, float value = 1.0f)
{
    const auto grid = filled<FloatGrid>(low, high, [=](const Vec3d&) { return value; });
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

const Vec3d kLow(0.2, -0.25, -0.25), kHigh(0.7, 0.25, 0.25);

template <typename Grid>
typename Grid::Ptr deformed(const Grid& grid, const ShellMap& rest, const ShellMap& posed,
                            DeformFigures& figures, const DeformOptions& options = {})
{
    return openvdb::gridPtrCast<Grid>(
        deform_volume(grid, rest, posed, Vec3d(0.0), options, figures));
}

TEST(DeformVolume, TheSamePoseGivesTheSameVoxels)
{
    const ShellMap rest = map_of(as_it_is);
    const auto source = filled<FloatGrid>(kLow, kHigh, [](const Vec3d& p) { return float(p[0]); });
    source->setSaveFloatAsHalf(true);
    DeformFigures figures;
    const auto same = deformed(*source, rest, rest, figures);
    EXPECT_EQ(same->getName(), "density");
    EXPECT_TRUE(same->saveFloatAsHalf());
    for (auto voxel = source->cbeginValueOn(); voxel; ++voxel)
        EXPECT_EQ(same->tree().getValue(voxel.getCoord()), *voxel);
    EXPECT_EQ(same->activeVoxelCount(), source->activeVoxelCount());
}

TEST(DeformVolume, MovesWithTheShellByWholeVoxels)
{
    const ShellMap rest = map_of(as_it_is);
    const ShellMap posed = map_of([](const Vec3d& p) { return p + Vec3d(8 * kDeformVoxel, 0, 0); });
    const auto source = filled<FloatGrid>(kLow, kHigh, [](const Vec3d& p) { return float(p[0]); });
    DeformFigures figures;
    const auto moved = deformed(*source, rest, posed, figures);
    for (auto voxel = source->cbeginValueOn(); voxel; ++voxel)
        EXPECT_NEAR(moved->tree().getValue(voxel.getCoord().offsetBy(8, 0, 0)), *voxel, 1e-5);
    // Places of posed float32 points are off by a hundred-thousandth of a voxel, so voxels beside
    // the volume may be active; nothing is in them.
    for (auto voxel = moved->cbeginValueOn(); voxel; ++voxel)
        EXPECT_NEAR(*voxel, source->tree().getValue(voxel.getCoord().offsetBy(-8, 0, 0)), 1e-5);
}

TEST(DeformVolume, KeepsTheMassOfFog)
{
    const ShellMap rest = map_of(as_it_is);
    // Volumes change by a factor of 0.7 * 0.8 * 1.5, and the whole is turned.
    const ShellMap posed = map_of([](const Vec3d& p) {
        const Vec3d q(0.7 * p[0], 0.8 * p[1], 1.5 * p[2]);
        return Vec3d(0.8 * q[0] - 0.6 * q[1], 0.6 * q[0] + 0.8 * q[1], q[2]);
    });
    DeformFigures figures;
    const auto source = fog(kLow, kHigh, 2.0f);
    const auto made = deformed(*source, rest, posed, figures);
    EXPECT_NEAR(figures.mass_after / figures.mass_before, 1, 0.01);
    // Well inside, density is that of the volume ratio.
    const Vec3d inside(0.8 * 0.7 * 0.45, 0.6 * 0.7 * 0.45, 0);
    EXPECT_NEAR(made->tree().getValue(Coord::round(inside / kDeformVoxel)), 2 / (0.7 * 0.8 * 1.5),
                1e-4);
    DeformOptions keep;
    keep.mass = MassRule::none;
    EXPECT_NEAR(deformed(*source, rest, posed, figures, keep)
                    ->tree()
                    .getValue(Coord::round(inside / kDeformVoxel)),
                2, 1e-5);
}

TEST(DeformVolume, BoundsDensity)
{
    const ShellMap rest = map_of(as_it_is);
    const ShellMap posed = map_of([](const Vec3d& p) { return 0.5 * p; });
    DeformOptions options;
    options.most_density = 3;
    DeformFigures figures;
    const auto made = deformed(*fog(kLow, kHigh), rest, posed, figures, options);
    EXPECT_EQ(figures.limited_density, figures.active_after);
    for (auto voxel = made->cbeginValueOn(); voxel; ++voxel)
        EXPECT_LE(*voxel, 3.0f);
}

TEST(DeformVolume, ACheckerboardMadeSmallIsGrey)
{
    const ShellMap rest = map_of(as_it_is);
    const ShellMap posed = map_of([](const Vec3d& p) { return 0.1 * p; });
    const auto board = filled<FloatGrid>(kLow, kHigh, [](const Vec3d& p) {
        const Coord at = Coord::round(p / kDeformVoxel);
        return float((at[0] + at[1] + at[2]) & 1);
    });
    board->setName("pattern");
    DeformFigures figures;
    const auto made = deformed(*board, rest, posed, figures);
    EXPECT_GT(made->activeVoxelCount(), 5u);
    for (auto voxel = made->cbeginValueOn(); voxel; ++voxel) {
        // Where all that a voxel covers lies in the board.
        const Vec3d centre = 10 * kDeformVoxel * voxel.getCoord().asVec3d();
        bool within = true;
        for (int k = 0; k < 3; ++k)
            within = within && centre[k] - 6 * kDeformVoxel > kLow[k] &&
                     centre[k] + 6 * kDeformVoxel < kHigh[k];
        if (within) {
            EXPECT_NEAR(*voxel, 0.5, 0.01);
        }
    }
}

TEST(DeformVolume, VectorsGoByTheirType)
{
    const ShellMap rest = map_of(as_it_is);
    // A quarter turn about z after doubling y.
    const ShellMap posed = map_of([](const Vec3d& p) { return Vec3d(-2 * p[1], p[0], p[2]); });
    const Coord at = Coord::round(Vec3d(0, 0.45, 0) / kDeformVoxel);
    DeformFigures figures;
    const auto grid = filled<Vec3SGrid>(kLow, kHigh, [](const Vec3d&) { return Vec3s(1, 1, 0); });
    const auto there = [&](openvdb::VecType type, VectorRule rule) {
        grid->setVectorType(type);
        DeformOptions options;
        options.vectors = rule;
        return Vec3d(deformed(*grid, rest, posed, figures, options)->tree().getValue(at));
    };
    const auto near = [](const Vec3d& a, const Vec3d& b) { return (a - b).length() < 1e-5; };
    EXPECT_TRUE(near(there(openvdb::VEC_INVARIANT, VectorRule::by_type), Vec3d(1, 1, 0)));
    EXPECT_TRUE(
        near(there(openvdb::VEC_CONTRAVARIANT_RELATIVE, VectorRule::by_type), Vec3d(-2, 1, 0)));
    EXPECT_TRUE(near(there(openvdb::VEC_COVARIANT, VectorRule::by_type), Vec3d(-0.5, 1, 0)));
    EXPECT_TRUE(near(there(openvdb::VEC_COVARIANT_NORMALIZE, VectorRule::by_type),
                     Vec3d(-0.5, 1, 0) / std::sqrt(1.25)));
    EXPECT_TRUE(near(there(openvdb::VEC_INVARIANT, VectorRule::rotate), Vec3d(-1, 1, 0)));
    EXPECT_TRUE(near(there(openvdb::VEC_COVARIANT, VectorRule::keep), Vec3d(1, 1, 0)));
    EXPECT_THROW(there(openvdb::VEC_CONTRAVARIANT_ABSOLUTE, VectorRule::by_type), InvalidOption);
}

TEST(DeformVolume, LevelSetsAreDistancesAgain)
{
    const ShellMap rest = map_of(as_it_is);
    const ShellMap posed = map_of([](const Vec3d& p) { return Vec3d(1.5 * p[0], p[1], p[2]); });
    const auto ball = openvdb::tools::createLevelSetSphere<FloatGrid>(
        0.2f, openvdb::Vec3f(0.5f, 0, 0), float(kDeformVoxel), 3.0f);
    DeformFigures figures;
    const auto made = deformed(*ball, rest, posed, figures);
    EXPECT_EQ(made->getGridClass(), openvdb::GRID_LEVEL_SET);
    EXPECT_NEAR(made->background(), 3 * kDeformVoxel, 1e-6);
    // An ellipsoid: zero where its axes end, negative in the middle, slope 1 beside.
    const auto value = [&](const Vec3d& p) {
        return openvdb::tools::BoxSampler::sample(made->tree(), Vec3d(p / kDeformVoxel));
    };
    EXPECT_LT(value(Vec3d(0.75, 0, 0)), 0);
    for (const Vec3d& pole : {Vec3d(0.45, 0, 0), Vec3d(1.05, 0, 0), Vec3d(0.75, 0.2, 0)})
        EXPECT_NEAR(value(pole), 0, 0.25 * kDeformVoxel);
    EXPECT_NEAR(value(Vec3d(1.05 + kDeformVoxel, 0, 0)) - value(Vec3d(1.05 - kDeformVoxel, 0, 0)),
                2 * kDeformVoxel, 0.2 * kDeformVoxel);
}

TEST(DeformVolume, WholeNumbersAreNotMixed)
{
    const ShellMap rest = map_of(as_it_is);
    const ShellMap posed = map_of([](const Vec3d& p) { return 0.6 * p; });
    const auto grid =
        filled<Int32Grid>(kLow, kHigh, [](const Vec3d& p) { return p[0] < 0.45 ? 10 : 20; });
    DeformFigures figures;
    const auto made = deformed(*grid, rest, posed, figures);
    EXPECT_GT(made->activeVoxelCount(), 1000u);
    for (auto voxel = made->cbeginValueOn(); voxel; ++voxel)
        EXPECT_TRUE(*voxel == 10 || *voxel == 20) << *voxel;
}

TEST(DeformVolume, RefusesOptionsOutOfRange)
{
    const ShellMap rest = map_of(as_it_is);
    const auto source = fog(kLow, kHigh);
    DeformFigures figures;
    const auto refused = [&](auto set) {
        DeformOptions options;
        set(options);
        EXPECT_THROW(deformed(*source, rest, rest, figures, options), InvalidOption);
    };
    refused([](DeformOptions& o) { o.most_density = 0; });
    refused([](DeformOptions& o) { o.most_outside = std::nan(""); });
    refused([](DeformOptions& o) { o.most_samples = 0; });
    // More than an int counts along three axes.
    refused([](DeformOptions& o) { o.most_samples = 3000000000; });
}

TEST(DeformVolume, RefusesWhatItCannotDo)
{
    const ShellMap rest = map_of(as_it_is);
    DeformFigures figures;
    const auto refused = [&](const openvdb::GridBase& grid) {
        try {
            deform_volume(grid, rest, rest, Vec3d(0.0), {}, figures);
        } catch (const InvalidOption& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const auto outside = fog(Vec3d(0.5, 0, 0), Vec3d(1.5, 0.2, 0.2));
    EXPECT_NE(refused(*outside).find("outside the shell"), std::string::npos);
    EXPECT_GT(figures.outside, 0.3);
    DeformOptions all;
    all.most_outside = 1;
    EXPECT_NO_THROW(deform_volume(*outside, rest, rest, Vec3d(0.0), all, figures));
    EXPECT_NE(refused(*FloatGrid::create()).find("no active voxels"), std::string::npos);
    const auto frustum = fog(kLow, kHigh);
    frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd(Vec3d(0.0), Vec3d(10.0)), 0.5, 10.0, 1.0));
    EXPECT_NE(refused(*frustum).find("transform"), std::string::npos);
    const auto stretched = fog(kLow, kHigh);
    stretched->transform().preScale(Vec3d(1, 2, 1));
    EXPECT_NE(refused(*stretched).find("transform"), std::string::npos);
    EXPECT_NE(refused(*openvdb::BoolGrid::create(true)).find("values of type bool"),
              std::string::npos);
}

TEST(DeformVolume, CanBeCancelled)
{
    const ShellMap rest = map_of(as_it_is), posed = map_of(test::turned_long);
    const auto source = fog(kLow, kHigh);
    DeformFigures figures;
    test::expect_cancelled([&](Interrupter* interrupter) {
        deform_volume(*source, rest, posed, Vec3d(0.0), {}, figures, interrupter);
    });
}

} // namespace
} // namespace vdb_shell

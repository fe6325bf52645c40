// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/volume/deform_points.h"

#include "support/cancelled.h"
#include "support/grids.h"
#include "vdb_shell/core/error.h"
#include "volume/ball.h"

#include <gtest/gtest.h>
#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointGroup.h>
#include <tbb/global_control.h>

#include <cmath>
#include <sstream>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using openvdb::points::PointDataGrid;

constexpr double kPointsVoxel = 0.1;

using test::as_it_is;
using test::Ball;
using test::ball;
using test::turned_long;
using test::turning;

/// Between the ball's two surfaces, in all directions.
std::vector<Vec3s> places()
{
    std::vector<Vec3s> points;
    for (int i = 0; i < 500; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / 500.0, angle = 2.4 * i;
        const double ring = std::sqrt(1.0 - z * z), radius = 0.25 + 0.65 * (i % 7) / 7.0;
        points.emplace_back(radius * Vec3d(ring * std::cos(angle), ring * std::sin(angle), z));
    }
    return points;
}

/// Points that know where they were, as "start".
PointDataGrid::Ptr points_at(const std::vector<Vec3s>& positions)
{
    const PointDataGrid::Ptr grid = test::point_grid(positions, kPointsVoxel);
    grid->setName("particles");
    test::append_attribute(grid->tree(), "start", Vec3s(0.0f));
    for (auto leaf = grid->tree().beginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<Vec3s> at(leaf->constAttributeArray("P"));
        openvdb::points::AttributeWriteHandle<Vec3s> start(leaf->attributeArray("start"));
        for (auto point = leaf->beginIndexOn(); point; ++point)
            start.set(*point, Vec3s(grid->transform().indexToWorld(Vec3d(at.get(*point)) +
                                                                   point.getCoord().asVec3d())));
    }
    return grid;
}

/// visit(start, position, leaf, index) for each point.
template <typename Visit> std::size_t for_each_point(const PointDataGrid& grid, const Visit& visit)
{
    std::size_t count = 0;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::points::AttributeHandle<Vec3s> at(leaf->constAttributeArray("P")),
            start(leaf->constAttributeArray("start"));
        for (auto point = leaf->beginIndexOn(); point; ++point, ++count)
            visit(Vec3d(start.get(*point)),
                  grid.transform().indexToWorld(Vec3d(at.get(*point)) + point.getCoord().asVec3d()),
                  *leaf, *point);
    }
    return count;
}

Vec3s vector_at(const openvdb::points::PointDataTree::LeafNodeType& leaf, const char* name,
                openvdb::Index point)
{
    return openvdb::points::AttributeHandle<Vec3s>(leaf.constAttributeArray(name)).get(point);
}

PointDataGrid::Ptr carried(const openvdb::GridBase& source, const ShellMap& rest,
                           const ShellMap& posed, DeformFigures& figures,
                           const DeformOptions& options = {}, const ShellMap* velocity = nullptr)
{
    return openvdb::gridPtrCast<PointDataGrid>(
        deform_points(source, rest, posed, Vec3d(0.0), options, figures, velocity));
}

TEST(DeformPoints, GoWithTheirPlaceInTheShell)
{
    openvdb::initialize();
    const ShellMap rest = ball(as_it_is).map(), posed = ball(turned_long).map();
    const PointDataGrid::Ptr source = points_at(places());
    DeformFigures figures;
    const auto made = carried(*source, rest, posed, figures);
    EXPECT_EQ(figures.active_before, 500U);
    EXPECT_EQ(figures.active_after, 500U);
    EXPECT_EQ(figures.outside, 0.0);
    EXPECT_EQ(made->getName(), "particles");
    EXPECT_EQ(made->transform(), source->transform());
    // The pose is affine, and so is the map of each prism and tet.
    const std::size_t count =
        for_each_point(*made, [](const Vec3d& start, const Vec3d& now, const auto&, auto) {
            EXPECT_LT((now - turned_long(start)).length(), 2e-6);
        });
    EXPECT_EQ(count, 500U);
}

TEST(DeformPoints, StayInTheSamePose)
{
    openvdb::initialize();
    const ShellMap rest = ball(as_it_is).map();
    DeformFigures figures;
    const auto made = carried(*points_at(places()), rest, rest, figures);
    const std::size_t count =
        for_each_point(*made, [](const Vec3d& start, const Vec3d& now, const auto&, auto) {
            EXPECT_LT((now - start).length(), 1e-6 * kPointsVoxel);
        });
    EXPECT_EQ(count, 500U);
}

TEST(DeformPoints, TurnTheirVectorsAndKeepTheRest)
{
    openvdb::initialize();
    const ShellMap rest = ball(as_it_is).map(), posed = ball(turned_long).map();
    const PointDataGrid::Ptr source = points_at(places());
    test::append_attribute(source->tree(), "v", Vec3s(1, 0, 0));
    test::append_attribute(source->tree(), "N", Vec3s(0, 1, 0));
    test::append_attribute(source->tree(), "Cd", Vec3s(1, 0, 0));
    test::append_attribute(source->tree(), "id", std::int32_t(7));
    test::append_group(source->tree(), "sparks");
    DeformFigures figures;
    const auto made = carried(*source, rest, posed, figures);
    // x goes to y; y goes to -2 x, and so does the normal along it, which keeps its length.
    for_each_point(*made, [](const Vec3d&, const Vec3d&, const auto& leaf, openvdb::Index point) {
        EXPECT_LT((vector_at(leaf, "v", point) - Vec3s(0, 1, 0)).length(), 1e-4f);
        EXPECT_LT((vector_at(leaf, "N", point) - Vec3s(-1, 0, 0)).length(), 1e-4f);
        EXPECT_EQ(vector_at(leaf, "Cd", point), Vec3s(1, 0, 0));
        const openvdb::points::AttributeHandle<std::int32_t> id(leaf.constAttributeArray("id"));
        EXPECT_EQ(id.get(point), 7);
    });
    EXPECT_TRUE(made->tree().cbeginLeaf()->attributeSet().descriptor().hasGroup("sparks"));

    DeformOptions keep;
    keep.vectors = VectorRule::keep;
    const auto kept = carried(*source, rest, posed, figures, keep);
    for_each_point(*kept, [](const Vec3d&, const Vec3d&, const auto& leaf, openvdb::Index point) {
        EXPECT_EQ(vector_at(leaf, "v", point), Vec3s(1, 0, 0));
    });
}

TEST(DeformPoints, TakeTheShellsVelocity)
{
    openvdb::initialize();
    const Ball posed = ball(turned_long);
    const ShellMap velocity = test::velocity_of_turning(posed);
    DeformFigures figures;
    const auto made =
        carried(*points_at(places()), ball(as_it_is).map(), posed.map(), figures, {}, &velocity);
    const std::size_t count = for_each_point(
        *made, [&](const Vec3d&, const Vec3d& now, const auto& leaf, openvdb::Index point) {
            EXPECT_LT((Vec3d(vector_at(leaf, "v", point)) - turning(now)).length(), 1e-5);
        });
    EXPECT_EQ(count, 500U);
}

TEST(DeformPoints, LeaveOutWhatIsOutside)
{
    openvdb::initialize();
    const ShellMap rest = ball(as_it_is).map(), posed = ball(turned_long).map();
    std::vector<Vec3s> positions = places();
    positions.emplace_back(0.0f, 0.0f, 3.0f);
    DeformFigures figures;
    const auto made = carried(*points_at(positions), rest, posed, figures);
    EXPECT_EQ(figures.active_before, 501U);
    EXPECT_EQ(figures.active_after, 500U);
    EXPECT_NEAR(figures.outside, 1.0 / 501.0, 1e-12);
    EXPECT_EQ(for_each_point(*made, [](const auto&, const auto&, const auto&, auto) {}), 500U);
    for (int i = 0; i < 5; ++i)
        positions.emplace_back(0.0f, 3.0f, 0.1f * float(i));
    EXPECT_THROW(carried(*points_at(positions), rest, posed, figures), InvalidOption);
}

TEST(DeformPoints, AreTheSameForAnyNumberOfThreads)
{
    openvdb::initialize();
    const ShellMap rest = ball(as_it_is).map(), posed = ball(turned_long).map();
    const PointDataGrid::Ptr source = points_at(places());
    const auto bytes = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        DeformFigures figures;
        std::ostringstream out;
        const auto made = carried(*source, rest, posed, figures);
        made->writeTopology(out);
        for_each_point(*made, [&](const Vec3d& start, const Vec3d& now, const auto&, auto) {
            out.write(reinterpret_cast<const char*>(start.asPointer()), sizeof(Vec3d));
            out.write(reinterpret_cast<const char*>(now.asPointer()), sizeof(Vec3d));
        });
        return out.str();
    };
    EXPECT_EQ(bytes(1), bytes(2));
}

TEST(DeformPoints, RefuseWhatTheyCannotTake)
{
    openvdb::initialize();
    const ShellMap rest = ball(as_it_is).map();
    DeformFigures figures;
    EXPECT_THROW(carried(*openvdb::FloatGrid::create(), rest, rest, figures), InvalidOption);
    const PointDataGrid::Ptr none = test::point_grid({}, kPointsVoxel);
    EXPECT_THROW(carried(*none, rest, rest, figures), InvalidOption);
    const PointDataGrid::Ptr nameless = points_at(places());
    test::rename_attribute(nameless->tree(), "P", "Q");
    EXPECT_THROW(carried(*nameless, rest, rest, figures), InvalidOption);
    // Leaves that differ, as those of a damaged file may.
    const PointDataGrid::Ptr mixed = points_at(places());
    const PointDataGrid::Ptr other = points_at({Vec3s(0.5f, 0.5f, 0.5f) + Vec3s(4.0f)});
    test::append_attribute(other->tree(), "more", 1.0f);
    mixed->tree().addLeaf(other->tree().stealNode<PointDataGrid::TreeType::LeafNodeType>(
        other->tree().cbeginLeaf()->origin(), other->background(), false));
    EXPECT_THROW(carried(*mixed, rest, rest, figures), InvalidOption);
}

TEST(DeformPoints, CanBeCancelled)
{
    openvdb::initialize();
    const ShellMap rest = ball(as_it_is).map(), posed = ball(turned_long).map();
    const PointDataGrid::Ptr source = points_at(places());
    DeformFigures figures;
    test::expect_cancelled([&](Interrupter* interrupter) {
        deform_points(*source, rest, posed, Vec3d(0.0), {}, figures, nullptr, interrupter);
    });
}

} // namespace
} // namespace vdb_shell

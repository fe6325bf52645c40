// SPDX-License-Identifier: Apache-2.0
#include "core/simd.h"

#include "certify/points_in_planes.h"
#include "core/counter_random.h"
#include "core/fan.h"
#include "core/grid_instances.h"
#include "growth/barrier.h"
#include "growth/prism_lanes.h"
#include "growth/separation_lanes.h"
#include "mesh/eight_distances.h"
#include "support/shapes.h"
#include "vdb_shell/pipeline.h"
#include "vdb_shell/write/vdb_file.h"
#include "volume/depth_lines.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <vector>

#include <hwy/highway.h>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

/// What a kernel gives, to the last bit.
using Bytes = std::vector<unsigned char>;

template <class T> void append(Bytes& bytes, const T& value)
{
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* first = reinterpret_cast<const unsigned char*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
}

template <class T> void append_all(Bytes& bytes, const std::vector<T>& values)
{
    for (const T& value : values)
        append(bytes, value);
}

/// Until it goes, kernels run on this target alone.
class OnTarget
{
public:
    explicit OnTarget(std::int64_t target)
    {
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    }
    ~OnTarget()
    {
        hwy::SetSupportedTargetsForTest(0);
        hwy::GetChosenTarget().DeInit();
    }
};

/// The targets that this machine has and that kernels are compiled for, with the baseline.
std::set<std::int64_t> targets()
{
    const std::vector<std::int64_t> found = hwy::SupportedAndGeneratedTargets();
    std::set<std::int64_t> all(found.begin(), found.end());
    all.insert(HWY_STATIC_TARGET);
    return all;
}

/// Each target has to give the same bytes.
void expect_same_on_all_targets(const std::function<Bytes()>& run)
{
    const Bytes best = run();
    for (const std::int64_t target : targets()) {
        const OnTarget on(target);
        EXPECT_TRUE(run() == best) << hwy::TargetName(target);
    }
}

/// Numbers that kernels meet, and others: of all sizes, equal ones, zeros of both signs, denormals.
class Numbers
{
public:
    double next()
    {
        const double x = 2 * random_.unit(counter_++) - 1;
        switch (random_.below(counter_++, 12)) {
        case 0:
            return 0.0;
        case 1:
            return -0.0;
        case 2:
            return 1.0;
        case 3:
            return -0.5;
        case 4:
            return x * 1e-41; // denormal as a float
        case 5:
            return x * 1e6;
        default:
            return x;
        }
    }
    float next_float() { return static_cast<float>(next()); }
    Vec3d point() { return {double(next_float()), double(next_float()), double(next_float())}; }

private:
    CounterRandom random_{20};
    std::uint64_t counter_ = 0;
};

constexpr int kRounds = 500;

TEST(Simd, EachTargetRunsCodeOfItsOwn)
{
    std::set<std::size_t> places; // in the tables of kernels
    for (const std::int64_t target : targets()) {
        const OnTarget on(target);
        places.insert(hwy::GetChosenTarget().GetIndex());
    }
    EXPECT_EQ(places.size(), targets().size());
}

TEST(Simd, PointsInPlanesAreTheSameOnAllTargets)
{
    expect_same_on_all_targets([] {
        Numbers numbers;
        Bytes bytes;
        for (int round = 0; round < kRounds; ++round) {
            std::array<std::vector<float>, 3> points;
            for (auto& axis : points)
                for (std::size_t i = 0; i < 37 + kLanes; ++i)
                    axis.push_back(numbers.next_float());
            FloatPlanes planes;
            for (auto& normal : planes.outward)
                normal = {numbers.next_float(), numbers.next_float(), numbers.next_float()};
            for (float& most : planes.most)
                most = numbers.next_float();
            const std::array<PointRun, 3> runs{{{0, 5}, {5, 21}, {30, 37}}};
            std::array<std::uint32_t, 37> inside{};
            append(bytes, points_in_planes({points[0].data(), points[1].data(), points[2].data()},
                                           runs.data(), runs.size(), planes, inside.data()));
            append(bytes, inside);
        }
        return bytes;
    });
}

TEST(Simd, NearestTrianglesAreTheSameOnAllTargets)
{
    expect_same_on_all_targets([] {
        Numbers numbers;
        Bytes bytes;
        for (int round = 0; round < kRounds; ++round) {
            std::vector<PreparedTriangle> triangles;
            for (int i = 0; i < 6; ++i)
                triangles.push_back(
                    prepare_triangle({numbers.point(), numbers.point(), numbers.point()}));
            EightPoints points;
            for (auto* axis : {&points.x, &points.y, &points.z})
                for (float& x : *axis)
                    x = numbers.next_float();
            const std::array<std::uint32_t, 7> list{0, 3, 3, 1, 5, 4, 2};
            std::array<float, 7 * kLanes> squared{};
            EightNearest nearest;
            nearest_of(triangles.data(), list.data(), list.size(), points, squared.data(), nearest);
            std::array<std::uint8_t, 7> within{};
            list_within(squared.data(), list.size(), nearest.squared, within.data());
            append(bytes, squared), append(bytes, nearest), append(bytes, within);
        }
        return bytes;
    });
}

TEST(Simd, FansAreTheSameOnAllTargets)
{
    expect_same_on_all_targets([] {
        Numbers numbers;
        Bytes bytes;
        for (int round = 0; round < kRounds; ++round) {
            const std::size_t count = 3 + std::size_t(round) % (Fan::kMost - 2);
            std::vector<Vec3d> rim;
            for (std::size_t i = 0; i < count; ++i) {
                const double angle = 2 * M_PI * double(i) / double(count);
                rim.push_back(round % 2 == 0 ? numbers.point()
                                             : Vec3d(double(float(std::cos(angle))),
                                                     double(float(std::sin(angle))),
                                                     double(numbers.next_float())));
            }
            const Fan fan(numbers.point(), count,
                          [&](std::size_t i) -> const Vec3d& { return rim[i]; });
            append(bytes, fan.surely_embedded());
            for (std::size_t i = 0; i < count; ++i)
                append(bytes, fan.surely_apart_from(i));
        }
        return bytes;
    });
}

TEST(Simd, TetsOfPrismsAreTheSameOnAllTargets)
{
    expect_same_on_all_targets([] {
        Numbers numbers;
        Bytes bytes;
        for (int round = 0; round < kRounds; ++round) {
            const std::array<Vec3d, 5> c{numbers.point(), numbers.point(), numbers.point(),
                                         numbers.point(), numbers.point()};
            const Vec3d x = numbers.point(), at = numbers.point();
            const growth::PrismAround prism{c[0].asPointer(), c[1].asPointer(), c[2].asPointer(),
                                            c[3].asPointer(), c[4].asPointer()};
            append(bytes, growth::surely_positive(prism, x.asPointer()));
            const std::array<growth::CountedPrism, 2> prisms{{{prism, 1, 0}, {prism, 1, 1}}};
            std::array<growth::TetBounds, 4> bounds;
            append(bytes, growth::bound_tets(prisms.data(), 2, x.asPointer(), bounds.data()));
            append(bytes, bounds);
            append(bytes, growth::sum_shortfalls(bounds.data(), 4, 0.1, at.asPointer()));
        }
        return bytes;
    });
}

TEST(Simd, BarrierMinimaAreTheSameOnAllTargets)
{
    expect_same_on_all_targets([] {
        Numbers numbers;
        Bytes bytes;
        for (int round = 0; round < kRounds; ++round) {
            growth::LinearBounds bounds;
            const Vec3d here = numbers.point();
            bounds.clear(here, 0.3);
            for (int i = 0; i < 3; ++i)
                bounds.add_prism({numbers.point(), numbers.point(), numbers.point(),
                                  numbers.point(), numbers.point()});
            append(bytes, growth::barrier_minimum(bounds, {here, 2.0}, numbers.point(), 0.7));
            for (const growth::LinearBounds::Block& block : bounds.blocks())
                append(bytes, block.x), append(bytes, block.value), append(bytes, block.weight);
        }
        return bytes;
    });
}

TEST(Simd, SlabsBetweenTrianglesAreTheSameOnAllTargets)
{
    expect_same_on_all_targets([] {
        Numbers numbers;
        Bytes bytes;
        for (int round = 0; round < kRounds; ++round) {
            growth::PairLanes pairs{};
            for (std::size_t i = 1; i < pairs.corner.size(); ++i)
                for (auto& axis : pairs.corner[i].at)
                    for (double& x : axis)
                        x = double(numbers.next_float());
            pairs.enough.fill(0.25F);
            growth::PairEstimates estimates;
            growth::estimate_rooms(pairs, estimates);
            append(bytes, estimates.wide), append(bytes, estimates.close);
            append(bytes, estimates.edges), append(bytes, estimates.across_first);
            append(bytes, estimates.across_second), append(bytes, estimates.across_middles);
            growth::PointRow ways;
            growth::between_edges(
                {pairs.corner[0], pairs.corner[1], pairs.corner[3], pairs.corner[4]}, ways);
            append(bytes, ways);
            for (auto& axis : ways.at)
                for (double& x : axis)
                    x = numbers.next();
            growth::SlabLanes slabs;
            growth::slabs_across(pairs, ways, slabs);
            append(bytes, slabs.lo), append(bytes, slabs.hi), append(bytes, slabs.gap);
        }
        return bytes;
    });
}

TEST(Simd, DepthsAlongLinesAreTheSameOnAllTargets)
{
    expect_same_on_all_targets([] {
        Numbers numbers;
        Bytes bytes;
        for (int round = 0; round < kRounds; ++round) {
            TetLines lines;
            lines.floors = 2, lines.ceilings = 1, lines.sides = 1;
            for (auto* of : {&lines.floor, &lines.ceiling, &lines.side})
                for (TetLines::Affine& plane : *of)
                    plane = {numbers.next(), numbers.next(), numbers.next()};
            lines.slack = 1e-9, lines.low_z = -7, lines.high_z = 12;
            std::array<LineEnds, 8> ends;
            for (std::size_t i = 0; i < ends.size(); ++i)
                find_line_ends(lines, -3 + int(i), 2, ends[i]);
            append(bytes, ends);
            TetShadow shadow;
            for (TetShadow::Edge& edge : shadow.edge)
                edge = {numbers.next(), numbers.next(), numbers.next(), numbers.next()};
            for (TetShadow::Corner& corner : shadow.corner)
                corner = {numbers.next(), numbers.next()};
            shadow.slack = 0.25;
            Rows rows_met;
            find_rows(shadow, -3, rows_met);
            append(bytes, rows_met);
            std::array<float, 16> values{};
            const std::array<DepthRow, 2> rows{{{values.data(), numbers.next(), -8, 3, 8},
                                                {values.data() + 8, numbers.next(), 0, 0, 5}}};
            fill_depth_rows(rows.data(), rows.size(),
                            {numbers.next(), numbers.next(), 0.5, 0.0, 1.0});
            append(bytes, values);
        }
        return bytes;
    });
}

TEST(Simd, WholeShellsAreTheSameOnAllTargets)
{
    ShellOptions options;
    options.level_set.resolution = 48;
    options.coverage.samples = 5000;
    const TriangleMesh mesh = test::torus(1.0, 0.4, 24, 12);
    expect_same_on_all_targets([&] {
        const ShellResult shell = build_shell(mesh, options);
        Bytes bytes;
        append_all(bytes, shell.tets.points), append_all(bytes, shell.tets.tets);
        append(bytes, shell.report.coverage.in_none), append(bytes, shell.report.coverage.in_one);
        const auto depth = shell_depth_grid(shell.tets, 0.02);
        for (auto leaf = depth->tree().cbeginLeaf(); leaf; ++leaf)
            for (openvdb::Index i = 0; i < leaf->SIZE; ++i)
                append(bytes, leaf->getValue(i)), append(bytes, leaf->isValueOn(i));
        return bytes;
    });
}

} // namespace

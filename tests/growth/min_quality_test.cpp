// SPDX-License-Identifier: Apache-2.0
#include "growth/raise_quality.h"

#include "core/exact.h"
#include "support/stacks.h"
#include "vdb_shell/shell/quality.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

GrowOptions bounded(double min_quality, Method method = Method::certified)
{
    GrowOptions options = test::by_method(method);
    options.min_quality = min_quality;
    return options;
}

struct Below {
    std::size_t tets = 0;
    std::set<std::uint32_t> vertices; ///< whose inner points, or pinned points, such tets have
};

/// A tet whose prism has a pinned corner holds its point once, as an outer one: it counts as inner
/// when the tet has no other point of that pillar.
Below below(const GrowResult& result, double bound)
{
    Below found;
    const TetMesh tets = make_tets(result.shell, result.split);
    for (const openvdb::Vec4I& t : tets.tets) {
        const double ratio = mean_ratio(Vec3d(tets.points[t[0]]), Vec3d(tets.points[t[1]]),
                                        Vec3d(tets.points[t[2]]), Vec3d(tets.points[t[3]]));
        if (ratio >= bound)
            continue;
        ++found.tets;
        for (int i = 0; i < 4; ++i)
            if (tets.layer[t[i]] == 1)
                found.vertices.insert(tets.source_vertex[t[i]]);
    }
    return found;
}

void expect_certified(const GrowResult& result, const GrowOptions& options)
{
    test::expect_certified(one_layer(result.shell, result.split), prism_test_of(options));
}

TEST(MinQuality, LeavesFewerTetsUnderTheBoundAndCountsThem)
{
    for (GrowOptions options : test::ways_to_grow())
        for (const TriangleMesh& mesh : {test::bumpy_sphere(), test::trefoil(90, 8)}) {
            options.min_quality = 0;
            const GrowResult free = test::grown(mesh, options);
            EXPECT_EQ(free.report.quality_rounds, 0U);
            for (const double bound : {0.1, 0.2}) {
                options.min_quality = bound;
                const GrowResult held = test::grown(mesh, options);
                expect_certified(held, options);
                const Below before = below(free, bound), after = below(held, bound);
                EXPECT_GT(before.tets, 0U);
                EXPECT_LT(after.tets, before.tets) << bound;
                EXPECT_EQ(held.report.tets_below_quality, after.tets);
                EXPECT_EQ(held.report.vertices_below_quality, after.vertices.size());
                EXPECT_GT(held.report.quality_rounds, 0U);
            }
        }
}

TEST(MinQuality, NoBoundAndABoundThatHoldsChangeNoBit)
{
    const TriangleMesh mesh = test::torus(1.0, 0.3, 24, 12);
    const GrowResult free = test::grown(mesh, {}, 0.1);
    const double worst = measure_quality(make_tets(free.shell, free.split)).mean_ratio.min;
    ASSERT_GT(worst, 0.01);
    const GrowResult held = test::grown(mesh, bounded(0.9 * worst), 0.1);
    EXPECT_EQ(held.shell.inner, free.shell.inner);
    EXPECT_EQ(held.split.order, free.split.order);
    EXPECT_EQ(held.report.quality_rounds, 0U);
    EXPECT_EQ(held.report.tets_below_quality, 0U);
}

TEST(MinQuality, NeverExceedsTheThickness)
{
    const TriangleMesh mesh = test::bumpy_sphere();
    const GrowResult held = test::grown(mesh, bounded(0.4), 0.1);
    expect_certified(held, {});
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        EXPECT_FALSE(exact::longer_than(held.shell.outer[v], held.shell.inner[v], 0.1)) << v;
}

TEST(MinQuality, CountsPinnedVerticesWithoutInnerPoints)
{
    // Nothing can be done for a surface whose thickness is nothing: no tets, none below.
    const GrowResult held = test::grown(test::icosphere(1, 1), bounded(0.5), 0.0);
    EXPECT_EQ(make_tets(held.shell, held.split).tets.size(), 0U);
    EXPECT_EQ(held.report.tets_below_quality, 0U);
    EXPECT_EQ(held.report.vertices_below_quality, 0U);
}

TEST(MinQuality, SameBitsForAnyNumberOfThreads)
{
    const TriangleMesh mesh = test::trefoil(90, 8);
    const auto grown_with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return test::grown(mesh, bounded(0.2, Method::thickest));
    };
    const GrowResult one = grown_with(1), two = grown_with(2);
    EXPECT_EQ(one.shell.inner, two.shell.inner);
    EXPECT_EQ(one.split.order, two.split.order);
    EXPECT_EQ(one.report.tets_below_quality, two.report.tets_below_quality);
}

TEST(MinQuality, RefusesBadBoundsByName)
{
    const std::pair<double, std::string> refused[] = {
        {-0.1, "-0.1"}, {1.0, "1"}, {double(NAN), "nan"}, {double(INFINITY), "inf"}};
    for (const auto& [bound, text] : refused)
        EXPECT_EQ(test::refusal_of(
                      [&, bound = bound] { test::grown(test::icosphere(1, 1), bounded(bound)); }),
                  "growth: min_quality is " + text + ", must be 0 or more and less than 1");
}

} // namespace

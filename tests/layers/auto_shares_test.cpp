// SPDX-License-Identifier: Apache-2.0
#include "layers/auto_shares.h"

#include "support/broken_shells.h"
#include "support/shells.h"
#include "support/stacks.h"
#include "vdb_shell/layers/cut_layers.h"

#include <gtest/gtest.h>

#include <cmath>

// The number of layers that follows the size of the triangles.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;

LayerOptions automatic()
{
    LayerOptions options;
    options.layers = 0;
    return options;
}

double mean_edge(const TriangleMesh& mesh)
{
    double sum = 0;
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int i = 0; i < 3; ++i)
            sum += double((mesh.points[t[i]] - mesh.points[t[(i + 1) % 3]]).length());
    return sum / double(3 * mesh.triangles.size());
}

TEST(AutoShares, TheFirstLayerOfASphereIsAsHighAsARegularTet)
{
    const TriangleMesh sphere = test::icosphere(1, 3);
    const test::SplitShell made = test::scaled_shell(sphere, 0.2F);
    const auto shares = auto_shares(made.shell, false, 2);
    ASSERT_GE(shares.size(), 2U);
    const double height = std::sqrt(2.0 / 3) * mean_edge(sphere);
    for (const double share : shares[0])
        EXPECT_NEAR(share * 0.8, height, 0.15 * height);
    // Each further layer is twice as high.
    for (std::size_t v = 0; v < sphere.points.size(); ++v)
        if (shares[1][v] < 1) {
            EXPECT_NEAR(shares[1][v], 3 * shares[0][v], 1e-12);
        }
}

TEST(AutoShares, CoarserTrianglesHaveFewerLayers)
{
    std::size_t before = 0;
    for (const int subdivisions : {0, 2, 3, 4}) {
        const test::SplitShell made = test::scaled_shell(test::icosphere(1, subdivisions), 0.5F);
        const std::size_t cuts = auto_shares(made.shell, false, 2).size();
        EXPECT_GE(cuts, before);
        EXPECT_LT(cuts, std::size_t(kMostAutoLayers));
        before = cuts;
    }
    EXPECT_EQ(auto_shares(test::scaled_shell(test::icosphere(1, 0), 0.5F).shell, false, 2).size(),
              0U);
    EXPECT_GE(before, 2U);
}

TEST(AutoShares, ShortPillarsHaveFewerLayersThanLongOnesAndAllAreCertified)
{
    // The pillars of a torus get longer around it: layers end on the way.
    const TriangleMesh torus = test::torus(1, 0.4, 64, 24);
    const test::SplitShell made = test::with_split(test::torus_shell(torus, 1, [&](std::size_t v) {
        return 0.02 + 0.13 * (1 + double(torus.points[v][0]) / 1.4);
    }));
    const ShellStack whole = one_layer(made.shell, made.split);
    const LayerResult cut = cut_layers(whole, automatic(), PrismTest::twelve_tets);
    ASSERT_GE(cut.stack.layers.size(), 2U);
    EXPECT_EQ(cut.stack.surface(0), whole.surface(0));
    EXPECT_EQ(cut.stack.surface(cut.stack.layers.size()), whole.surface(1));
    std::size_t ended = 0;
    for (std::size_t v = 0; v < torus.points.size(); ++v)
        ended += cut.stack.layers.back().length(v) == 0;
    EXPECT_GT(ended, 0U);
    EXPECT_LT(ended, torus.points.size());
    test::expect_certified(cut.stack, PrismTest::twelve_tets);
    EXPECT_NEAR(tet_volume(make_tets(cut.stack)), tet_volume(make_tets(whole)),
                1e-9 * tet_volume(make_tets(whole)));
}

TEST(AutoShares, OnBothSidesAndOfGrownShells)
{
    const GrowResult grown = test::grown(test::bumpy_sphere());
    const LayerResult cut =
        cut_layers(one_layer(grown.shell, grown.split), automatic(), PrismTest::twelve_tets);
    test::expect_certified(cut.stack, PrismTest::twelve_tets);
    EXPECT_EQ(cut.stack.skin, 0U);
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/shell/tessellate.h"

#include "core/counter_random.h"
#include "support/shapes.h"
#include "support/shells.h"
#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/tet_signs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3I;
using openvdb::Vec3s;

constexpr std::array<SplitRule, 4> kRules{SplitRule::vertex_index, SplitRule::length_descending,
                                          SplitRule::length_ascending, SplitRule::ripple};

double volume_between(const PrismShell& shell)
{
    return signed_volume(shell.outer, shell.triangles) -
           signed_volume(shell.inner, shell.triangles);
}

void expect_sound(const PrismShell& shell, const TetMesh& tets)
{
    const Conformity conformity = check_conformity(shell, tets);
    EXPECT_EQ(conformity.crowded_faces.count, 0U);
    EXPECT_EQ(conformity.misoriented_faces.count, 0U);
    EXPECT_EQ(conformity.stray_faces.count, 0U);
    EXPECT_EQ(conformity.missing_triangles.count, 0U);
    // The boundary is the two surfaces, so the volumes have to add up whatever the diagonals.
    const double scale = signed_volume(shell.outer, shell.triangles);
    EXPECT_NEAR(tet_volume(tets), volume_between(shell), 1e-12 * scale);
    std::vector<int> used(tets.points.size(), 0);
    for (const openvdb::Vec4I& tet : tets.tets)
        for (int corner = 0; corner < 4; ++corner)
            used[tet[corner]] = 1;
    EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0) << "points without a tet";
    for (std::size_t p = 0; p < tets.points.size(); ++p)
        EXPECT_EQ(tets.points[p],
                  (tets.layer[p] ? shell.inner : shell.outer)[tets.source_vertex[p]]);
}

TetMesh tets_of(const PrismShell& shell, SplitRule rule, std::uint64_t seed = 1)
{
    return make_tets(shell, split_prisms(shell, {rule, seed}));
}

TEST(MakeTets, SplitsOnePrismPositivelyInEveryOrder)
{
    const PrismShell shell{{Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0)},
                           {Vec3s(0, 0, -1), Vec3s(1, 0, -2), Vec3s(0, 1, -3)},
                           {Vec3I(0, 1, 2)},
                           std::vector<StopReason>(3, StopReason::thickness)};
    std::array<std::uint8_t, 3> order{0, 1, 2};
    do {
        const TetMesh tets = make_tets(shell, {{order}, 0});
        ASSERT_EQ(tets.tets.size(), 3U);
        const TetSigns signs = count_tet_signs(tets);
        EXPECT_EQ(signs.inverted.count + signs.flat.count, 0U);
        EXPECT_DOUBLE_EQ(tet_volume(tets), 0.5 * (1 + 2 + 3) / 3);
        // Diagonals run from the outer point of the earlier corner to the inner of the later.
        for (const openvdb::Vec4I& tet : tets.tets)
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j) {
                    const bool diagonal = tets.layer[tet[i]] == 0 && tets.layer[tet[j]] == 1;
                    if (!diagonal)
                        continue;
                    const auto rank = [&](int k) {
                        return std::find(order.begin(), order.end(), tets.source_vertex[tet[k]]) -
                               order.begin();
                    };
                    EXPECT_LE(rank(i), rank(j));
                }
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(MakeTets, DropsExactlyTheTetsOfPinnedPillarsInEveryOrder)
{
    for (unsigned pins = 1; pins < 8; ++pins) {
        PrismShell shell{{Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0)},
                         {Vec3s(0, 0, -1), Vec3s(1, 0, -2), Vec3s(0, 1, -3)},
                         {Vec3I(0, 1, 2)},
                         std::vector<StopReason>(3, StopReason::thickness)};
        double lengths = 0;
        std::size_t pinned = 0;
        for (unsigned v = 0; v < 3; ++v) {
            if (pins >> v & 1U) {
                shell.inner[v] = shell.outer[v];
                ++pinned;
            }
            lengths += shell.length(v);
        }
        std::array<std::uint8_t, 3> order{0, 1, 2};
        do {
            const TetMesh tets = make_tets(shell, {{order}, 0});
            EXPECT_EQ(tets.tets.size(), 3 - pinned);
            EXPECT_EQ(tets.points.size(), pinned == 3 ? 0 : 6 - pinned);
            EXPECT_EQ(count_tet_signs(tets).inverted.count + count_tet_signs(tets).flat.count, 0U);
            EXPECT_NEAR(tet_volume(tets), 0.5 * lengths / 3, 1e-15);
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

TEST(MakeTets, FillsASphereShellWithPositiveTetsUnderEveryRule)
{
    const PrismShell shell =
        test::radial_shell(test::icosphere(2, 3), [](std::size_t) { return 1.25; });
    for (const SplitRule rule : kRules) {
        const TetMesh tets = tets_of(shell, rule);
        EXPECT_EQ(tets.tets.size(), 3 * shell.triangles.size());
        EXPECT_EQ(count_tet_signs(tets).inverted.count + count_tet_signs(tets).flat.count, 0U);
        expect_sound(shell, tets);
        for (std::size_t v = 0; v < shell.outer.size(); ++v)
            EXPECT_EQ(tets.source_vertex[v], v);
    }
}

TEST(MakeTets, ConformsWithRandomPins)
{
    const TriangleMesh torus = test::torus(3, 1, 24, 12);
    for (const double share : {0.1, 0.5, 0.9})
        for (std::uint64_t seed = 1; seed <= 3; ++seed)
            for (const SplitRule rule : kRules) {
                const CounterRandom random(seed);
                const PrismShell shell = test::torus_shell(torus, 3, [&](std::size_t v) {
                    return random.unit(2 * v) < share ? 0.0 : 0.1 + 0.5 * random.unit(2 * v + 1);
                });
                std::size_t pinned_corners = 0;
                std::set<int> pins_seen;
                for (const Vec3I& t : shell.triangles) {
                    int pins = 0;
                    for (int corner = 0; corner < 3; ++corner)
                        pins += shell.pinned(t[corner]);
                    pins_seen.insert(pins);
                    pinned_corners += static_cast<std::size_t>(pins);
                }
                if (share == 0.5) {
                    EXPECT_EQ(pins_seen.size(), 4U); // triangles with 0, 1, 2 and 3 pins
                }
                const TetMesh tets = tets_of(shell, rule, seed);
                EXPECT_EQ(tets.tets.size(), 3 * shell.triangles.size() - pinned_corners);
                expect_sound(shell, tets);
            }
}

TEST(MakeTets, IsEmptyWhenEverythingIsPinned)
{
    const PrismShell shell =
        test::radial_shell(test::box({-1, -1, -1}, {1, 1, 1}), [](std::size_t) { return 0.0; });
    const TetMesh tets = tets_of(shell, SplitRule::length_descending);
    EXPECT_TRUE(tets.tets.empty());
    EXPECT_TRUE(tets.points.empty());
    EXPECT_TRUE(check_conformity(shell, tets).conforming());
}

TEST(SplitPrisms, OrdersCornersByTheRulesKey)
{
    const CounterRandom random(3);
    const PrismShell shell =
        test::radial_shell(test::icosphere(1, 2), [&](std::size_t v) { // many ties
            return 0.1 + 0.1 * static_cast<double>(random.below(v, 3));
        });
    const PrismSplit descending = split_prisms(shell, {SplitRule::length_descending, 1});
    const PrismSplit ascending = split_prisms(shell, {SplitRule::length_ascending, 1});
    const PrismSplit index = split_prisms(shell, {SplitRule::vertex_index, 1});
    for (std::size_t t = 0; t < shell.triangles.size(); ++t)
        for (std::size_t i = 0; i + 1 < 3; ++i) {
            auto vertex = [&](const PrismSplit& split, std::size_t k) {
                return shell.triangles[t][split.order[t][k]];
            };
            auto length = [&](const PrismSplit& split, std::size_t k) {
                return shell.length(vertex(split, k));
            };
            EXPECT_LT(vertex(index, i), vertex(index, i + 1));
            EXPECT_GE(length(descending, i), length(descending, i + 1));
            EXPECT_LE(length(ascending, i), length(ascending, i + 1));
            if (length(descending, i) == length(descending, i + 1)) {
                EXPECT_LT(vertex(descending, i), vertex(descending, i + 1));
            }
        }
}

TEST(Ripple, IsConsistentOnSeveralComponentsForManySeeds)
{
    const TriangleMesh mesh =
        test::joined(test::icosphere(1, 3), test::translated(test::icosphere(1, 1), {5, 0, 0}));
    const PrismShell shell = test::shell_along(
        mesh,
        [](const openvdb::Vec3d& p) {
            return (openvdb::Vec3d(p[0] > 2.5 ? 5 : 0, 0, 0) - p).unit();
        },
        [](std::size_t) { return 0.4; });
    std::size_t ripples = 0;
    std::set<std::vector<std::array<std::uint8_t, 3>>> results;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        const PrismSplit split = split_prisms(shell, {SplitRule::ripple, seed});
        EXPECT_EQ(split.order, split_prisms(shell, {SplitRule::ripple, seed}).order);
        const TetMesh tets = make_tets(shell, split);
        EXPECT_TRUE(check_conformity(shell, tets).conforming()) << "seed " << seed;
        EXPECT_EQ(count_tet_signs(tets).inverted.count, 0U);
        EXPECT_LT(split.ripples, shell.triangles.size());
        ripples += split.ripples;
        results.insert(split.order);
    }
    EXPECT_EQ(results.size(), 50U);
    EXPECT_GT(ripples, 0U); // otherwise the rippling itself was never tried
}

TEST(Ripple, UsesAllSixCodesAboutEquallyOften)
{
    // Only a triangle with no fixed side is free; over many seeds of a lone triangle each of the
    // six orders should appear about 1000 times, give or take 4 standard deviations.
    const PrismShell shell{{Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0)},
                           {Vec3s(0, 0, -1), Vec3s(1, 0, -1), Vec3s(0, 1, -1)},
                           {Vec3I(0, 1, 2)},
                           std::vector<StopReason>(3, StopReason::thickness)};
    std::map<std::array<std::uint8_t, 3>, int> count;
    for (std::uint64_t seed = 0; seed < 6000; ++seed)
        ++count[split_prisms(shell, {SplitRule::ripple, seed}).order[0]];
    EXPECT_EQ(count.size(), 6U);
    for (const auto& [order, times] : count)
        EXPECT_NEAR(times, 1000, 4 * 29);
}

TEST(TetVolume, IsAsAccurateFarFromTheOrigin)
{
    // Coordinates that float32 holds exactly at both places.
    TetMesh mesh;
    for (const Vec3s& p : {Vec3s(0, 0, 0), Vec3s(4, 0, 0), Vec3s(0, 4, 0), Vec3s(0, 0, 4)})
        mesh.points.push_back(p + Vec3s(8388608, -8388608, 4194304));
    mesh.tets = {openvdb::Vec4I(0, 1, 2, 3)};
    EXPECT_DOUBLE_EQ(tet_volume(mesh), 64.0 / 6);
    EXPECT_EQ(tet_volume(TetMesh()), 0);
}

TEST(TetVolume, LeavesOutLayersFurtherOut)
{
    TetMesh mesh;
    mesh.points = {Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1), Vec3s(0, 0, -2)};
    mesh.tets = {openvdb::Vec4I(0, 1, 2, 3), openvdb::Vec4I(0, 2, 1, 4)};
    mesh.prism_layer = {0, 1};
    EXPECT_DOUBLE_EQ(tet_volume(mesh), 3.0 / 6);
    EXPECT_DOUBLE_EQ(tet_volume(mesh, 1), 2.0 / 6);
    EXPECT_EQ(tet_volume(mesh, 2), 0);
}

} // namespace

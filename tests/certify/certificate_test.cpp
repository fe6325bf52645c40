// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/certificate.h"

#include "support/broken_shells.h"
#include "support/certificates.h"
#include "support/files.h"
#include "support/stacks.h"
#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::icosphere;
using test::kinds;
using test::scaled_shell;
using test::SplitShell;
using Kinds = std::set<std::string>;

Certificate certify(const SplitShell& made, PrismTest test = PrismTest::twelve_tets)
{
    return certify_shell(made.shell, made.split, test);
}

void expect_certified(const SplitShell& made)
{
    for (const PrismTest test : {PrismTest::twelve_tets, PrismTest::chosen_tets}) {
        const Certificate found = certify(made, test);
        EXPECT_TRUE(found.certified());
        EXPECT_TRUE(found.locally_valid());
        EXPECT_EQ(found.failures(), std::vector<std::string>{});
        EXPECT_EQ(found.test, test);
    }
    const TetMesh tets = make_tets(made.shell, made.split);
    const TetSigns signs = count_tet_signs(tets);
    EXPECT_EQ(signs.inverted.count + signs.flat.count, 0U);
    EXPECT_TRUE(check_conformity(made.shell, tets).conforming());
}

TEST(Certificate, HoldsForSoundShells)
{
    expect_certified(scaled_shell(icosphere(1, 2), 0.1f));
    expect_certified(scaled_shell(test::box(Vec3d(-1), Vec3d(1)), 0.25f));
    const TriangleMesh torus = test::torus(1, 0.3, 24, 12);
    expect_certified(
        test::with_split(test::torus_shell(torus, 1, [](std::size_t) { return 0.2; })));
    expect_certified(test::plate_shell(0.25f, 0.5f));
}

TEST(Certificate, HoldsForCavitiesAndSeveralComponents)
{
    const SplitShell outer = scaled_shell(icosphere(1, 2), 0.75f);
    // The shell of a cavity lies around it.
    const SplitShell cavity = scaled_shell(test::reversed(icosphere(0.3, 2)), 1.5f);
    expect_certified(test::joined(outer, cavity));
    SplitShell beside = outer;
    for (auto* points : {&beside.shell.outer, &beside.shell.inner})
        for (Vec3s& p : *points)
            p[0] += 3;
    expect_certified(test::joined(test::joined(outer, cavity), beside));
    // A ball in the cavity of another.
    expect_certified(
        test::joined(test::joined(outer, cavity), scaled_shell(icosphere(0.2, 1), 0.5f)));
    // An outward shell: the surface turned round.
    expect_certified(scaled_shell(test::reversed(icosphere(1, 2)), 1.5f));
}

TEST(Certificate, HoldsFarFromTheOrigin)
{
    SplitShell made = scaled_shell(icosphere(1, 1), 0.5f);
    for (auto* points : {&made.shell.outer, &made.shell.inner})
        for (Vec3s& p : *points)
            p += Vec3s(1e4f, -2e4f, 3e4f);
    expect_certified(made);
}

SplitShell pinned_sphere(const std::set<std::size_t>& pinned)
{
    return test::with_split(test::radial_shell(
        icosphere(1, 2), [&](std::size_t v) { return pinned.count(v) ? 0.0 : 0.4; }));
}

TEST(Certificate, HoldsWithPinnedVertices)
{
    expect_certified(pinned_sphere({0}));
    const openvdb::Vec3I t = icosphere(1, 2).triangles[33];
    expect_certified(pinned_sphere({t[0], t[1]}));
    expect_certified(pinned_sphere({t[0], t[1], t[2]}));
    std::set<std::size_t> upper;
    const std::vector<Vec3s> points = icosphere(1, 2).points;
    for (std::size_t v = 0; v < points.size(); ++v)
        if (points[v][2] >= 0)
            upper.insert(v);
    expect_certified(pinned_sphere(upper));
}

TEST(Certificate, AsksNoDiagonalOfAnEdgeWithAPinnedEnd)
{
    const openvdb::Vec3I t = icosphere(1, 2).triangles[33];
    SplitShell made = pinned_sphere({t[0]});
    // The diagonals at corner 0 turn round: nothing hangs on them.
    std::vector<std::uint8_t> others;
    for (const std::uint8_t corner : made.split.order[33])
        if (corner != 0)
            others.push_back(corner);
    const bool was_first = made.split.order[33][0] == 0;
    made.split.order[33] = was_first ? std::array<std::uint8_t, 3>{others[0], others[1], 0}
                                     : std::array<std::uint8_t, 3>{0, others[0], others[1]};
    expect_certified(made);
}

TEST(Certificate, ThinnerShellsOfACertifiedOneAreCertified)
{
    SplitShell made = test::plate_shell(0.25f, 0.5f);
    for (Vec3s& p : made.shell.inner)
        p[0] += 0.0625f * p[2];
    ASSERT_TRUE(certify(made).certified());
    for (const float s : {0.75f, 0.5f, 0.25f, 0.125f}) {
        SplitShell thin = made;
        for (std::size_t v = 0; v < thin.shell.inner.size(); ++v)
            thin.shell.inner[v] =
                made.shell.outer[v] + (made.shell.inner[v] - made.shell.outer[v]) * s;
        EXPECT_TRUE(certify(thin).certified()) << s;
    }
}

TEST(Certificate, SeesTwistedPrisms)
{
    const SplitShell made = test::twisted_shell(1.2);
    const Certificate found = certify(made);
    EXPECT_EQ(kinds(found), Kinds{"bad_prisms"});
    EXPECT_FALSE(found.certified());
    EXPECT_FALSE(found.locally_valid());
    // The chosen tets of a prism are among the twelve: by the tets themselves.
    const TetMesh tets = make_tets(made.shell, made.split);
    const TetSigns signs = count_tet_signs(tets);
    std::set<std::uint32_t> prisms;
    for (const std::uint32_t tet : signs.inverted.first)
        prisms.insert(tets.prism[tet]);
    const Certificate chosen = certify(made, PrismTest::chosen_tets);
    ASSERT_FALSE(prisms.empty());
    EXPECT_EQ(chosen.bad_prisms.first.front(), *prisms.begin());
    EXPECT_LE(chosen.bad_prisms.count, found.bad_prisms.count);
}

TEST(Certificate, NamesThePrismsOfAnInvertedTet)
{
    // One inner vertex is lifted just over its own outer one's star: its tets turn over.
    SplitShell made = scaled_shell(icosphere(1, 2), 0.5f);
    const std::uint32_t v = 20;
    made.shell.inner[v] = made.shell.outer[v] * 1.5f;
    const Certificate found = certify(made);
    std::vector<std::uint32_t> around;
    for (std::uint32_t t = 0; t < made.shell.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            if (made.shell.triangles[t][k] == v)
                around.push_back(t);
    EXPECT_EQ(found.bad_prisms.count, around.size());
    EXPECT_EQ(found.bad_prisms.first, around);
}

TEST(Certificate, SeesFlatTetsToo)
{
    SplitShell made = scaled_shell(test::box(Vec3d(-1), Vec3d(1)), 0.5f);
    made.shell.inner[0] = made.shell.outer[0] + Vec3s(0.5f, 0, 0); // in the plane of two faces
    EXPECT_GT(certify(made).bad_prisms.count, 0U);
}

TEST(Certificate, TwelveTetsAskMoreThanTheChosenOnes)
{
    bool seen = false;
    for (double angle = 0.3; angle < 1.2 && !seen; angle += 0.02) {
        const SplitShell made = test::twisted_shell(angle);
        const std::size_t all = certify(made).bad_prisms.count;
        const std::size_t chosen = certify(made, PrismTest::chosen_tets).bad_prisms.count;
        EXPECT_LE(chosen, all);
        seen = chosen < all;
    }
    EXPECT_TRUE(seen);
}

TEST(Certificate, SeesAFoldOverAnEdge)
{
    const Certificate found = certify(test::folded_shell());
    EXPECT_EQ(kinds(found), Kinds{"inner_folds"});
    EXPECT_TRUE(found.locally_valid());
    const auto& first = found.inner_folds.first;
    EXPECT_NE(std::find(first.begin(), first.end(), TrianglePair{0, 3}), first.end());
    EXPECT_NE(found.failures().at(0).find(" 0-3"), std::string::npos) << found.failures().at(0);
}

TEST(Certificate, SeesInnerTrianglesWithoutArea)
{
    SplitShell made = scaled_shell(test::box(Vec3d(-1), Vec3d(1)), 0.5f);
    const openvdb::Vec3I t = made.shell.triangles[4];
    made.shell.inner[t[0]] = made.shell.inner[t[1]];
    const Certificate found = certify(made);
    const auto& first = found.inner_folds.first;
    EXPECT_NE(std::find(first.begin(), first.end(), TrianglePair{4, 4}), first.end());
}

TEST(Certificate, SeesLimbsThatOverlap)
{
    const SplitShell made = test::plate_shell(0.625f, 0.625f);
    const Certificate found = certify(made);
    EXPECT_EQ(kinds(found), Kinds{"inner_contacts"});
    for (const TrianglePair& pair : found.inner_contacts.first)
        EXPECT_LT(pair[0], pair[1]);
    // Touching is enough.
    EXPECT_EQ(kinds(certify(test::plate_shell(0.5f, 0.5f))), Kinds{"inner_contacts"});
    EXPECT_EQ(kinds(certify(test::plate_shell(0.5f, 0.4375f))), Kinds{});
}

TEST(Certificate, SeesTheInnerSurfaceThroughTheOuterOne)
{
    const SplitShell made = test::pierced_shell();
    const Certificate found = certify(made);
    EXPECT_EQ(kinds(found), Kinds{"inner_through_outer"});
    for (const TrianglePair& pair : found.inner_through_outer.first) {
        float inner_low = 1, outer_high = 0;
        for (int k = 0; k < 3; ++k) {
            inner_low = std::min(inner_low, made.shell.inner[made.shell.triangles[pair[0]][k]][2]);
            outer_high =
                std::max(outer_high, made.shell.outer[made.shell.triangles[pair[1]][k]][2]);
        }
        EXPECT_LT(inner_low, 0);
        EXPECT_EQ(outer_high, 0);
    }
}

TEST(Certificate, SeesAnInsideOutInnerSurface)
{
    const Certificate found = certify(test::inside_out_shell());
    EXPECT_EQ(kinds(found), (Kinds{"bad_prisms", "inside_out_components"}));
    EXPECT_EQ(found.inside_out_components.first, std::vector<std::uint32_t>{0});
    // The second of two components.
    SplitShell second = test::inside_out_shell();
    for (auto* points : {&second.shell.outer, &second.shell.inner})
        for (Vec3s& p : *points)
            p[1] += 5;
    const SplitShell first = scaled_shell(icosphere(1, 1), 0.5f);
    EXPECT_EQ(certify(test::joined(first, second)).inside_out_components.first,
              std::vector<std::uint32_t>{80});
}

TEST(Certificate, AVolumeOfZeroIsNoOrientation)
{
    // All inner vertices in one plane.
    const SplitShell made = test::moved_shell(
        icosphere(1, 1), [](const Vec3s& p) { return Vec3s(0.5f * p[0], 0.5f * p[1], 0); });
    EXPECT_EQ(certify(made).inside_out_components.count, 1U);
}

TEST(Certificate, SeesDiagonalsThatDisagree)
{
    const SplitShell made = test::disagreeing_shell(5);
    const Certificate found = certify(made);
    EXPECT_EQ(kinds(found), Kinds{"non_conforming_edges"});
    const openvdb::Vec3I& t = made.shell.triangles[5];
    const auto& order = made.split.order[5];
    const auto [low, high] = std::minmax({t[order[0]], t[order[1]]});
    EXPECT_EQ(found.non_conforming_edges.first, (std::vector<Edge>{{low, high}}));
    EXPECT_FALSE(found.locally_valid());
    EXPECT_FALSE(check_conformity(made.shell, make_tets(made.shell, made.split)).conforming());
}

TEST(Certificate, SeesOrdersThatAreNone)
{
    SplitShell made = scaled_shell(icosphere(1, 1), 0.5f);
    made.split.order[7] = {0, 2, 0};
    made.split.order[9] = {0, 1, 3};
    for (const PrismTest test : {PrismTest::twelve_tets, PrismTest::chosen_tets}) {
        const Certificate found = certify(made, test);
        EXPECT_EQ(kinds(found), Kinds{"cyclic_prisms"});
        EXPECT_EQ(found.cyclic_prisms.first, (std::vector<std::uint32_t>{7, 9}));
    }
}

TEST(Certificate, SeesAnOpenSurface)
{
    const Certificate found = certify(test::open_shell());
    EXPECT_EQ(kinds(found), Kinds{"open_edges"});
    EXPECT_EQ(found.open_edges.count, 3U);
    const openvdb::Vec3I hole = icosphere(1, 1).triangles[7];
    for (const Edge& edge : found.open_edges.first)
        for (const std::uint32_t end : edge)
            EXPECT_TRUE(end == hole[0] || end == hole[1] || end == hole[2]);
    EXPECT_FALSE(found.locally_valid());
}

TEST(Certificate, SeesATriangleTurnedRound)
{
    SplitShell made = scaled_shell(icosphere(1, 1), 0.5f);
    std::swap(made.shell.triangles[3][0], made.shell.triangles[3][1]);
    const Certificate found = certify(made);
    EXPECT_EQ(found.open_edges.count, 3U);
    EXPECT_EQ(found.bad_prisms.first, std::vector<std::uint32_t>{3});
}

TEST(Certificate, SeesTwoFansAtAVertex)
{
    // Two tetrahedra hang together by a corner, which is pinned.
    TriangleMesh mesh = test::unit_tetrahedron();
    for (int axis = 0; axis < 3; ++axis)
        mesh.points.push_back(-mesh.points[1 + std::size_t(axis)]);
    for (const openvdb::Vec3I t : test::unit_tetrahedron().triangles) {
        auto mirrored = [](std::uint32_t v) { return v == 0 ? 0 : v + 3; };
        mesh.triangles.emplace_back(mirrored(t[0]), mirrored(t[2]), mirrored(t[1]));
    }
    const SplitShell made = test::moved_shell(mesh, [](const Vec3s& p) {
        const float side = p[0] + p[1] + p[2];
        return p + Vec3s(side / 4 - p[0] / 2, side / 4 - p[1] / 2, side / 4 - p[2] / 2) * 0.5f;
    });
    const Certificate found = certify(made);
    EXPECT_EQ(kinds(found).count("split_vertices"), 1U);
    EXPECT_EQ(found.split_vertices.first, std::vector<std::uint32_t>{0});
    EXPECT_EQ(found.open_edges.count, 0U);
}

TEST(Certificate, SeesASurfaceThatCrossesItself)
{
    const Certificate found = certify(test::crossing_shell());
    EXPECT_EQ(kinds(found), Kinds{"outer_contacts"});
    EXPECT_TRUE(found.locally_valid());
    for (const TrianglePair& pair : found.outer_contacts.first) {
        EXPECT_LT(pair[0], 12U);
        EXPECT_GE(pair[1], 12U);
    }
}

TEST(Certificate, SeesAComponentInsideAnothersShell)
{
    const Certificate found = certify(test::swallowed_shell());
    EXPECT_EQ(kinds(found), Kinds{"nested_wrongly"});
    EXPECT_EQ(found.nested_wrongly.first, (std::vector<TrianglePair>{{0, 320}}));
}

TEST(Certificate, SeesAnInnerSurfaceThatSwallowsAnother)
{
    // The shell of the cavity reaches beyond the inner surface of the ball, but not to the surface.
    const SplitShell ball = scaled_shell(icosphere(1, 2), 0.5f);
    const SplitShell near = scaled_shell(test::reversed(icosphere(0.25, 2)), 3.0f);
    EXPECT_EQ(kinds(certify(test::joined(ball, near))), Kinds{"nested_wrongly"});
    // Even beyond the surface.
    const SplitShell far = scaled_shell(test::reversed(icosphere(0.25, 2)), 8.0f);
    EXPECT_EQ(kinds(certify(test::joined(ball, far))), Kinds{"nested_wrongly"});
    EXPECT_EQ(kinds(certify(test::joined(far, ball))), Kinds{"nested_wrongly"});
}

TEST(Certificate, SameFindingsForAnyNumberOfThreads)
{
    const SplitShell made = test::plate_shell(0.7f, 0.65f);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const std::vector<std::string> alone = certify(made).failures();
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    EXPECT_EQ(certify(made).failures(), alone);
    EXPECT_FALSE(alone.empty());
}

TEST(Certificate, CanBeCancelled)
{
    const SplitShell made = scaled_shell(icosphere(1, 1), 0.5f);
    test::StopAtOnce interrupter;
    EXPECT_THROW(certify_shell(made.shell, made.split, PrismTest::twelve_tets, &interrupter),
                 Cancelled);
}

} // namespace

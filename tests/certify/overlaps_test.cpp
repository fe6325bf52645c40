// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/overlaps.h"

#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/shell/tessellate.h"

#include "core/exact.h"
#include "support/broken_shells.h"
#include "support/cancelled.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using openvdb::Vec4I;
using test::SplitShell;
using Tet = exact::Tet;

const Tet kUnit{Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1)};

Tet moved(Tet tet, const Vec3s& by)
{
    for (Vec3s& p : tet)
        p += by;
    return tet;
}

/// Asked both ways round: the answer cannot depend on the order.
bool overlap(const Tet& first, const Tet& second)
{
    const bool found = exact::tets_overlap(first, second);
    EXPECT_EQ(found, exact::tets_overlap(second, first));
    return found;
}

TEST(TetsOverlap, NotAcrossACommonFaceEdgeOrCorner)
{
    EXPECT_FALSE(overlap(kUnit, {kUnit[1], kUnit[2], kUnit[3], Vec3s(1, 1, 1)}));
    EXPECT_FALSE(overlap(kUnit, {kUnit[0], kUnit[1], Vec3s(0, -1, 0), Vec3s(0, 0, -1)}));
    EXPECT_FALSE(overlap(kUnit, {kUnit[0], Vec3s(-1, 0, 0), Vec3s(0, -1, 0), Vec3s(0, 0, -1)}));
}

TEST(TetsOverlap, OverACommonFaceEdgeOrCorner)
{
    EXPECT_TRUE(overlap(kUnit, {kUnit[1], kUnit[2], kUnit[3], Vec3s(-1, -1, -1)}));
    EXPECT_TRUE(overlap(kUnit, {kUnit[0], kUnit[1], Vec3s(0, 2, 1), Vec3s(0, 1, 2)}));
    EXPECT_TRUE(overlap(kUnit, {kUnit[0], Vec3s(2, 1, 1), Vec3s(1, 2, 1), Vec3s(1, 1, 2)}));
    EXPECT_TRUE(overlap(kUnit, kUnit));
}

TEST(TetsOverlap, NotWhereTheyTouchFromOutside)
{
    // A corner in the middle of an edge, on a corner of other index, and on a face.
    EXPECT_FALSE(overlap(kUnit, moved(kUnit, Vec3s(1, 0, 0))));
    EXPECT_FALSE(overlap(kUnit, moved(kUnit, Vec3s(0.5f, 0.5f, 0))));
    EXPECT_FALSE(overlap(kUnit, moved(kUnit, Vec3s(0.25f, 0.25f, 0.5f))));
    // Face on face, edge across edge.
    EXPECT_FALSE(overlap(kUnit, {Vec3s(0, 0, 0), Vec3s(2, 0, 0), Vec3s(0, 3, 0), Vec3s(1, 1, -1)}));
    EXPECT_FALSE(
        overlap(kUnit, {Vec3s(0.5f, 0, 1), Vec3s(0.5f, 0, -1), Vec3s(2, -1, 0), Vec3s(-1, -1, 0)}));
}

TEST(TetsOverlap, IsExactWhereOneFloatStepDecides)
{
    const float step = std::numeric_limits<float>::epsilon() / 2; // that of numbers below 1
    EXPECT_FALSE(overlap(kUnit, moved(kUnit, Vec3s(0.5f, 0.25f, 0.25f))));
    Tet nearer = moved(kUnit, Vec3s(0.5f, 0.25f, 0.25f));
    nearer[0][0] = 0.5f - step;
    EXPECT_TRUE(overlap(kUnit, nearer));
}

TEST(TetsOverlap, OneInsideTheOtherAndEdgeThroughEdge)
{
    EXPECT_TRUE(overlap(kUnit, {Vec3s(0.1f), Vec3s(0.2f, 0.1f, 0.1f), Vec3s(0.1f, 0.2f, 0.1f),
                                Vec3s(0.1f, 0.1f, 0.2f)}));
    // Two wedges, edge through edge; no corner of either lies in the other.
    const Tet along_x{Vec3s(-2, 0, 0.25f), Vec3s(2, 0, 0.25f), Vec3s(0, -1, -3), Vec3s(0, 1, -3)};
    const Tet along_y{Vec3s(0, -2, 0), Vec3s(0, 2, 0), Vec3s(-1, 0, 3), Vec3s(1, 0, 3)};
    EXPECT_TRUE(overlap(along_x, along_y));
    EXPECT_FALSE(overlap(moved(along_x, Vec3s(0, 0, -0.25f)), along_y));
}

double volume6(const std::array<Vec3d, 4>& t)
{
    return std::abs((t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0]));
}

/// The part of the tet where n.x > c, as tets.
void clip(const std::array<Vec3d, 4>& tet, const Vec3d& n, double c,
          std::vector<std::array<Vec3d, 4>>& parts)
{
    std::vector<Vec3d> in, out;
    for (const Vec3d& p : tet)
        (n.dot(p) > c ? in : out).push_back(p);
    const auto cut = [&](const Vec3d& p, const Vec3d& q) {
        const double at = (c - n.dot(p)) / (n.dot(q) - n.dot(p));
        return Vec3d(p + at * (q - p));
    };
    const auto wedge = [&](const std::array<Vec3d, 3>& a, const std::array<Vec3d, 3>& b) {
        parts.push_back({a[0], a[1], a[2], b[2]});
        parts.push_back({a[0], a[1], b[1], b[2]});
        parts.push_back({a[0], b[0], b[1], b[2]});
    };
    if (in.size() == 4)
        parts.push_back(tet);
    if (in.size() == 1)
        parts.push_back({in[0], cut(in[0], out[0]), cut(in[0], out[1]), cut(in[0], out[2])});
    if (in.size() == 2)
        wedge({in[0], cut(in[0], out[0]), cut(in[0], out[1])},
              {in[1], cut(in[1], out[0]), cut(in[1], out[1])});
    if (in.size() == 3)
        wedge({in[0], in[1], in[2]}, {cut(in[0], out[0]), cut(in[1], out[0]), cut(in[2], out[0])});
}

/// Volume of the common part of two tets, by clipping one with the faces of the other.
double common_volume(const Tet& first, const Tet& second)
{
    std::vector<std::array<Vec3d, 4>> parts{
        {Vec3d(first[0]), Vec3d(first[1]), Vec3d(first[2]), Vec3d(first[3])}};
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3d a(second[(k + 1) % 4]), b(second[(k + 2) % 4]), c(second[(k + 3) % 4]);
        Vec3d n = (b - a).cross(c - a);
        if (n.dot(Vec3d(second[k]) - a) < 0)
            n = -n;
        std::vector<std::array<Vec3d, 4>> rest;
        for (const auto& part : parts)
            clip(part, n, n.dot(a), rest);
        parts = rest;
    }
    double sum = 0;
    for (const auto& part : parts)
        sum += volume6(part) / 6;
    return sum;
}

TEST(TetsOverlap, AgreesWithTheVolumeOfTheCommonPart)
{
    // On so coarse a grid most pairs are in special position, and common parts are empty or large.
    std::mt19937 random(1);
    const auto corner = [&] {
        return Vec3s(float(random() % 4), float(random() % 4), float(random() % 4));
    };
    int overlapping = 0, apart = 0;
    while (overlapping + apart < 20000) {
        const Tet first{corner(), corner(), corner(), corner()};
        const Tet second{corner(), corner(), corner(), corner()};
        if (exact::orient3d(first[0], first[1], first[2], first[3]) == 0 ||
            exact::orient3d(second[0], second[1], second[2], second[3]) == 0)
            continue;
        const double common = common_volume(first, second);
        ASSERT_TRUE(common < 1e-12 || common > 1e-7) << common;
        ASSERT_EQ(overlap(first, second), common > 1e-9) << common;
        ++(common > 1e-9 ? overlapping : apart);
    }
    EXPECT_GT(overlapping, 4000);
    EXPECT_GT(apart, 4000);
}

TetMesh tets_of(const SplitShell& made)
{
    return make_tets(made.shell, made.split);
}

TEST(Overlaps, NoneInACleanSphere)
{
    const TetMesh tets = tets_of(test::scaled_shell(test::icosphere(1, 2), 0.5f));
    const Overlaps found = find_overlaps(tets);
    EXPECT_TRUE(found.none());
    EXPECT_EQ(found.pairs.count, 0U);
    EXPECT_EQ(found.tets, 960U);
    EXPECT_EQ(found.certified_tets(), 960U);
    EXPECT_EQ(found.prisms, 320U);
    EXPECT_EQ(found.certified_prisms(), 320U);
    EXPECT_EQ(found.certified, std::vector<std::uint8_t>(960, 1));
    EXPECT_DOUBLE_EQ(found.certified_volume, tet_volume(tets));
}

TEST(Overlaps, NamesTheOnePairThatOverlaps)
{
    // Moving a corner would move a whole fan: a small tet of its own, inside another, does it
    // alone.
    TetMesh tets = tets_of(test::scaled_shell(test::icosphere(1, 1), 0.5f));
    const auto base = static_cast<std::uint32_t>(tets.points.size());
    const exact::Tet seat{tets.points[tets.tets[100][0]], tets.points[tets.tets[100][1]],
                          tets.points[tets.tets[100][2]], tets.points[tets.tets[100][3]]};
    const Vec3s middle = (seat[0] + seat[1] + seat[2] + seat[3]) * 0.25f;
    for (const Vec3s& p : kUnit)
        tets.points.push_back(middle + p * 0.001f);
    tets.tets.emplace_back(base, base + 1, base + 2, base + 3);
    tets.prism.push_back(80);
    tets.prism_layer.push_back(0);
    const Overlaps found = find_overlaps(tets);
    EXPECT_EQ(found.pairs.count, 1U);
    EXPECT_EQ(found.pairs.first, (std::vector<TetPair>{{100, 240}}));
    EXPECT_EQ(found.uncertified.first, (std::vector<std::uint32_t>{100, 240}));
    EXPECT_EQ(found.prisms, 81U);
    EXPECT_EQ(found.uncertified_prisms.first, (std::vector<PrismIndex>{{33, 0}, {80, 0}}));
    EXPECT_EQ(found.certified[100], 0);
    EXPECT_EQ(found.certified[101], 1);
}

TEST(Overlaps, CrossingBoxesFailOnlyWhereTheyCross)
{
    const SplitShell made = test::crossing_shell();
    const TetMesh tets = tets_of(made);
    // All pillars but those of the far corners are pinned: the shells keep clear of each other,
    // though the boxes cross.
    ASSERT_FALSE(certify_shell(made.shell, made.split, PrismTest::chosen_tets).certified());
    EXPECT_TRUE(find_overlaps(tets).none());

    // Pillars of the full length overlap in the corner of 0.1, and nowhere else.
    const SplitShell first =
        test::moved_shell(test::box(Vec3d(0.0), Vec3d(1.0)),
                          [](const Vec3s& p) { return Vec3s(p * 0.5f + Vec3s(0.25f)); });
    const SplitShell second =
        test::moved_shell(test::box(Vec3d(0.9), Vec3d(1.9)),
                          [](const Vec3s& p) { return Vec3s(p * 0.5f + Vec3s(0.7f)); });
    const TetMesh both = tets_of(test::joined(first, second));
    const Overlaps found = find_overlaps(both);
    EXPECT_GT(found.pairs.count, 0U);
    for (std::size_t t = 0; t < both.tets.size(); ++t) {
        bool reaches = false; // with a corner as near to the common part as a tet of it must be
        for (int k = 0; k < 4; ++k) {
            const Vec3s& p = both.points[both.tets[t][k]];
            reaches = reaches || p == (t < both.tets.size() / 2 ? Vec3s(1.0f) : Vec3s(0.9f));
        }
        EXPECT_TRUE(reaches || found.certified[t]) << t;
    }
    for (const TetPair& pair : found.pairs.first) {
        EXPECT_LT(pair[0], both.tets.size() / 2);
        EXPECT_GE(pair[1], both.tets.size() / 2);
    }
}

TEST(Overlaps, InvertedAndFlatTetsAreNotCertified)
{
    TetMesh tets;
    tets.points = {
        Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1), Vec3s(0.25f, 0.25f, 0.25f),
        Vec3s(5, 5, 5)};
    // A positive one, its mirror image, a flat one right through it, and one that is far away.
    tets.tets = {Vec4I(0, 1, 2, 3), Vec4I(0, 2, 1, 4), Vec4I(1, 2, 4, 1), Vec4I(5, 1, 2, 3)};
    tets.prism = {0, 1, 2, 3};
    const Overlaps found = find_overlaps(tets);
    EXPECT_EQ(found.pairs.first, (std::vector<TetPair>{{0, 1}}));
    EXPECT_EQ(found.certified[0], 0);
    EXPECT_EQ(found.certified[1], 0);
    EXPECT_EQ(found.certified[2], 0);
    EXPECT_EQ(found.certified[3],
              exact::orient3d(tets.points[5], tets.points[1], tets.points[2], tets.points[3]) > 0);
}

TEST(Overlaps, ATorusThroughItselfFailsNearTheCrossingOnly)
{
    // A tube whose centre line is a figure of eight, so that it crosses itself at the origin alone.
    const TriangleMesh ring = test::torus(1, 0.15, 96, 12);
    TriangleMesh eight = ring;
    const auto centre = [](double t) { return Vec3d(std::sin(t), 0.5 * std::sin(2 * t), 0); };
    for (std::size_t v = 0; v < ring.points.size(); ++v) {
        const Vec3d p(ring.points[v]);
        const double t = std::atan2(p[1], p[0]);
        const Vec3d tangent = Vec3d(std::cos(t), std::cos(2 * t), 0).unit();
        const double out = std::hypot(p[0], p[1]) - 1;
        eight.points[v] =
            Vec3s(centre(t) + out * Vec3d(tangent[1], -tangent[0], 0) + Vec3d(0, 0, p[2]));
    }
    const auto shell_end = [&](std::size_t v) {
        const Vec3d p(ring.points[v]);
        return 0.5 * (Vec3d(eight.points[v]) + centre(std::atan2(p[1], p[0])));
    };
    PrismShell shell{eight.points, eight.points, eight.triangles,
                     std::vector<StopReason>(eight.points.size(), StopReason::thickness)};
    for (std::size_t v = 0; v < shell.inner.size(); ++v)
        shell.inner[v] = Vec3s(shell_end(v));
    const TetMesh tets = tets_of(test::with_split(shell));
    ASSERT_EQ(count_tet_signs(tets).inverted.count, 0U);
    const Overlaps found = find_overlaps(tets);
    EXPECT_GT(found.pairs.count, 100U);
    double farthest = 0;
    for (std::size_t t = 0; t < tets.tets.size(); ++t)
        for (int k = 0; k < 4 && !found.certified[t]; ++k)
            farthest = std::max(farthest, double(tets.points[tets.tets[t][k]].length()));
    // The arms cross at a right angle or nearly so: the common part ends within two radii.
    EXPECT_LT(farthest, 0.4);
    EXPECT_GT(double(found.certified_prisms()), 0.8 * double(found.prisms));
}

TEST(Overlaps, LayersNameTheirPrismsApart)
{
    TetMesh tets;
    tets.points.assign(kUnit.begin(), kUnit.end());
    tets.tets = {Vec4I(0, 1, 2, 3), Vec4I(0, 1, 2, 3)};
    tets.prism = {7, 7};
    tets.prism_layer = {0, 1};
    const Overlaps found = find_overlaps(tets);
    EXPECT_EQ(found.prisms, 2U);
    EXPECT_EQ(found.uncertified_prisms.first, (std::vector<PrismIndex>{{7, 0}, {7, 1}}));
}

TEST(Overlaps, SameForAnyNumberOfThreads)
{
    SplitShell made = test::scaled_shell(test::icosphere(1, 3), 0.5f);
    std::mt19937 random(3);
    for (Vec3s& p : made.shell.inner)
        for (int k = 0; k < 3; ++k)
            p[k] += float(random() % 100) * 0.002f;
    const TetMesh tets = tets_of(made);
    const Overlaps first = find_overlaps(tets);
    ASSERT_GT(first.pairs.count, 100U);
    for (const std::size_t threads : {1, 2, 7}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        const Overlaps again = find_overlaps(tets);
        EXPECT_EQ(again.certified, first.certified);
        EXPECT_EQ(again.pairs.count, first.pairs.count);
        EXPECT_EQ(again.pairs.first, first.pairs.first);
    }
}

TEST(Overlaps, CanBeCancelled)
{
    const TetMesh tets = tets_of(test::scaled_shell(test::icosphere(1, 2), 0.5f));
    test::expect_cancelled([&](Interrupter* interrupter) { find_overlaps(tets, interrupter); });
}

} // namespace

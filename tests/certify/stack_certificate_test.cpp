// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/stack_certificate.h"

#include "support/broken_shells.h"
#include "support/certificates.h"
#include "support/stacks.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::icosphere;
using test::kinds;
using test::SplitShell;
using Kinds = std::set<std::string>;
using Lines = std::vector<std::string>;

/// Layers between surfaces of the same triangles.
ShellStack stack_between(const std::vector<std::vector<Vec3s>>& surfaces,
                         const std::vector<openvdb::Vec3I>& triangles)
{
    ShellStack stack;
    for (std::size_t k = 0; k + 1 < surfaces.size(); ++k) {
        PrismShell layer{surfaces[k], surfaces[k + 1], triangles, {}};
        layer.stop.assign(surfaces[k].size(), StopReason::thickness);
        SplitShell made = test::with_split(std::move(layer));
        stack.layers.push_back(std::move(made.shell));
        stack.splits.push_back(std::move(made.split));
    }
    return stack;
}

std::vector<Vec3s> scaled(std::vector<Vec3s> points, float factor, const Vec3s& centre = Vec3s(0))
{
    for (Vec3s& p : points)
        p = centre + factor * p;
    return points;
}

/// Concentric layers, whose surfaces have the given radii.
ShellStack concentric(const TriangleMesh& mesh, const std::vector<float>& radii,
                      const Vec3s& centre = Vec3s(0))
{
    std::vector<std::vector<Vec3s>> surfaces;
    for (const float radius : radii)
        surfaces.push_back(scaled(mesh.points, radius, centre));
    return stack_between(surfaces, mesh.triangles);
}

ShellStack joined(const ShellStack& first, const ShellStack& second)
{
    ShellStack both;
    for (std::size_t k = 0; k < first.layers.size(); ++k) {
        SplitShell layer = test::joined(SplitShell{first.layers[k], first.splits[k]},
                                        SplitShell{second.layers[k], second.splits[k]});
        both.layers.push_back(std::move(layer.shell));
        both.splits.push_back(std::move(layer.split));
    }
    return both;
}

StackCertificate certify(const ShellStack& stack)
{
    return certify_stack(stack, PrismTest::twelve_tets);
}

/// Only the layer named fails.
void expect_fails_in(const StackCertificate& found, std::size_t layer, const Kinds& wanted)
{
    EXPECT_FALSE(found.certified());
    for (std::size_t k = 0; k < found.layers.size(); ++k)
        EXPECT_EQ(kinds(found.layers[k]), k == layer ? wanted : Kinds{}) << "layer " << k;
    const Lines lines = found.failures();
    EXPECT_EQ(lines.size(), wanted.size());
    for (const std::string& line : lines) {
        const std::string where = "layer " + std::to_string(layer) + ": ";
        EXPECT_EQ(line.substr(0, where.size()), where);
        EXPECT_TRUE(wanted.count(
            line.substr(where.size(), line.find_first_of(": ", where.size()) - where.size())))
            << line;
    }
}

TEST(StackCertificate, OneLayerGivesThatLayersCertificate)
{
    for (const SplitShell& made : {test::scaled_shell(icosphere(1, 1), 0.5f),
                                   test::inside_out_shell(), test::swallowed_shell()}) {
        const Certificate alone = certify_shell(made.shell, made.split, PrismTest::twelve_tets);
        const StackCertificate found = certify(one_layer(made.shell, made.split));
        EXPECT_EQ(found.certified(), alone.certified());
        EXPECT_EQ(found.locally_valid(), alone.locally_valid());
        EXPECT_EQ(found.failures(), alone.failures());
        EXPECT_EQ(found.hull_contacts.count + found.hull_nested_wrongly.count, 0U);
    }
}

TEST(StackCertificate, HoldsForSoundStacks)
{
    test::expect_certified(concentric(icosphere(1, 1), {1, 0.9f, 0.5f, 0.25f}),
                           PrismTest::twelve_tets);
    // A cavity, and a ball beside them all.
    const ShellStack ball = concentric(icosphere(1, 2), {1, 0.9f, 0.75f});
    const ShellStack cavity = concentric(test::reversed(icosphere(1, 2)), {0.3f, 0.4f, 0.6f});
    const ShellStack beside = concentric(icosphere(1, 1), {1, 0.5f, 0.25f}, Vec3s(3, 0, 0));
    test::expect_certified(joined(joined(ball, cavity), beside), PrismTest::twelve_tets);
    // A ball within the hollow of another.
    test::expect_certified(joined(ball, concentric(icosphere(1, 1), {0.5f, 0.4f, 0.3f})),
                           PrismTest::twelve_tets);
}

/// Points between the two of each pair, or beyond the second.
std::vector<Vec3s> along(const std::vector<Vec3s>& from, const std::vector<Vec3s>& to, float share)
{
    std::vector<Vec3s> points = from;
    for (std::size_t v = 0; v < points.size(); ++v)
        points[v] += share * (to[v] - from[v]);
    return points;
}

TEST(StackCertificate, NamesTheLayerWhoseSurfacesCross)
{
    const PrismShell thin = test::plate_shell(0.1f, 0.1f).shell;
    const std::vector<Vec3s>& top = thin.outer;
    // The upper face goes down by 0.7 and the lower one up by 0.65: they pass each other. The rim
    // is a little inside that of the layer above.
    std::vector<Vec3s> crossed = test::plate_shell(0.7f, 0.65f).shell.inner;
    const std::vector<Vec3s> further_in = along(top, thin.inner, 2);
    for (std::size_t v = 0; v < crossed.size(); ++v)
        if (crossed[v] == thin.inner[v])
            crossed[v] = further_in[v];
    expect_fails_in(certify(stack_between({top, thin.inner, crossed}, thin.triangles)), 1,
                    {"inner_contacts"});
    const std::vector<Vec3s> between = along(top, thin.inner, 0.5f);
    expect_fails_in(certify(stack_between({top, between, thin.inner, crossed}, thin.triangles)), 2,
                    {"inner_contacts"});
}

TEST(StackCertificate, NamesTheLayerThatGoesThroughItsOuterSurface)
{
    const SplitShell pierced = test::pierced_shell();
    std::vector<Vec3s> above = pierced.shell.outer; // grown outward by as much as is free
    for (std::size_t v = 0; v < above.size(); ++v)
        above[v] = Vec3s(2, 2, 0.5f) + 2.0f * (above[v] - Vec3s(2, 2, 0.5f));
    const StackCertificate found = certify(
        stack_between({above, pierced.shell.outer, pierced.shell.inner}, pierced.shell.triangles));
    EXPECT_EQ(kinds(found.layers[0]), Kinds{});
    EXPECT_EQ(kinds(found.layers[1]).count("inner_through_outer"), 1U);
    EXPECT_EQ(found.failures().front().substr(0, 9), "layer 1: ");
}

TEST(StackCertificate, NamesTheLayerThatIsInsideOut)
{
    const StackCertificate found = certify(concentric(icosphere(1, 1), {1, 0.75f, 0.5f, -0.25f}));
    EXPECT_FALSE(found.certified());
    EXPECT_FALSE(found.locally_valid());
    EXPECT_EQ(kinds(found.layers[0]), Kinds{});
    EXPECT_EQ(kinds(found.layers[1]), Kinds{});
    EXPECT_EQ(kinds(found.layers[2]).count("inside_out_components"), 1U);
    EXPECT_EQ(kinds(found.layers[2]).count("bad_prisms"), 1U);
    for (const std::string& line : found.failures())
        EXPECT_EQ(line.substr(0, 9), "layer 2: ");
}

TEST(StackCertificate, NamesTheLayerWithAWrongDiagonal)
{
    ShellStack stack = concentric(icosphere(1, 1), {1, 0.75f, 0.5f, 0.25f});
    EXPECT_TRUE(certify(stack).certified());
    std::swap(stack.splits[1].order[12][0], stack.splits[1].order[12][1]);
    expect_fails_in(certify(stack), 1, {"non_conforming_edges"});
    EXPECT_EQ(check_conformity(stack, make_tets(stack)).stray_faces.count, 4U);
}

TEST(StackCertificate, NamesTheLayerWithABadPrism)
{
    // One point of the surface between the layers is pulled through the lower one.
    ShellStack stack = concentric(icosphere(1, 1), {1, 0.75f, 0.5f});
    stack.layers[0].inner[3] *= 0.5f;
    stack.layers[1].outer = stack.layers[0].inner;
    const StackCertificate found = certify(stack);
    EXPECT_EQ(kinds(found.layers[1]).count("bad_prisms"), 1U);
    EXPECT_EQ(kinds(found.layers[0]).count("bad_prisms"), 0U);
    EXPECT_FALSE(found.locally_valid());
}

// What no single layer shows: the first layer of one component and the last of another. The small
// ball stands in the hollow of the large one, and only its own outermost surface leaves it.
TEST(StackCertificate, SeesContactsThatNoLayerHas)
{
    const ShellStack large = concentric(icosphere(1, 2), {1, 0.9f, 0.3f});
    const ShellStack sound = joined(large, concentric(icosphere(1, 1), {0.15f, 0.05f, 0.02f}));
    EXPECT_EQ(certify(sound).failures(), Lines{});
    const ShellStack apart =
        joined(large, concentric(icosphere(1, 1), {0.15f, 0.05f, 0.02f}, Vec3s(0.2f, 0, 0)));
    const StackCertificate found = certify(apart);
    EXPECT_EQ(kinds(found.layers[0]), Kinds{});
    EXPECT_EQ(kinds(found.layers[1]), Kinds{});
    EXPECT_FALSE(found.certified());
    EXPECT_GT(found.hull_contacts.count, 0U);
    for (const TrianglePair& pair : found.hull_contacts.first)
        EXPECT_NE(pair[0] < 320, pair[1] < 320);
    ASSERT_EQ(found.failures().size(), 1U);
    EXPECT_EQ(found.failures()[0].substr(0, 13), "hull_contacts");
}

TEST(StackCertificate, SeesAComponentInTheRegionOfOthersThatNoLayerHas)
{
    const ShellStack large = concentric(icosphere(1, 2), {1, 0.9f, 0.3f});
    const StackCertificate found =
        certify(joined(large, concentric(icosphere(1, 1), {0.6f, 0.05f, 0.02f})));
    EXPECT_EQ(kinds(found.layers[0]), Kinds{});
    EXPECT_EQ(kinds(found.layers[1]), Kinds{});
    EXPECT_FALSE(found.certified());
    EXPECT_EQ(found.hull_contacts.count, 0U);
    EXPECT_EQ(found.hull_nested_wrongly.first, (std::vector<TrianglePair>{{0, 320}}));
    ASSERT_EQ(found.failures().size(), 1U);
    EXPECT_EQ(found.failures()[0].substr(0, 19), "hull_nested_wrongly");
}

TEST(StackCertificate, SameFindingsForAnyNumberOfThreads)
{
    const ShellStack large = concentric(icosphere(1, 2), {1, 0.9f, -0.3f});
    const ShellStack stack =
        joined(large, concentric(icosphere(1, 1), {0.15f, 0.05f, 0.02f}, Vec3s(0.2f, 0, 0)));
    const auto failures_with = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return certify(stack).failures();
    };
    EXPECT_EQ(failures_with(1), failures_with(2));
    EXPECT_GT(failures_with(1).size(), 1U);
}

TEST(StackCertificate, CanBeCancelled)
{
    test::StopAtOnce interrupter;
    EXPECT_THROW(certify_stack(concentric(icosphere(1, 1), {1, 0.5f, 0.25f}),
                               PrismTest::twelve_tets, &interrupter),
                 Cancelled);
}

} // namespace

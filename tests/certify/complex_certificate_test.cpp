// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/complex_certificate.h"

#include "vdb_shell/certify/coverage.h"
#include "vdb_shell/certify/overlaps.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/shell/tessellate.h"

#include "support/cancelled.h"
#include "support/certificates.h"
#include "support/tapered.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <random>

namespace
{

using namespace vdb_shell;
using openvdb::Vec3s;
using test::icosphere;
using Kinds = std::set<std::string>;

Kinds kinds_of(const ShellStack& stack)
{
    Kinds names;
    for_each_kind(certify_complex(stack), [&](const char* name, const auto& defect) {
        if (defect.count > 0)
            names.insert(name);
    });
    return names;
}

double fill(const ShellStack& stack)
{
    return tet_volume(make_tets(stack)) / signed_volume(stack.surface(0), stack.triangles());
}

/// By three ways that share little with the certificate.
void expect_sound(const ShellStack& stack)
{
    EXPECT_EQ(kinds_of(stack), Kinds{});
    const TetMesh tets = make_tets(stack);
    EXPECT_TRUE(check_conformity(stack, tets).conforming());
    EXPECT_TRUE(find_overlaps(tets).none());
    const Coverage found =
        estimate_coverage({stack.surface(0), stack.triangles()}, tets, {5000, 1});
    EXPECT_EQ(found.in_several + found.outside_covered, 0U);
    EXPECT_NEAR(found.covered_share, fill(stack), 5 * found.standard_error + 1e-3);
}

TEST(ComplexCertificate, HoldsForSolidsConedToAPoint)
{
    for (const TriangleMesh& mesh :
         {test::box(openvdb::Vec3d(-1), openvdb::Vec3d(1)), icosphere(1, 1), icosphere(1, 2)}) {
        const ShellStack stack = test::coned(mesh, Vec3s(0.1f, 0.05f, -0.2f));
        expect_sound(stack);
        EXPECT_EQ(make_tets(stack).tets.size(), mesh.triangles.size());
        EXPECT_NEAR(fill(stack), 1, 1e-6);
    }
    // To one of its own vertices: the triangles there have no tets of their own.
    expect_sound(test::coned(test::octahedron(), Vec3s(1, 0, 0)));
    expect_sound(test::coned(test::unit_tetrahedron(), Vec3s(0)));
    EXPECT_EQ(make_tets(test::coned(test::unit_tetrahedron(), Vec3s(0))).tets.size(), 1U);
}

TEST(ComplexCertificate, HoldsWhereTheInnerSurfaceCancelsPinchesOrVanishes)
{
    expect_sound(test::two_sheets());
    EXPECT_NEAR(fill(test::two_sheets()), 1, 1e-6);
    expect_sound(test::pinched_rod());
    EXPECT_LT(fill(test::pinched_rod()), 0.95);
    expect_sound(test::layers_to_a_point());
    EXPECT_NEAR(fill(test::layers_to_a_point()), 1, 1e-6);
}

TEST(ComplexCertificate, HoldsForShellsThatShareNothing)
{
    expect_sound(test::tapered(test::scaled_shell(icosphere(1, 1), 0.5f)));
    expect_sound(test::tapered(test::plate_shell(0.1f, 0.1f)));
    // All is pinned: there are no tets.
    EXPECT_EQ(kinds_of(test::tapered(test::scaled_shell(icosphere(1, 1), 1))), Kinds{});
    // A ball within the hollow of another.
    const ShellStack balls = test::tapered(test::joined(
        test::scaled_shell(icosphere(1, 1), 0.75f), test::scaled_shell(icosphere(0.5, 1), 0.5f)));
    EXPECT_EQ(kinds_of(balls), Kinds{});
    EXPECT_TRUE(find_overlaps(make_tets(balls)).none());
}

TEST(ComplexCertificate, NamesInvertedTets)
{
    EXPECT_EQ(kinds_of(test::coned(icosphere(1, 1), Vec3s(2, 0, 0))).count("bad_tets"), 1U);
    test::SplitShell made = test::scaled_shell(icosphere(1, 1), 0.5f);
    const openvdb::Vec3I& t = made.shell.triangles[7];
    std::swap(made.shell.inner[t[0]], made.shell.inner[t[1]]);
    const ShellStack swapped = test::tapered(made);
    EXPECT_EQ(kinds_of(swapped).count("bad_tets"), 1U);
    EXPECT_FALSE(find_overlaps(make_tets(swapped)).none());
    EXPECT_FALSE(certify_complex(swapped).locally_valid());
    // A flat tet: the apex is in the plane of a face.
    const ShellStack flat =
        test::coned(test::box(openvdb::Vec3d(-1), openvdb::Vec3d(1)), Vec3s(1, 0, 0));
    EXPECT_EQ(kinds_of(flat).count("bad_tets"), 1U);
}

TEST(ComplexCertificate, NamesFreeFacesThatTouch)
{
    EXPECT_EQ(kinds_of(test::tapered(test::plate_shell(0.7f, 0.65f))), Kinds{"inner_contacts"});
    EXPECT_FALSE(find_overlaps(make_tets(test::tapered(test::plate_shell(0.7f, 0.65f)))).none());
    EXPECT_EQ(kinds_of(test::tapered(test::pierced_shell())).count("inner_through_outer"), 1U);
    EXPECT_EQ(kinds_of(test::tapered(test::folded_shell())), Kinds{"inner_contacts"});
    EXPECT_EQ(kinds_of(test::tapered(test::crossing_shell())).count("outer_contacts"), 1U);
}

TEST(ComplexCertificate, NamesPiecesThatLieInOtherTets)
{
    // Nothing touches, all tets are positive and conform: only the count of tets tells.
    const ShellStack hollow = test::tapered(test::swallowed_shell());
    EXPECT_EQ(kinds_of(hollow), Kinds{"overlapping_tets"});
    EXPECT_TRUE(certify_complex(hollow).locally_valid());
    test::SplitShell made = test::swallowed_shell();
    const std::size_t large = icosphere(1, 2).points.size();
    for (std::size_t v = large; v < made.shell.inner.size(); ++v)
        made.shell.inner[v] = Vec3s(0.75f, 0, 0);
    EXPECT_EQ(kinds_of(test::tapered(made)), Kinds{"overlapping_tets"});
    // Without any tets of its own.
    for (std::size_t v = large; v < made.shell.inner.size(); ++v)
        made.shell.inner[v] = made.shell.outer[v];
    EXPECT_EQ(kinds_of(test::tapered(made)), Kinds{"tets_through_outer"});
}

TEST(ComplexCertificate, NamesDiagonalsThatDoNotFit)
{
    EXPECT_EQ(kinds_of(test::tapered(test::disagreeing_shell(12))).count("stray_faces"), 1U);
    ShellStack stack = test::two_sheets();
    stack.splits[0].order[3] = {1, 1, 2};
    EXPECT_EQ(kinds_of(stack), Kinds{"cyclic_prisms"});
    EXPECT_FALSE(certify_stack(stack, PrismTest::chosen_tets).certified());
}

TEST(ComplexCertificate, NamesOuterSurfacesThatAreNotClosed)
{
    EXPECT_EQ(kinds_of(test::tapered(test::open_shell())).count("open_edges"), 1U);
    // Two balls with one vertex in the same place.
    const TriangleMesh ball = test::octahedron();
    const TriangleMesh both = test::joined(ball, test::translated(ball, {2, 0, 0}));
    std::vector<Vec3s> inner = test::all_at(Vec3s(0), 6);
    inner.resize(12, Vec3s(2, 0, 0));
    const Kinds found = kinds_of(test::tapered_stack({both.points, inner}, both.triangles));
    EXPECT_EQ(found, Kinds{"doubled_vertices"});
}

TEST(ComplexCertificate, StandsInTheCertificateOfTheStack)
{
    const StackCertificate sound = certify_stack(test::two_sheets(), PrismTest::twelve_tets);
    EXPECT_TRUE(sound.certified() && sound.locally_valid());
    EXPECT_TRUE(sound.complex && sound.layers.empty());
    const StackCertificate found =
        certify_stack(test::tapered(test::plate_shell(0.7f, 0.65f)), PrismTest::twelve_tets);
    EXPECT_FALSE(found.certified());
    EXPECT_TRUE(found.locally_valid());
    ASSERT_EQ(found.failures().size(), 1U);
    EXPECT_EQ(found.failures()[0].substr(0, 15), "inner_contacts ");
}

TEST(ComplexCertificate, AgreesWithThatOfASingleLayer)
{
    std::vector<test::SplitShell> shells{test::scaled_shell(icosphere(1, 1), 0.5f),
                                         test::twisted_shell(0.4),
                                         test::twisted_shell(1.5),
                                         test::folded_shell(),
                                         test::plate_shell(0.1f, 0.1f),
                                         test::plate_shell(0.7f, 0.65f),
                                         test::pierced_shell(),
                                         test::crossing_shell(),
                                         test::swallowed_shell(),
                                         test::disagreeing_shell(3),
                                         test::open_shell(),
                                         test::inside_out_shell()};
    for (unsigned seed = 0; seed < 200; ++seed)
        shells.push_back(test::scattered_shell(seed));
    std::size_t certified = 0;
    for (const test::SplitShell& made : shells) {
        const bool layer =
            certify_shell(made.shell, made.split, PrismTest::chosen_tets).certified();
        EXPECT_EQ(certify_complex(test::tapered(made)).certified(), layer) << &made - shells.data();
        certified += layer;
    }
    EXPECT_GT(certified, 10U);
    EXPECT_LT(certified, shells.size() - 10);
}

/// An octahedron with the inner points drawn from a few.
ShellStack drawn(unsigned seed)
{
    const TriangleMesh mesh = test::octahedron();
    std::minstd_rand random(seed + 1);
    const auto share = [&] { return 0.6f * (float(random()) / float(random.max()) - 0.5f); };
    std::vector<Vec3s> few, inner;
    for (int i = 0; i < 4; ++i)
        few.emplace_back(share(), share(), share());
    few.push_back(mesh.points[random() % 6]);
    for (const Vec3s& p : mesh.points)
        inner.push_back(random() % 4 == 0 ? p * 0.5f : few[random() % few.size()]);
    return test::tapered_stack({mesh.points, inner}, mesh.triangles);
}

TEST(ComplexCertificate, CertifiesNothingThatOverlaps)
{
    std::size_t certified = 0, inside_out = 0;
    for (unsigned seed = 0; seed < 3000; ++seed) {
        const ShellStack stack = drawn(seed);
        const ComplexCertificate found = certify_complex(stack);
        // Diagonals of one order of all vertices always fit, whatever is shared.
        EXPECT_EQ(found.conformity.stray_faces.count, 0U) << seed;
        if (found.bad_tets.count > 0)
            continue;
        const bool apart = find_overlaps(make_tets(stack)).none();
        // What is not certified then only touches where nothing is shared.
        EXPECT_EQ(found.certified(), apart && found.inner_contacts.count == 0) << seed;
        certified += found.certified();
        // The inner surface has passed through itself: its free faces touch nothing.
        inside_out += kinds_of(stack) == Kinds{"overlapping_tets"};
        if (found.certified()) {
            EXPECT_LE(fill(stack), 1 + 1e-6) << seed;
        }
    }
    EXPECT_GT(certified, 100U);
    EXPECT_GT(inside_out, 5U);
}

TEST(ComplexCertificate, SameFindingsForAnyNumberOfThreads)
{
    const ShellStack stack = test::tapered(test::pierced_shell());
    const std::vector<std::string> all = certify_complex(stack).failures();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(certify_complex(stack).failures(), all);
}

TEST(ComplexCertificate, CanBeCancelled)
{
    const ShellStack stack = test::coned(icosphere(1, 1), Vec3s(0));
    test::expect_cancelled([&](Interrupter* interrupter) { certify_complex(stack, interrupter); });
}

} // namespace

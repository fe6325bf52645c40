// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/certificate.h"

#include "support/broken_shells.h"
#include "support/certificates.h"
#include "vdb_shell/shell/sides.h"

#include <gtest/gtest.h>

// Outward shells, sound ones and ones that are wrong in one way each.

namespace
{

using namespace vdb_shell;
using openvdb::Vec3d;
using openvdb::Vec3s;
using test::icosphere;
using test::kinds;
using test::SplitShell;
using Kinds = std::set<std::string>;

/// The shell of a reversed surface, turned back.
SplitShell turned(const SplitShell& made)
{
    const ShellStack stack = turn_back(one_layer(made.shell, made.split));
    return {stack.layers[0], stack.splits[0]};
}

Kinds found(const SplitShell& made)
{
    return kinds(certify_shell(made.shell, made.split, PrismTest::twelve_tets));
}

SplitShell around(const TriangleMesh& mesh, const Vec3s& centre, float factor)
{
    return turned(test::moved_shell(
        test::reversed(mesh), [=](const Vec3s& p) { return centre + (p - centre) * factor; }));
}

TEST(OutwardCertificate, HoldsForSoundShells)
{
    const TriangleMesh ball = icosphere(1, 2);
    EXPECT_EQ(found(around(ball, Vec3s(0), 1.5f)), Kinds{});
    // A ball in the cavity of another, each with a shell around its own material's outside.
    SplitShell nested = around(ball, Vec3s(0), 1.5f);
    nested = test::joined(nested, around(test::reversed(icosphere(0.6, 2)), Vec3s(0), 0.75f));
    EXPECT_EQ(found(test::joined(nested, around(icosphere(0.2, 2), Vec3s(0), 2.0f))), Kinds{});
}

TEST(OutwardCertificate, CatchesEveryBreak)
{
    const TriangleMesh ball = icosphere(1, 2);
    const TriangleMesh beside = test::translated(ball, Vec3d(2.25, 0, 0));
    EXPECT_EQ(found(test::joined(around(ball, Vec3s(0), 1.125f - 0.0625f),
                                 around(beside, Vec3s(2.25f, 0, 0), 1.125f - 0.0625f))),
              Kinds{});
    // Two outward shells run into one another.
    EXPECT_EQ(found(test::joined(around(ball, Vec3s(0), 1.1875f),
                                 around(beside, Vec3s(2.25f, 0, 0), 1.1875f))),
              Kinds{"outer_contacts"});
    // One runs over the other's surface.
    EXPECT_EQ(found(test::joined(around(ball, Vec3s(0), 1.5f),
                                 around(beside, Vec3s(2.25f, 0, 0), 1.0625f)))
                  .count("inner_through_outer"),
              1U);
    // A small ball, shell and all, within the shell around a large one.
    const TriangleMesh small = test::translated(icosphere(0.05, 1), Vec3d(1.25, 0, 0));
    EXPECT_EQ(
        found(test::joined(around(ball, Vec3s(0), 1.5f), around(small, Vec3s(1.25f, 0, 0), 1.5f))),
        Kinds{"nested_wrongly"});
    // The grown surface turned inside out.
    EXPECT_TRUE(found(around(ball, Vec3s(0), -1.5f)).count("inside_out_components"));
    // Inside the solid instead of around it: every tet is inverted.
    EXPECT_EQ(found(around(ball, Vec3s(0), 0.5f)), Kinds{"bad_prisms"});
}

// One vertex of the grown surface pulled across its neighbours.
TEST(OutwardCertificate, CatchesAFoldOutward)
{
    SplitShell made = around(icosphere(1, 2), Vec3s(0), 1.5f);
    const openvdb::Vec3I t = made.shell.triangles[0];
    made.shell.outer[t[0]] = made.shell.outer[t[1]] * 1.5f - made.shell.outer[t[0]] * 0.5f;
    const Certificate certificate = certify_shell(made.shell, made.split, PrismTest::twelve_tets);
    EXPECT_FALSE(certificate.certified());
    EXPECT_GT(certificate.bad_prisms.count + certificate.outer_contacts.count, 0U);
    EXPECT_GT(certificate.outer_contacts.count, 0U);
}

} // namespace

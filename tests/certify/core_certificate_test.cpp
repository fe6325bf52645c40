// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/core_certificate.h"

#include "support/filled.h"
#include "vdb_shell/certify/stack_certificate.h"
#include "vdb_shell/shell/tessellate.h"

#include <gtest/gtest.h>

#include <utility>

// What fills a shell, whole and broken in each way that the certificate names.

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;
using openvdb::Vec4I;

struct Filled {
    ShellStack stack = test::hollow_ball();
    TetMesh tets = make_tets(stack);
    CoreTets core = test::cone_core(stack, tets, Vec3s(0.01f, 0.02f, 0.03f));
    CoreCertificate certificate() const { return certify_core(stack, tets, core); }
};

/// The names of all failures.
std::vector<std::string> kinds(const CoreCertificate& certificate)
{
    std::vector<std::string> names;
    for (const std::string& line : certificate.failures())
        names.push_back(line.substr(0, line.find(' ')));
    return names;
}
using Kinds = std::vector<std::string>;

TEST(CoreCertificate, ABallOfShellAndCoreIsOneSolid)
{
    const Filled filled;
    ASSERT_TRUE(certify_stack(filled.stack, PrismTest::twelve_tets).certified());
    EXPECT_EQ(filled.certificate().failures(), std::vector<std::string>{});
    EXPECT_TRUE(filled.certificate().volume_agrees);
    const TetMesh all = joined_tets(filled.tets, filled.core);
    EXPECT_EQ(all.tets.size(), filled.tets.tets.size() + 80);
    EXPECT_TRUE(has_core(all));
    EXPECT_FALSE(has_core(filled.tets));
    EXPECT_NEAR(tet_volume(all), signed_volume(filled.stack.surface(0), filled.stack.triangles()),
                1e-12);
}

TEST(CoreCertificate, NothingIsLeftWhereSheetsLieOnEachOtherOrPillarsMeet)
{
    for (const ShellStack& stack :
         {test::coned(test::octahedron(), Vec3s(0)), test::two_sheets()}) {
        const TetMesh tets = make_tets(stack);
        EXPECT_TRUE(void_surface(stack, tets).triangles.empty());
        EXPECT_EQ(certify_core(stack, tets, {}).failures(), std::vector<std::string>{});
    }
}

TEST(CoreCertificate, AnEmptyShellIsAllVoidAndItsVerticesAreTheCores)
{
    const ShellStack stack = test::empty_shell(test::octahedron());
    const TetMesh tets = make_tets(stack);
    ASSERT_TRUE(tets.tets.empty());
    const CoreTets core = test::cone_core(stack, tets, Vec3s(0));
    EXPECT_EQ(core.points.size(), 7U);
    EXPECT_EQ(certify_core(stack, tets, core).failures(), std::vector<std::string>{});
    CoreTets moved = core;
    moved.points[2] *= 0.5f;
    EXPECT_EQ(kinds(certify_core(stack, tets, moved)), Kinds{"foreign_points"});
    moved = core;
    moved.source_vertex[2] = CoreTets::kNoVertex;
    EXPECT_EQ(kinds(certify_core(stack, tets, moved)), Kinds{"foreign_points"});
}

/// A core that is itself a shell, around a ball that stays empty.
struct WithHole {
    ShellStack stack = test::hollow_ball();
    TetMesh tets = make_tets(stack);
    TriangleMesh hole;
    CoreTets core;
    WithHole()
    {
        const test::SplitShell inner =
            test::scaled_shell({stack.surface(1), stack.triangles()}, 0.5f);
        const ShellStack inner_stack = one_layer(inner.shell, inner.split);
        hole = {inner_stack.surface(1), stack.triangles()};
        core.points = hole.points;
        core.source_vertex.assign(hole.points.size(), CoreTets::kNoVertex);
        const TetMesh made = make_tets(inner_stack);
        const auto number = [&](std::uint32_t p) {
            const std::uint32_t v = made.source_vertex[p];
            for (std::uint32_t i = 0; made.layer[p] == 0; ++i)
                if (tets.layer[i] == 1 && tets.source_vertex[i] == v)
                    return i;
            return std::uint32_t(tets.points.size()) + v;
        };
        for (const Vec4I& t : made.tets)
            core.tets.emplace_back(number(t[0]), number(t[1]), number(t[2]), number(t[3]));
    }
};

TEST(CoreCertificate, EndsAtAHole)
{
    const WithHole made;
    EXPECT_EQ(certify_core(made.stack, made.tets, made.core, made.hole).failures(),
              std::vector<std::string>{});
    EXPECT_EQ(kinds(certify_core(made.stack, made.tets, made.core)), Kinds{"stray_faces"});
    const TriangleMesh found = holes_of_core(made.stack, made.tets, made.core);
    EXPECT_EQ(found.points, made.hole.points);
    EXPECT_EQ(found.triangles.size(), made.hole.triangles.size());
    EXPECT_NEAR(signed_volume(found.points, found.triangles),
                signed_volume(made.hole.points, made.hole.triangles), 1e-12);
    EXPECT_TRUE(certify_core(made.stack, made.tets, made.core, found).certified());
}

TEST(CoreCertificate, AHoleThatIsNotTheOneGivenIsNone)
{
    const WithHole made;
    TriangleMesh hole = made.hole;
    hole.points[3] *= 0.9f;
    EXPECT_EQ(kinds(certify_core(made.stack, made.tets, made.core, hole)), Kinds{"foreign_points"});
    hole = made.hole;
    for (openvdb::Vec3I& t : hole.triangles)
        std::swap(t[1], t[2]);
    EXPECT_EQ(kinds(certify_core(made.stack, made.tets, made.core, hole)),
              Kinds{"misoriented_faces"});
    hole.triangles = made.hole.triangles;
    hole.triangles.pop_back();
    EXPECT_EQ(kinds(certify_core(made.stack, made.tets, made.core, hole)), Kinds{"stray_faces"});
}

TEST(CoreCertificate, ATetThatIsMissingLeavesStrayFacesAndATriangle)
{
    Filled filled;
    filled.core.tets.erase(filled.core.tets.begin() + 5);
    const CoreCertificate found = filled.certificate();
    EXPECT_EQ(found.missing_triangles.count, 1U);
    EXPECT_EQ(found.missing_triangles.first, std::vector<std::uint32_t>{5});
    EXPECT_EQ(found.stray_faces.count, 3U);
    EXPECT_FALSE(found.volume_agrees);
}

TEST(CoreCertificate, ATetTooManyCrowdsItsFaces)
{
    Filled filled;
    filled.core.tets.push_back(filled.core.tets.front());
    EXPECT_EQ(kinds(filled.certificate()), Kinds{"crowded_faces"});
    EXPECT_EQ(filled.certificate().crowded_faces.count, 4U);
}

TEST(CoreCertificate, ATurnedTetIsBadAndOnTheWrongSideOfItsFaces)
{
    Filled filled;
    std::swap(filled.core.tets[7][0], filled.core.tets[7][1]);
    const CoreCertificate found = filled.certificate();
    EXPECT_EQ(found.bad_tets.first, std::vector<std::uint32_t>{7});
    EXPECT_EQ(found.misoriented_faces.count, 4U);
}

TEST(CoreCertificate, AnApexOutsideMakesBadTetsOnly)
{
    Filled filled;
    filled.core.points.back() = Vec3s(0.6f, 0, 0);
    const CoreCertificate found = filled.certificate();
    EXPECT_EQ(kinds(found), Kinds{"bad_tets"});
    // Signed volumes add up all the same: the second opinion is no proof by itself.
    EXPECT_TRUE(found.volume_agrees);
}

/// A point in the middle of a triangle of the void: three tets instead of one.
TEST(CoreCertificate, ASplitFaceIsNoFaceOfTheShell)
{
    Filled filled;
    const Vec4I t = filled.core.tets[3];
    const auto middle =
        static_cast<std::uint32_t>(filled.tets.points.size() + filled.core.points.size());
    filled.core.points.push_back(
        (filled.tets.points[t[0]] + filled.tets.points[t[1]] + filled.tets.points[t[2]]) / 3.0f);
    filled.core.source_vertex.push_back(CoreTets::kNoVertex);
    filled.core.tets[3] = Vec4I(t[0], t[1], middle, t[3]);
    filled.core.tets.emplace_back(t[1], t[2], middle, t[3]);
    filled.core.tets.emplace_back(t[2], t[0], middle, t[3]);
    const CoreCertificate found = filled.certificate();
    EXPECT_EQ(found.missing_triangles.first, std::vector<std::uint32_t>{3});
    EXPECT_EQ(found.stray_faces.count, 3U);
}

/// Same place, other index: to the eye it is whole.
TEST(CoreCertificate, PointsAreComparedByIndexAndNotByPlace)
{
    Filled filled;
    const std::uint32_t old = filled.core.tets[0][0];
    const auto copy =
        static_cast<std::uint32_t>(filled.tets.points.size() + filled.core.points.size());
    filled.core.points.push_back(filled.tets.points[old]);
    filled.core.source_vertex.push_back(CoreTets::kNoVertex);
    for (Vec4I& tet : filled.core.tets)
        for (int k = 0; k < 4; ++k)
            if (tet[k] == old)
                tet[k] = copy;
    const CoreCertificate found = filled.certificate();
    EXPECT_TRUE(found.volume_agrees);
    EXPECT_GT(found.stray_faces.count, 0U);
    EXPECT_EQ(found.stray_faces.count, found.missing_triangles.count);
}

TEST(CoreCertificate, NamesUnusedPointsAndCornersOutOfRange)
{
    Filled filled;
    filled.core.points.emplace_back(0.1f, 0.1f, 0.1f);
    filled.core.source_vertex.push_back(CoreTets::kNoVertex);
    EXPECT_EQ(kinds(filled.certificate()), Kinds{"unused_points"});
    filled.core.tets[2][1] = 100000;
    EXPECT_EQ(kinds(filled.certificate()), Kinds{"corners_out_of_range"});
}

} // namespace
} // namespace vdb_shell

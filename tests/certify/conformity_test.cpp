// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/certify/conformity.h"

#include "support/shapes.h"
#include "support/shells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace
{

using namespace vdb_shell;

PrismShell sphere_shell()
{
    return test::radial_shell(test::icosphere(1, 1), [](std::size_t) { return 0.5; });
}

TetMesh tets_of(const PrismShell& shell)
{
    return make_tets(shell, split_prisms(shell, {SplitRule::vertex_index, 1}));
}

TEST(Conformity, HoldsForInvertedTetsToo)
{
    // Past the centre: every prism is turned inside out, but the faces still match.
    const PrismShell shell =
        test::radial_shell(test::icosphere(1, 1), [](std::size_t) { return 1.5; });
    EXPECT_TRUE(check_conformity(shell, tets_of(shell)).conforming());
}

TEST(Conformity, SeesAPrismThatDisagreesOnItsDiagonals)
{
    const PrismShell shell = sphere_shell();
    PrismSplit split = split_prisms(shell, {SplitRule::vertex_index, 1});
    std::reverse(split.order[5].begin(), split.order[5].end());
    const Conformity found = check_conformity(shell, make_tets(shell, split));
    // All three quads of the prism have two triangles on either side that do not match.
    EXPECT_EQ(found.stray_faces.count, 12U);
    EXPECT_EQ(found.missing_triangles.count, 0U);
    EXPECT_EQ(found.crowded_faces.count, 0U);
    EXPECT_FALSE(found.conforming());
}

TEST(Conformity, SeesAMissingTet)
{
    const PrismShell shell = sphere_shell();
    TetMesh tets = tets_of(shell);
    tets.tets.erase(tets.tets.begin()); // the first prism's tet under the outer triangle
    tets.prism.erase(tets.prism.begin());
    const Conformity found = check_conformity(shell, tets);
    EXPECT_EQ(found.missing_triangles.count, 1U);
    EXPECT_EQ(found.missing_triangles.first, std::vector<std::uint32_t>{0});
    EXPECT_EQ(found.stray_faces.count, 3U);
}

TEST(Conformity, SeesATurnedTet)
{
    const PrismShell shell = sphere_shell();
    TetMesh tets = tets_of(shell);
    std::swap(tets.tets[0][0], tets.tets[0][1]);
    const Conformity found = check_conformity(shell, tets);
    EXPECT_EQ(found.misoriented_faces.count, 4U); // one against the surface, three against tets
    EXPECT_EQ(found.misoriented_faces.first.front(), 0U);
    EXPECT_EQ(found.stray_faces.count + found.crowded_faces.count, 0U);
}

TEST(Conformity, SeesADuplicateTet)
{
    const PrismShell shell = sphere_shell();
    TetMesh tets = tets_of(shell);
    tets.tets.push_back(tets.tets[0]);
    tets.prism.push_back(0);
    const Conformity found = check_conformity(shell, tets);
    EXPECT_EQ(found.crowded_faces.count, 3U);
    EXPECT_EQ(found.missing_triangles.count, 1U); // its outer triangle is no free face any more
}

/// All that one run has found, to compare.
std::array<std::vector<std::uint32_t>, 4> all_first(const Conformity& found)
{
    return {found.crowded_faces.first, found.misoriented_faces.first, found.stray_faces.first,
            found.missing_triangles.first};
}

TEST(Conformity, FindsTheSameInPartsOfAnySize)
{
    const PrismShell shell = sphere_shell();
    TetMesh tets = tets_of(shell);
    tets.tets.erase(tets.tets.begin());
    tets.prism.erase(tets.prism.begin());
    tets.tets.push_back(tets.tets[20]);
    tets.prism.push_back(tets.prism[20]);
    std::swap(tets.tets[70][0], tets.tets[70][1]);
    const Conformity at_once = check_conformity(shell, tets);
    EXPECT_FALSE(at_once.conforming());
    for (const std::size_t sides : {1U, 7U, 100U, 1000U}) {
        const Conformity in_parts = check_conformity(shell, tets, sides);
        EXPECT_EQ(all_first(in_parts), all_first(at_once)) << sides;
        EXPECT_EQ(in_parts.crowded_faces.count, at_once.crowded_faces.count) << sides;
        EXPECT_EQ(in_parts.misoriented_faces.count, at_once.misoriented_faces.count) << sides;
        EXPECT_EQ(in_parts.stray_faces.count, at_once.stray_faces.count) << sides;
        EXPECT_EQ(in_parts.missing_triangles.count, at_once.missing_triangles.count) << sides;
    }
}

TEST(Conformity, SeesTheSidesOfAnOpenSurface)
{
    const TriangleMesh open = test::without_triangle(test::icosphere(1, 1), 7);
    const PrismShell shell = test::radial_shell(open, [](std::size_t) { return 0.5; });
    const Conformity found = check_conformity(shell, tets_of(shell));
    EXPECT_EQ(found.stray_faces.count, 6U); // two triangles on each of three quads
}

TEST(Conformity, WantsBothTrianglesOfAPartlyPinnedPrismAndNeitherOfAPinnedOne)
{
    const TriangleMesh sphere = test::icosphere(1, 1);
    const openvdb::Vec3I first = sphere.triangles[0];
    const PrismShell shell = test::radial_shell(sphere, [&](std::size_t v) {
        return v == first[0] || v == first[1] || v == first[2] ? 0.0 : 0.5;
    });
    TetMesh tets = tets_of(shell);
    EXPECT_TRUE(check_conformity(shell, tets).conforming());
    EXPECT_NE(tets.prism.front(), 0U); // the pinned prism has no tet
    // A prism of one tet, beside the pinned one: without that tet both its triangles are missing.
    std::size_t lone = 0;
    while (lone + 1 < tets.prism.size() && tets.prism[lone + 1] == tets.prism[lone])
        lone = static_cast<std::size_t>(
            std::upper_bound(tets.prism.begin(), tets.prism.end(), tets.prism[lone]) -
            tets.prism.begin());
    const std::uint32_t prism = tets.prism[lone];
    tets.tets.erase(tets.tets.begin() + static_cast<std::ptrdiff_t>(lone));
    tets.prism.erase(tets.prism.begin() + static_cast<std::ptrdiff_t>(lone));
    const Conformity found = check_conformity(shell, tets);
    EXPECT_EQ(found.missing_triangles.count, 2U);
    EXPECT_EQ(found.missing_triangles.first, std::vector<std::uint32_t>{prism});
}

} // namespace

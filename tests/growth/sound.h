// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/grown.h"
#include "support/shapes.h"
#include "vdb_shell/certify/certificate.h"
#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/certify/tet_signs.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell::test
{

inline void expect_all_positive(const PrismShell& shell, const PrismSplit& split)
{
    const TetSigns signs = count_tet_signs(make_tets(shell, split));
    EXPECT_EQ(signs.inverted.count, 0U);
    EXPECT_EQ(signs.flat.count, 0U);
}

/// The tets of all six orders of a prism are its twelve.
inline void expect_twelve_positive(const PrismShell& shell)
{
    std::array<std::uint8_t, 3> order{0, 1, 2};
    do {
        expect_all_positive(
            shell, {std::vector<std::array<std::uint8_t, 3>>(shell.triangles.size(), order), 0});
    } while (std::next_permutation(order.begin(), order.end()));
}

/// The inner surface neither touches itself nor the outer one: with the inner surface turned
/// inside out both together bound the shell. Precondition: no pins, which both surfaces share.
inline void expect_embedded(const PrismShell& shell)
{
    const TriangleMesh inner{shell.inner, shell.triangles};
    const MeshCheck check = check_mesh(joined({shell.outer, shell.triangles}, reversed(inner)));
    EXPECT_EQ(check.self_intersections.count, 0U);
    EXPECT_EQ(check.degenerate_triangles.count, 0U);
}

inline void expect_sound(const GrowResult& result, const GrowOptions& options = {})
{
    const PrismTest test = prism_test_of(options);
    if (test == PrismTest::twelve_tets)
        expect_twelve_positive(result.shell);
    expect_all_positive(result.shell, result.split);
    for (const std::string& failure : certify_shell(result.shell, result.split, test).failures())
        ADD_FAILURE() << failure;
    EXPECT_TRUE(check_conformity(result.shell, make_tets(result.shell, result.split)).conforming());
    EXPECT_GE(fill_of(result.shell), result.report.fill_after_lines - 1e-12);
}

} // namespace vdb_shell::test

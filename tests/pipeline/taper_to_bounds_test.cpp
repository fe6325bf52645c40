// SPDX-License-Identifier: Apache-2.0
#include "support/shapes.h"
#include "vdb_shell/pipeline.h"

#include <gtest/gtest.h>

// Tapering towards bounds that pull against each other.

namespace vdb_shell
{
namespace
{

BoundsReport bounds_of_tapered(const TriangleMesh& mesh, const WantedBounds& wanted)
{
    ShellOptions options;
    options.level_set.resolution = 40;
    options.taper.wanted = true;
    options.wanted = wanted;
    return *build_shell(mesh, options).report.wanted;
}

TEST(TaperToBounds, FewTetsAndAFullShellAreFoundTogether)
{
    // Neither dearer tets nor a dearer void alone meets both: what one cost of a tet gave says
    // nothing once the void costs more.
    WantedBounds wanted;
    wanted.tets = 3000;
    wanted.fill = 0.999;
    const BoundsReport judged = bounds_of_tapered(test::torus(1, 0.35, 48, 24), wanted);
    ASSERT_EQ(judged.bounds.size(), 2U);
    for (const WantedBound& bound : judged.bounds)
        EXPECT_TRUE(bound.met) << int(bound.kind) << ": " << bound.reached;
}

} // namespace
} // namespace vdb_shell

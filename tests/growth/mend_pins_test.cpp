// SPDX-License-Identifier: Apache-2.0
#include "growth/mend_pins.h"

#include "growth/grown.h"
#include "growth/pins.h"
#include "growth/sound.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace
{

using namespace vdb_shell;

/// A cube without an eighth: large faces, and vertices that reach into all of them. Grown, and then
/// one vertex and those beside it pinned.
class MendPins : public ::testing::Test
{
protected:
    growth::GrowState pinned_around(int vertex) const
    {
        growth::GrowState s = growth::make_state(mesh_, case_.mesh.points, case_.cap);
        growth::put_shell(s, full_.shell, full_.split.order);
        pin(s, vertex);
        for (const int u : growth::neighbours(mesh_, vertex))
            pin(s, u);
        growth::refit_inner_tree(s);
        return s;
    }

    static StageProgress progress() { return StageProgress(nullptr, "test"); }

    static void pin(growth::GrowState& s, int v)
    {
        s.pinned[v] = 1;
        s.b[v] = s.a[v];
    }

    const test::Case case_ = test::case_of(test::notched_cube());
    const growth::Connectivity mesh_ =
        growth::connect(case_.mesh.points.size(), case_.mesh.triangles);
    const GrowResult full_ = test::grown(case_);
};

TEST_F(MendPins, ReleasesWhatCannotBeReleasedOneByOne)
{
    for (const int vertex : {3, 4, 7, 11}) {
        growth::GrowState s = pinned_around(vertex);
        growth::release_last_pins(s, case_.directions.visibility, progress());
        ASSERT_EQ(growth::count_pins(s), 1) << vertex;
        EXPECT_EQ(growth::mend_pins(s, case_.directions.visibility, progress()), 1);
        EXPECT_EQ(growth::count_pins(s), 0);
        const PrismShell shell = growth::shell_of(case_.mesh, s);
        test::expect_twelve_positive(shell);
        test::expect_embedded(shell);
    }
}

TEST_F(MendPins, LeavesTheShellAsItIsWhereNothingCanBeReleased)
{
    growth::GrowState s = pinned_around(3);
    const std::vector<openvdb::Vec3d> inner = s.b;
    const std::ptrdiff_t pins = growth::count_pins(s);
    EXPECT_EQ(growth::mend_pins(s, std::vector<double>(s.b.size(), 0.0), progress()), 0);
    EXPECT_EQ(s.b, inner);
    EXPECT_EQ(growth::count_pins(s), pins);
}

} // namespace

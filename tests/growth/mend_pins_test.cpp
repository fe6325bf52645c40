// SPDX-License-Identifier: Apache-2.0
#include "growth/mend_pins.h"

#include "growth/grown.h"
#include "growth/pins.h"
#include "growth/sound.h"
#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace
{

using namespace vdb_shell;

const StageProgress& untold()
{
    static const StageProgress progress(nullptr, "test");
    return progress;
}

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

std::size_t pins_of(const growth::GrowState& s)
{
    return static_cast<std::size_t>(std::count(s.pinned.begin(), s.pinned.end(), 1));
}

TEST_F(MendPins, ReleasesWhatCannotBeReleasedOneByOne)
{
    for (const int vertex : {3, 4, 7, 11}) {
        growth::GrowState s = pinned_around(vertex);
        growth::release_last_pins(s, case_.directions.visibility, untold());
        ASSERT_EQ(pins_of(s), 1U) << vertex;
        EXPECT_EQ(growth::mend_pins(s, case_.directions.visibility, untold()), 1);
        EXPECT_EQ(pins_of(s), 0U);
        const PrismShell shell = growth::shell_of(case_.mesh, s);
        test::expect_twelve_positive(shell);
        test::expect_embedded(shell);
    }
}

TEST_F(MendPins, LeavesTheShellAsItIsWhereNothingCanBeReleased)
{
    growth::GrowState s = pinned_around(3);
    const std::vector<openvdb::Vec3d> inner = s.b;
    const std::size_t pins = pins_of(s);
    EXPECT_EQ(growth::mend_pins(s, std::vector<double>(s.b.size(), 0.0), untold()), 0);
    EXPECT_EQ(s.b, inner);
    EXPECT_EQ(pins_of(s), pins);
}

} // namespace

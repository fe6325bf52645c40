// SPDX-License-Identifier: Apache-2.0
#include "pose/centre_points.h"

#include "core/exact.h"
#include "pose/rest_parts.h"
#include "vdb_shell/pipeline.h"

#include "support/bends.h"

#include <gtest/gtest.h>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

class CentrePoints : public ::testing::Test
{
protected:
    static ShellStack rod_shell()
    {
        ShellOptions options;
        options.level_set.resolution = 32;
        options.coverage.samples = 0;
        return build_shell(test::round_rod(), options).stack;
    }

    /// By exact signs of the places as floats.
    std::vector<std::uint32_t> inverted(const PoseState& state) const
    {
        std::vector<std::uint32_t> list;
        for (std::uint32_t t = 0; t < parts.all.size(); ++t) {
            std::array<Vec3s, 4> corner;
            for (std::size_t k = 0; k < 4; ++k)
                corner[k] = Vec3s(state.place[parts.all[t][int(k)]]);
            if (exact::orient3d(corner[0], corner[1], corner[2], corner[3]) <= 0)
                list.push_back(t);
        }
        return list;
    }

    PoseState centred(PoseState state) const
    {
        centre_points(
            parts, state, [this](const PoseState& s) { return inverted(s); }, 0.01,
            StageProgress(nullptr, "test"));
        return state;
    }

    const RestShell rest{rod_shell()};
    const RestShell::Parts& parts = rest.parts();
    const PoseState at_rest{parts.rest, parts.rest};
};

TEST_F(CentrePoints, LeavesWhatIsPositive)
{
    EXPECT_EQ(centred(at_rest).place, at_rest.place);
}

TEST_F(CentrePoints, TurnsTetsRoundWherePointsHaveToMoveTogether)
{
    // Neighbouring inner points thrown out through the skin, so that the cells of some are empty.
    PoseState thrown = at_rest;
    const std::uint32_t point = parts.colour.front().front();
    std::vector<std::uint8_t> moved(parts.rest.size(), 0);
    for (std::uint32_t i = parts.first[point]; i < parts.first[point + 1]; ++i)
        for (int k = 0; k < 4; ++k) {
            const std::uint32_t p = parts.all[parts.incident[i]][k];
            if (parts.skin_vertex[p] == RestShell::Parts::kFree)
                moved[p] = 1;
        }
    for (std::uint32_t p = 0; p < moved.size(); ++p)
        if (moved[p])
            thrown.place[p] += 0.4 * (parts.rest[point].unit() + Vec3d(0.3, -0.2, 0.1));
    ASSERT_GT(inverted(thrown).size(), 3U);
    const PoseState found = centred(thrown);
    EXPECT_TRUE(inverted(found).empty());
    std::size_t still = 0;
    for (std::size_t p = 0; p < found.place.size(); ++p) {
        if (parts.skin_vertex[p] != RestShell::Parts::kFree) {
            EXPECT_EQ(found.place[p], at_rest.place[p]) << "the skin is given";
        }
        still += found.place[p] == at_rest.place[p];
    }
    // Points far from them stay.
    EXPECT_GT(2 * still, found.place.size());
}

} // namespace
} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "growth/fullest.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;

/// Grows nothing, but says what it is asked for, and gives shells that are as full as they are told
/// to be, one after the other.
class Fullest : public testing::Test
{
protected:
    GrowResult result_of(double fill) const
    {
        GrowResult result;
        result.shell = {mesh.points, mesh.points, mesh.triangles, {}};
        for (openvdb::Vec3s& p : result.shell.inner)
            p *= static_cast<float>(std::cbrt(1 - fill));
        result.shell.stop.assign(mesh.points.size(), StopReason::none);
        return result;
    }

    GrowResult fullest(std::vector<GrowResult> told)
    {
        const Connectivity connectivity = connect(mesh.points.size(), mesh.triangles);
        const std::vector<double> cap(mesh.points.size(), std::numeric_limits<double>::infinity());
        asked.clear();
        to_beat.clear();
        return grow_fullest({}, connectivity, cap, options,
                            [&](const Attempt& attempt, const GrowResult* restarted) {
                                EXPECT_EQ(restarted != nullptr, attempt.from == GrowFrom::shell);
                                asked += restarted                            ? 'r'
                                         : attempt.start == LineStart::planar ? 'p'
                                         : attempt.start == LineStart::mended ? 'm'
                                                                              : 's';
                                if (restarted)
                                    from.push_back(fill_of(*restarted));
                                to_beat.push_back(attempt.rounds.fill_to_beat);
                                EXPECT_LE(asked.size(), told.size()) << asked;
                                return told[std::min(asked.size(), told.size()) - 1];
                            });
    }

    static double fill_of(const GrowResult& result)
    {
        return 1 - signed_volume(result.shell.inner, result.shell.triangles) /
                       signed_volume(result.shell.outer, result.shell.triangles);
    }

    TriangleMesh mesh = test::icosphere(1.0, 2);
    GrowOptions options;
    std::string asked;           ///< shrunk, planar, mended; restarts
    std::vector<double> from;    ///< fill of what restarts were to go on from
    std::vector<double> to_beat; ///< fill that each need not go on without
};

TEST_F(Fullest, AFullShellIsTheOnlyOne)
{
    EXPECT_NEAR(fill_of(fullest({result_of(0.993)})), 0.993, 1e-6);
    EXPECT_EQ(asked, "s");
}

TEST_F(Fullest, RestartsComeFirstWhereFewAreEnough)
{
    EXPECT_NEAR(fill_of(fullest({result_of(0.97), result_of(0.985), result_of(0.992)})), 0.992,
                1e-6);
    EXPECT_EQ(asked, "srr");
}

TEST_F(Fullest, OtherStartsComeFirstFarFromFull)
{
    fullest({result_of(0.6), result_of(0.7), result_of(0.65), result_of(0.8), result_of(0.8)});
    EXPECT_EQ(asked, "spmrr");
    ASSERT_EQ(from.size(), 2U);
    EXPECT_NEAR(from.front(), 0.7, 1e-6);
}

/// A restart goes on from the fullest as far as it gets.
TEST_F(Fullest, OtherStartsAreToldWhatTheyHaveToBeat)
{
    fullest({result_of(0.6), result_of(0.7), result_of(0.65), result_of(0.7)});
    ASSERT_EQ(asked, "spmr");
    EXPECT_EQ(to_beat[0], 0);
    EXPECT_NEAR(to_beat[1], 0.6, 1e-6);
    EXPECT_NEAR(to_beat[2], 0.7, 1e-6);
    EXPECT_EQ(to_beat[3], 0);
}

/// One that wins a tenth would have to be followed by ten.
TEST_F(Fullest, OtherStartsAreTriedOnceRestartsWinLittle)
{
    const GrowResult first = result_of(0.96), on = result_of(0.964);
    const double fill = fill_of(fullest({first, on, result_of(0.95), result_of(0.94), on}));
    EXPECT_EQ(asked, "srpmr");
    EXPECT_NEAR(fill, 0.964, 1e-6);
    // None of the others was fuller, so what the first has come to is gone on from.
    EXPECT_NEAR(from.back(), 0.964, 1e-6);
}

TEST_F(Fullest, MorePinsAreNotWorthTheirVolume)
{
    GrowResult pinned = result_of(0.98);
    pinned.shell.stop.front() = StopReason::pinned;
    EXPECT_NEAR(fill_of(fullest({result_of(0.6), pinned, pinned, pinned})), 0.6, 1e-6);
    EXPECT_EQ(asked, "spmr");
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
// What growth tells an interrupter, and that it ends when that says so.
#include "vdb_shell/growth/grow.h"

#include "growth/grown.h"
#include "support/stacks.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <vector>

namespace vdb_shell::test
{
namespace
{

class StopAfter : public Interrupter
{
public:
    explicit StopAfter(int polls) : left_(polls) {}
    bool wasInterrupted(int /*percent*/) override { return left_-- <= 0; }
    int left() const { return left_; }

private:
    int left_;
};

TEST(GrowProgress, StopsWhenAskedAtAnyPoint)
{
    const Case c = case_of(bumpy_sphere());
    // How often it is asked depends on how many threads share the loops.
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    constexpr int kMany = 1000000;
    StopAfter never(kMany);
    grown(c, {}, &never);
    const int polls = kMany - never.left();
    EXPECT_GT(polls, 10);
    for (const int after : {0, 1, polls / 2, polls - 1}) {
        StopAfter interrupter(after);
        EXPECT_THROW(grown(c, {}, &interrupter), Cancelled) << after;
    }
}

/// What share of growth it was told is done.
struct NotesPercents : Interrupter {
    bool wasInterrupted(int percent) override
    {
        if (percent >= 0)
            percents.push_back(percent);
        return false;
    }
    std::vector<int> percents;
};

TEST(GrowProgress, GoesForwardInSmallStepsFromLevelToLevel)
{
    const Case c = case_of(bumpy_sphere(5));
    GrowOptions options;
    options.coarse_from = 1000;
    const std::vector<Coarsened> levels = coarse_levels(c.mesh, options);
    ASSERT_GE(levels.size(), 2U);
    NotesPercents notes;
    grow_shell_from({GrowFrom::levels, {}, levels}, c.mesh, c.directions, c.start, c.cap, options,
                    {}, &notes);
    ASSERT_FALSE(notes.percents.empty());
    EXPECT_TRUE(std::is_sorted(notes.percents.begin(), notes.percents.end()));
    EXPECT_GE(notes.percents.back(), 60);
    int step = 0;
    for (std::size_t i = 1; i < notes.percents.size(); ++i)
        step = std::max(step, notes.percents[i] - notes.percents[i - 1]);
    EXPECT_LE(step, 25);
}

TEST(GrowProgress, CoarseningStopsWhenAsked)
{
    const TriangleMesh mesh = bumpy_sphere(5);
    StopAfter soon(5);
    EXPECT_THROW(coarse_levels(mesh, GrowOptions{}, &soon), Cancelled);
}

} // namespace
} // namespace vdb_shell::test

// SPDX-License-Identifier: Apache-2.0
#include "growth/attempts.h"

#include "support/stacks.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;

constexpr std::size_t kFew = 1000, kMany = 1000000;

std::vector<LineStart> starts_of(const std::vector<Attempt>& attempts)
{
    std::vector<LineStart> starts;
    for (const Attempt& attempt : attempts)
        starts.push_back(attempt.start);
    return starts;
}

GrowStart on_levels()
{
    return {GrowFrom::levels, {}, std::vector<Coarsened>(1)};
}

TEST(Attempts, BeginAsTheOptionsSay)
{
    for (const GrowOptions& options : test::ways_to_grow()) {
        const Attempt first = attempts_of({}, kFew, options).front();
        EXPECT_EQ(first.from, GrowFrom::lines);
        EXPECT_EQ(first.start, LineStart::shrunk);
        EXPECT_EQ(first.options.method, options.method);
        EXPECT_EQ(first.options.prism_test, options.prism_test);
        EXPECT_EQ(attempts_of(on_levels(), kMany, options).front().from, GrowFrom::levels);
    }
}

/// The first one alone, which is enough for most surfaces, lowers the barrier's weight in any case.
TEST(Attempts, TakeTheirTimeAfterTheFirst)
{
    for (const GrowOptions& options : test::ways_to_grow()) {
        const std::vector<Attempt> attempts = attempts_of({}, kFew, options);
        ASSERT_GT(attempts.size(), 2U);
        for (std::size_t i = 1; i < 3; ++i)
            EXPECT_TRUE(attempts[i].rounds.keep_weight);
        EXPECT_FALSE(attempts.front().rounds.keep_weight);
        EXPECT_TRUE(restarts_of(attempts.front(), kFew).attempt.rounds.keep_weight);
    }
}

// A lever that is off stays off.
TEST(Attempts, AreThinAloneWithoutTopDown)
{
    for (GrowOptions options : test::ways_to_grow()) {
        options.top_down = false;
        for (const LineStart start : starts_of(attempts_of({}, kFew, options)))
            EXPECT_EQ(start, LineStart::thin);
    }
}

// A thin shell, with room on all sides, is where lines go from; free moves have room of their own.
TEST(Attempts, AreNotThinWithTopDown)
{
    for (const GrowOptions& options : test::ways_to_grow())
        for (const LineStart start : starts_of(attempts_of({}, kFew, options)))
            EXPECT_NE(start, LineStart::thin);
}

TEST(Attempts, KeepToTheLinesWithoutFreeMoves)
{
    for (GrowOptions options : test::ways_to_grow()) {
        options.free_moves = false;
        for (const LineStart start : starts_of(attempts_of({}, kFew, options)))
            EXPECT_FALSE(leaves_lines(start));
    }
}

// Every other shell passes the test that the options ask for.
TEST(Attempts, EndWithTheTestThatIsAskedFor)
{
    for (const GrowOptions& options : test::ways_to_grow())
        for (const Attempt& attempt : attempts_of({}, kFew, options))
            EXPECT_EQ(prism_test_of(attempt.options), prism_test_of(options));
}

TEST(Attempts, AreOneAloneWhereEachTakesItsTime)
{
    EXPECT_EQ(attempts_of(on_levels(), kMany, {}).size(), 1U);
    EXPECT_EQ(attempts_of({}, kMany, {}).size(), 1U) << "no coarser surface";
    EXPECT_EQ(attempts_of({GrowFrom::shell, {}, {}}, kFew, {}).size(), 1U);
    EXPECT_GT(attempts_of(on_levels(), kFew, {}).size(), 1U);
}

TEST(Attempts, NoneFollowsWhereEnoughIsFull)
{
    GrowOptions half;
    half.schedule.barrier.enough_fill = 0.5;
    for (const Attempt& attempt : attempts_of({}, kFew, half))
        EXPECT_EQ(enough_for(attempt), 0.5);
    for (const GrowFrom from : {GrowFrom::lines, GrowFrom::levels})
        EXPECT_EQ(restarts_of({from, LineStart::shrunk, half}, kFew).enough, 0.5);
}

TEST(Restarts, GoOnFromTheShellUnderTheTestThatIsAskedFor)
{
    for (const GrowOptions& options : test::ways_to_grow()) {
        const Restarts restarts = restarts_of({GrowFrom::lines, LineStart::shrunk, options}, kFew);
        EXPECT_GT(restarts.most, 0);
        EXPECT_EQ(restarts.attempt.from, GrowFrom::shell);
        EXPECT_EQ(prism_test_of(restarts.attempt.options), prism_test_of(options));
    }
}

TEST(Restarts, HaveNumbersOfTheirOwn)
{
    GrowOptions options;
    options.schedule.restarts.weight_decrease = 0.9;
    options.schedule.restarts.factor_on_move = 3;
    const Restarts restarts = restarts_of({GrowFrom::lines, LineStart::shrunk, options}, kFew);
    EXPECT_EQ(restarts.attempt.options.schedule.barrier.weight_decrease, 0.9);
    EXPECT_EQ(restarts.attempt.options.schedule.radius.factor_on_move, 3);
    EXPECT_EQ(restarts.attempt.options.schedule.radius.short_from_fill, 0) << "short radii always";
}

TEST(Restarts, AreNoneWithoutFreeMovesNorFromAShellNorWhereTheyTakeTooLong)
{
    GrowOptions still, thin;
    still.free_moves = false;
    thin.top_down = false;
    const GrowOptions any;
    EXPECT_EQ(restarts_of({GrowFrom::lines, LineStart::shrunk, still}, kFew).most, 0);
    EXPECT_EQ(restarts_of({GrowFrom::lines, LineStart::thin, thin}, kFew).most, 0);
    EXPECT_EQ(restarts_of({GrowFrom::shell, LineStart::shrunk, any}, kFew).most, 0);
    EXPECT_EQ(restarts_of({GrowFrom::levels, LineStart::shrunk, any}, kMany).most, 0);
    EXPECT_EQ(restarts_of({GrowFrom::lines, LineStart::shrunk, any}, kMany).most, 0);
    EXPECT_GT(restarts_of({GrowFrom::levels, LineStart::shrunk, any}, kFew).most, 0);
}

} // namespace

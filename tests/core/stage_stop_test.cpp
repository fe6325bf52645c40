// SPDX-License-Identifier: Apache-2.0

// Stages that are told to stop while their loops run.

#include "core/stage_stop.h"

#include "core/parallel.h"
#include "core/stage_progress.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace vdb_shell::test
{
namespace
{

/// Wants to stop from the n-th question on, and notes what it is told.
class StopsAt final : public Interrupter
{
public:
    explicit StopsAt(int question) : left_(question) {}
    void start(const char* /*name*/) override { ++open; }
    void end() override { --open; }
    bool wasInterrupted(int percent) override
    {
        EXPECT_EQ(std::this_thread::get_id(), owner_);
        if (percent >= 0)
            percents.push_back(percent);
        ++asked;
        return --left_ < 0;
    }
    int open = 0, asked = 0;
    std::vector<int> percents;

private:
    std::thread::id owner_ = std::this_thread::get_id();
    int left_;
};

constexpr std::size_t kMany = 1'000'000;
constexpr int kNever = 1'000'000'000;

TEST(StageStop, ALoopOfAStageEndsInTheMiddle)
{
    StopsAt interrupter(3);
    std::atomic<std::size_t> done{0};
    const auto stage = [&] {
        const StageProgress progress(&interrupter, "test");
        for_each_index(kMany, [&](std::size_t /*i*/) { ++done; });
    };
    EXPECT_THROW(stage(), Cancelled);
    EXPECT_LT(done, kMany);
    EXPECT_EQ(interrupter.open, 0);
}

TEST(StageStop, SoDoesOneWithinAnother)
{
    StopsAt interrupter(3);
    std::atomic<std::size_t> done{0};
    constexpr std::size_t kRows = 1000, kColumns = 10000;
    const auto stage = [&] {
        const StageProgress progress(&interrupter, "test");
        run_together(
            [&] {
                for_each_index(
                    kRows,
                    [&](std::size_t /*row*/) {
                        for_each_index(kColumns, [&](std::size_t /*column*/) { ++done; });
                    },
                    1);
            },
            [] {});
    };
    EXPECT_THROW(stage(), Cancelled);
    EXPECT_LT(done, kRows * kColumns);
}

TEST(StageStop, WhatIsAskedChangesNoResult)
{
    const auto squares = [](Interrupter* interrupter) {
        const StageProgress progress(interrupter, "test");
        std::vector<std::size_t> result(kMany);
        for_each_index(kMany, [&](std::size_t i) { result[i] = i * i; });
        return result;
    };
    StopsAt never(kNever);
    EXPECT_EQ(squares(&never), squares(nullptr));
    EXPECT_GT(never.asked, 1);
}

TEST(StageStop, LoopsOutsideAnyStageAskNobody)
{
    StopsAt interrupter(1);
    {
        const StageProgress progress(&interrupter, "test");
    }
    EXPECT_EQ(stage_stop(), nullptr);
    std::atomic<std::size_t> done{0};
    for_each_index(kMany, [&](std::size_t /*i*/) { ++done; });
    EXPECT_EQ(done, kMany);
    EXPECT_EQ(interrupter.asked, 1);
}

TEST(StageStop, AStageWithinAnotherGivesItBack)
{
    StopsAt outer(kNever), inner(kNever);
    const StageProgress whole(&outer, "outer");
    LatchedInterrupter* const of_outer = stage_stop();
    {
        const StageProgress part(&inner, "inner");
        EXPECT_NE(stage_stop(), of_outer);
        // One that nobody can stop leaves the stage around it as it is.
        const StageProgress none(nullptr, "none");
        EXPECT_NE(stage_stop(), nullptr);
    }
    EXPECT_EQ(stage_stop(), of_outer);
}

TEST(StageStop, AStageToldToStopAtOnceIsClosedAllTheSame)
{
    StopsAt at_once(0);
    EXPECT_THROW(StageProgress(&at_once, "test"), Cancelled);
    EXPECT_EQ(at_once.open, 0);
}

TEST(StageStop, PartsTellTheirShareOfTheStage)
{
    StopsAt interrupter(kNever);
    const StageProgress stage(&interrupter, "test");
    const StageProgress second_half = stage.part(50, 100);
    const StageProgress last_tenth_of_it = second_half.part(90, 100);
    second_half.stop_if_interrupted(0);
    second_half.stop_if_interrupted(50);
    last_tenth_of_it.stop_if_interrupted(0);
    last_tenth_of_it.stop_if_interrupted(100);
    last_tenth_of_it.stop_if_interrupted(1000);
    EXPECT_EQ(interrupter.percents, (std::vector<int>{0, 50, 75, 95, 100, 100}));
    EXPECT_EQ(interrupter.open, 1);
}

} // namespace
} // namespace vdb_shell::test

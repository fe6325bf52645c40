// SPDX-License-Identifier: Apache-2.0
#include "command/frames.h"

#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vdb_shell::command
{
namespace
{

using Frames = std::vector<int>;

TEST(FrameRanges, EveryWayToWriteThem)
{
    const std::vector<std::pair<std::string, Frames>> cases{
        {"7", {7}},
        {"1-4", {1, 2, 3, 4}},
        {"4-1", {4, 3, 2, 1}},
        {"1-10x3", {1, 4, 7, 10}},
        {"1-9:3", {1, 4, 7}},
        {"10-1x4", {10, 6, 2}},
        {"10-1x-4", {10, 6, 2}},
        {"5,8,-3--1", {5, 8, -3, -2, -1}},
        {"-1--3", {-1, -2, -3}},
        {"-2-1", {-2, -1, 0, 1}},
        {"2--2x2", {2, 0, -2}},
        {" 1 - 3 , 9 ", {1, 2, 3, 9}},
        {"3-3x5", {3}},
        {"1-2x999999999", {1}},
        {"999999998-999999999", {999999998, 999999999}},
    };
    for (const auto& [text, frames] : cases)
        EXPECT_EQ(parse_frames(text).frames, frames) << text;
}

TEST(FrameRanges, WhatComesTwiceIsDoneOnceAndKnown)
{
    const FrameList list = parse_frames("1-3,2,5,3-4");
    EXPECT_EQ(list.frames, (Frames{1, 2, 3, 5, 4}));
    EXPECT_EQ(list.repeated, (Frames{2, 3}));
    EXPECT_EQ(parse_frames("5,5,5,5").frames, (Frames{5}));
    EXPECT_EQ(parse_frames("5,5,5,5").repeated, (Frames{5}));
    EXPECT_EQ(frames_text(parse_frames("1-3,3-1,1-3").repeated), "3-1");
}

TEST(FrameRanges, AreRefusedWithThePlace)
{
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "at its end expected the number"},
        {"a", "at character 1, \"a\", expected the number"},
        {"1-", "at its end expected the last frame"},
        {"1-5,", "at its end expected the number"},
        {"1-10y2", "at character 5, \"y2\", expected"},
        {"1 2", "at character 3, \"2\""},
        {"1-10x", "at its end expected a step"},
        {"1-10x0", "at character 5, \"x0\", a step of 0"},
        {"1-10x-2", "at character 5, \"x-2\", a step downwards does not lead from 1 to 10"},
        {"+3", "at character 1"},
        {"1.5", "at character 2, \".5\""},
        {"1--", "at character 3, \"-\", expected the last frame"},
        {"10000000000", "at most nine digits"},
        {"99999999999999999999999", "at most nine digits"},
        {"1-2000000", "more than a million frames"},
        {"1,,2", "at character 3, \",2\""},
    };
    for (const auto& [text, words] : cases)
        try {
            parse_frames(text);
            ADD_FAILURE() << text << " was taken";
        } catch (const InvalidOption& error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos)
                << text << ": " << error.what();
        }
}

TEST(FrameRanges, TextOfFramesIsReadAsTheSameFrames)
{
    const std::vector<std::pair<Frames, std::string>> cases{
        {{}, ""},
        {{4}, "4"},
        {{1, 2}, "1-2"},
        {{1, 9}, "1,9"},
        {{1, 3, 5, 9, 10, 11}, "1-5x2,9-11"},
        {{5, 4, 3}, "5-3"},
        {{9, 6, 3, 0, -3}, "9--3x-3"},
        {{1, 9, 10, 11}, "1,9-11"},
    };
    EXPECT_EQ(frames_text({5, 5, 5, 6}), "5,5,5-6");
    for (const auto& [frames, text] : cases) {
        EXPECT_EQ(frames_text(frames), text);
        if (!frames.empty()) {
            EXPECT_EQ(parse_frames(text).frames, frames) << text;
        }
    }
}

TEST(FrameTokens, EveryWayToWriteThem)
{
    const std::vector<std::array<std::string, 3>> cases{
        // name, token, frame 7
        {"a.####.obj", "####", "a.0007.obj"},
        {"a.#.obj", "#", "a.7.obj"},
        {"a@@@.obj", "@@@", "a007.obj"},
        {"a.%04d.obj", "%04d", "a.0007.obj"},
        {"a.%d.obj", "%d", "a.7.obj"},
        {"a.$F.obj", "$F", "a.7.obj"},
        {"a.$F4.obj", "$F4", "a.0007.obj"},
        {"a${F3}b.obj", "${F3}", "a007b.obj"},
        {"a${F}.obj", "${F}", "a7.obj"},
        {"$F2/a.####.vdb:grid", "$F2", "07/a.0007.vdb:grid"},
        {"--output=b/%02d/a.##.vdb", "%02d", "--output=b/07/a.07.vdb"},
        {"$F4", "$F4", "0007"},
        {"#@", "#", "77"},
    };
    for (const auto& [name, token, frame] : cases) {
        EXPECT_EQ(frame_token(name), token) << name;
        EXPECT_EQ(with_frame(name, 7), frame) << name;
    }
}

TEST(FrameTokens, NumbersLongerThanTheirTokenAndBelowZero)
{
    EXPECT_EQ(with_frame("a.##.obj", 12345), "a.12345.obj");
    EXPECT_EQ(with_frame("a.####.obj", -3), "a.-003.obj");
    EXPECT_EQ(with_frame("a.%04d.obj", -3), "a.-003.obj");
    EXPECT_EQ(with_frame("a.$F.obj", -3), "a.-3.obj");
    EXPECT_EQ(with_frame("a.#.obj", -3), "a.-3.obj");
}

TEST(FrameTokens, WhatLooksLikeOneAndIsNone)
{
    for (const char* name :
         {"a.obj", "me@home/a.obj", "take#2/a.obj", "a$FF.obj", "$FEND.obj", "a%4d.obj", "100%.obj",
          "a%.obj", "a$.obj", "$G4.obj", "${F4.obj", "a%0x.obj", "$F_.obj", ""}) {
        EXPECT_EQ(frame_token(name), "") << name;
        EXPECT_EQ(with_frame(name, 7), name);
    }
}

} // namespace
} // namespace vdb_shell::command

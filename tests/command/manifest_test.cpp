// SPDX-License-Identifier: Apache-2.0
#include "command/manifest.h"

#include "support/files.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace vdb_shell::command
{
namespace
{

using nlohmann::ordered_json;

class Manifests : public testing::Test
{
protected:
    static ManifestEntry entry(int frame, const std::string& error = "")
    {
        ManifestEntry entry;
        entry.frame = frame;
        entry.error = error;
        entry.fingerprint = "f" + std::to_string(frame);
        entry.voxel_size = 0.1 * frame;
        entry.inputs = {{"a \"quoted\" name\n", 3, "aa"}, {"b", 4, "bb"}};
        return entry;
    }

    std::vector<int> frames() const
    {
        std::vector<int> frames;
        const ordered_json json = ordered_json::parse(test::read_bytes(file_));
        for (const ordered_json& step : json.at("steps"))
            frames.push_back(step.at("frame"));
        return frames;
    }

    const test::TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_ / "m.json";
};

TEST_F(Manifests, TwoOfOneFileKeepEachOthersSteps)
{
    Manifest one(file_, "build"), other(file_, "build");
    one.put(entry(3));
    other.put(entry(1));
    other.put(entry(4));
    one.put(entry(2));
    EXPECT_EQ(frames(), (std::vector<int>{1, 2, 3, 4}));
    EXPECT_TRUE(one.find(4));
    EXPECT_FALSE(other.find(2)) << "other has not looked since";
}

// The steps of a file that nobody else has touched are not read again; those that somebody has
// taken out must not come back.
TEST_F(Manifests, WhatSomebodyElseWroteIsReadAgain)
{
    Manifest manifest(file_, "build");
    manifest.put(entry(1));
    manifest.put(entry(2));
    ordered_json json = ordered_json::parse(test::read_bytes(file_));
    json["steps"].erase(0);
    std::ofstream(file_) << json;
    manifest.put(entry(3));
    EXPECT_EQ(frames(), (std::vector<int>{2, 3}));
    std::filesystem::remove(file_);
    manifest.put(entry(4));
    EXPECT_EQ(frames(), std::vector<int>{4});
    std::ofstream(file_) << "no JSON";
    EXPECT_THROW(manifest.put(entry(5)), ReadError);
}

TEST_F(Manifests, IsOneDocumentIndentedByOne)
{
    Manifest manifest(file_, "build");
    manifest.put_all_of({});
    const auto expect_indented = [&] {
        const std::string text = test::read_bytes(file_);
        EXPECT_EQ(ordered_json::parse(text).dump(1) + "\n", text);
    };
    expect_indented();
    for (const int frame : {2, 1}) {
        manifest.put(entry(frame, "two\nlines"));
        expect_indented();
    }
}

TEST_F(Manifests, SameStepsInAnyOrderGiveTheSameFile)
{
    const auto bytes_of = [&](const std::vector<int>& order) {
        std::filesystem::remove(file_);
        Manifest manifest(file_, "build");
        for (const int frame : order)
            manifest.put(entry(frame));
        return test::read_bytes(file_);
    };
    EXPECT_EQ(bytes_of({1, 2, 3}), bytes_of({3, 1, 2, 1}));
}

} // namespace
} // namespace vdb_shell::command

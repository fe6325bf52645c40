// SPDX-License-Identifier: Apache-2.0
#include "options/near_names.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vdb_shell::test
{
namespace
{

const std::vector<std::string> kFlags{
    "--layers", "--layers-auto",      "--section-axis",  "--resolution",
    "--report", "--section-position", "--layer-grading", "-o"};

TEST(NearNames, AreThoseWithFewOtherLetters)
{
    const auto near = [](const std::string& name) { return near_names(name, kFlags); };
    using Names = std::vector<std::string>;
    EXPECT_EQ(near("--resolutoin"), Names{"--resolution"}) << "two letters exchanged";
    EXPECT_EQ(near("--resoluton"), Names{"--resolution"}) << "one left out";
    EXPECT_EQ(near("--ressolution"), Names{"--resolution"}) << "one too many";
    EXPECT_EQ(near("--reslouton"), Names{"--resolution"}) << "two of these";
    EXPECT_EQ(near("--raporx"), Names{"--report"}) << "two replaced";
    EXPECT_EQ(near("--rapoxx"), Names{}) << "three of six";
    EXPECT_EQ(near("-resolution"), Names{"--resolution"});
}

TEST(NearNames, AreThoseWithAWordThatBeginsSo)
{
    using Names = std::vector<std::string>;
    EXPECT_EQ(near_names("--section", kFlags), (Names{"--section-axis", "--section-position"}));
    EXPECT_EQ(near_names("--layer", kFlags),
              (Names{"--layers", "--layers-auto", "--layer-grading"}))
        << "the nearest first";
    EXPECT_EQ(near_names("axis", kFlags), Names{"--section-axis"});
    EXPECT_EQ(near_names("--section", {"--intersections"}), Names{});
    EXPECT_EQ(near_names("resolution", {"level_set.resolution"}), Names{"level_set.resolution"});
}

TEST(NearNames, AreFewAndNeverOfNothing)
{
    const std::vector<std::string> alike(10, "--layers");
    EXPECT_EQ(near_names("--layer", alike).size(), 4U);
    for (const std::string name : {"", "-", "--", "--x", "-o2"})
        EXPECT_TRUE(near_names(name, kFlags).empty()) << name;
    EXPECT_TRUE(near_names(std::string(1000000, 'x'), kFlags).empty());
    EXPECT_TRUE(near_names("--layers", {}).empty());
}

TEST(NearNames, EndAMessage)
{
    EXPECT_EQ(hint_of_near("--section", kFlags), "; near it: --section-axis, --section-position");
    EXPECT_EQ(hint_of_near("--nothing", kFlags), "");
}

} // namespace
} // namespace vdb_shell::test

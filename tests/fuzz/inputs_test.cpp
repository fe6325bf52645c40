// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>

// The inputs in tests/fuzz/inputs: those that the fuzzers begin with, and those that once broke
// something.

namespace vdb_shell::fuzz
{

// For GoogleTest.
static void PrintTo(const Target& target, std::ostream* out)
{
    *out << target.name;
}

namespace
{

namespace fs = std::filesystem;

class FuzzInputs : public ::testing::TestWithParam<Target>
{
};

TEST_P(FuzzInputs, BreakNoPromise)
{
    const fs::path folder = fs::path(VDB_SHELL_FUZZ_INPUTS) / GetParam().name;
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    EXPECT_FALSE(files.empty()) << folder;
    for (const fs::path& file : files)
        EXPECT_NO_THROW(GetParam().run(test::read_bytes(file))) << file;
    EXPECT_NO_THROW(GetParam().run(""));
}

INSTANTIATE_TEST_SUITE_P(Targets, FuzzInputs, ::testing::ValuesIn(targets()),
                         [](const auto& target) { return std::string(target.param.name); });

} // namespace
} // namespace vdb_shell::fuzz

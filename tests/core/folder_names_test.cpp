// SPDX-License-Identifier: Apache-2.0
#include "core/folder_names.h"

#include "support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace vdb_shell::test
{
namespace
{

namespace fs = std::filesystem;

TEST(FolderNames, AreThoseOfFilesAndFoldersWithoutTheDots)
{
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "a.txt") << "a";
    std::ofstream(folder.path() / ".hidden") << "b";
    fs::create_directory(folder.path() / "inside");
    std::error_code error;
    std::vector<std::string> names = names_in(folder.path(), error);
    EXPECT_FALSE(error);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{".hidden", "a.txt", "inside"}));
}

TEST(FolderNames, SayWhyThereAreNone)
{
    const TemporaryFolder folder;
    std::error_code error;
    EXPECT_TRUE(names_in(folder.path() / "none", error).empty());
    EXPECT_EQ(error, std::errc::no_such_file_or_directory);
    std::ofstream(folder.path() / "file") << "x";
    EXPECT_TRUE(names_in(folder.path() / "file", error).empty());
    EXPECT_EQ(error, std::errc::not_a_directory);
    EXPECT_TRUE(names_in(folder.path() / "file", error).empty());
    fs::create_directory(folder.path() / "empty");
    EXPECT_TRUE(names_in(folder.path() / "empty", error).empty());
    EXPECT_FALSE(error); // of this call, not of the last one
}

} // namespace
} // namespace vdb_shell::test

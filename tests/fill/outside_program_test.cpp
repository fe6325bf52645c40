// SPDX-License-Identifier: Apache-2.0
#include "fill/outside_program.h"

#include "support/files.h"
#include "support/stacks.h"
#include "vdb_shell/fill/fill_core.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>

// Programs that end well, badly, and not at all.

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

const fs::path kShell = "/bin/sh";

std::string message_of(const std::string& script, double seconds = 60)
{
    const fill::TemporaryFolder folder;
    try {
        fill::run_program(kShell, {"-c", script}, folder.path(), seconds, nullptr);
    } catch (const ProgramError& error) {
        return error.what();
    }
    return "ran";
}

void expect_in(const std::string& text, const std::vector<std::string>& words)
{
    for (const std::string& word : words)
        EXPECT_NE(text.find(word), std::string::npos) << '"' << word << "\" is not in: " << text;
}

TEST(OutsideProgram, GivesBackWhatTheProgramSaid)
{
    const fill::TemporaryFolder folder;
    EXPECT_EQ(
        fill::run_program(kShell, {"-c", "echo one; echo two >&2"}, folder.path(), 60, nullptr),
        "one\ntwo\n");
}

TEST(OutsideProgram, PassesWordsOnAsTheyAre)
{
    const fill::TemporaryFolder folder;
    const std::string word = "a b; $(c) 'd' \"e\" *";
    EXPECT_EQ(fill::run_program("/bin/echo", {word}, folder.path(), 60, nullptr), word + "\n");
}

TEST(OutsideProgram, HasNoInputAndItsHomeInTheFolder)
{
    const fill::TemporaryFolder folder;
    EXPECT_EQ(fill::run_program(kShell, {"-c", "cat; echo $HOME"}, folder.path(), 60, nullptr),
              folder.path().string() + "\n");
}

TEST(OutsideProgram, AFailureHasTheLastLineThatWasSaid)
{
    expect_in(message_of("echo first; echo the reason; echo; exit 3"),
              {"/bin/sh", "status 3", "it said: the reason"});
    expect_in(message_of("exit 1"), {"status 1", "it said nothing"});
    expect_in(message_of("kill -SEGV $$"), {"ended by signal 11"});
}

TEST(OutsideProgram, AProgramThatCannotBeStartedIsNamed)
{
    const fill::TemporaryFolder folder;
    EXPECT_THROW(fill::run_program(folder.path() / "none", {}, folder.path(), 60, nullptr),
                 ProgramError);
}

TEST(OutsideProgram, TheTimeLimitEndsWhatItStartedToo)
{
    const test::TemporaryFolder outside;
    const fs::path late = outside / "late";
    // The second shell would make the file after the first is gone.
    expect_in(message_of("(sleep 2; echo > '" + late.string() + "') & echo busy; sleep 60", 0.3),
              {"time limit", "it said: busy"});
    std::this_thread::sleep_for(std::chrono::milliseconds(2500));
    EXPECT_FALSE(fs::exists(late));
}

TEST(OutsideProgram, ACallerWhoStopsEndsTheProgram)
{
    const fill::TemporaryFolder folder;
    test::StopAtOnce stop;
    EXPECT_THROW(fill::run_program(kShell, {"-c", "sleep 60"}, folder.path(), 60, &stop),
                 Cancelled);
}

TEST(OutsideProgram, EndsAlsoWhereTheHostLeavesItsChildrenToTheSystem)
{
    const fill::TemporaryFolder folder;
    const auto before = std::signal(SIGCHLD, SIG_IGN);
    std::string said;
    EXPECT_NO_THROW(said =
                        fill::run_program(kShell, {"-c", "echo done"}, folder.path(), 60, nullptr));
    std::signal(SIGCHLD, before);
    EXPECT_EQ(said, "done\n");
}

TEST(OutsideProgram, TheFolderIsPrivateAndGoesWithAllThatIsInIt)
{
    fs::path path;
    {
        const fill::TemporaryFolder folder;
        path = folder.path();
        test::write_bytes(path / "file", "x");
        EXPECT_EQ(fs::status(path).permissions() & (fs::perms::group_all | fs::perms::others_all),
                  fs::perms::none);
        const fill::TemporaryFolder other;
        EXPECT_NE(other.path(), path);
    }
    EXPECT_FALSE(fs::exists(path));
}

TEST(OutsideProgram, AFolderForTemporariesThatIsNoneIsNamed)
{
    const test::TemporaryFolder outside;
    const std::string none = (outside / "none").string();
    ::setenv("TMPDIR", none.c_str(), 1);
    std::string said;
    try {
        const fill::TemporaryFolder folder;
    } catch (const WriteError& error) {
        said = error.what();
    }
    ::unsetenv("TMPDIR");
    expect_in(said, {"TMPDIR is " + none});
}

TEST(OutsideProgram, FindsProgramsOnThePathOnly)
{
    EXPECT_FALSE(fill::find_program("sh").empty());
    EXPECT_TRUE(fill::find_program("no-program-of-this-name").empty());
    EXPECT_EQ(fill::last_line("a\nb\n \n\n"), "b");
    EXPECT_EQ(fill::last_line(""), "");
}

} // namespace
} // namespace vdb_shell

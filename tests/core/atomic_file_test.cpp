// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/atomic_file.h"

#include "core/temporary_file.h"
#include "support/files.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

std::size_t files_in(const fs::path& folder)
{
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

void write_text(const fs::path& path, const std::string& text)
{
    write_stream_atomically(path, [&](std::ostream& out) { out << text; });
}

TEST(atomic_file, appears_whole_and_alone)
{
    const test::TemporaryFolder folder;
    write_text(folder / "a.txt", "first");
    EXPECT_EQ(test::read_bytes(folder / "a.txt"), "first");
    write_text(folder / "a.txt", "second");
    EXPECT_EQ(test::read_bytes(folder / "a.txt"), "second");
    EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(atomic_file, is_written_beside_its_place_under_the_same_extension)
{
    const test::TemporaryFolder folder;
    write_text(folder / "a.vdb", "old");
    write_atomically(folder / "a.vdb", [&](const fs::path& temporary) {
        EXPECT_EQ(temporary.parent_path(), folder.path());
        EXPECT_EQ(temporary.extension(), ".vdb");
        EXPECT_NE(temporary, folder / "a.vdb");
        test::write_bytes(temporary, "new");
        EXPECT_EQ(test::read_bytes(folder / "a.vdb"), "old");
    });
    EXPECT_EQ(test::read_bytes(folder / "a.vdb"), "new");
}

TEST(atomic_file, leaves_what_was_there_when_writing_fails)
{
    const test::TemporaryFolder folder;
    const fs::path path = folder / "a.txt";
    write_text(path, "old");
    auto fail_with = [&](auto error) {
        write_atomically(path, [&](const fs::path& temporary) {
            test::write_bytes(temporary, "half");
            throw error;
        });
    };
    EXPECT_THROW(fail_with(Cancelled()), Cancelled);
    try {
        fail_with(std::runtime_error("the reason"));
        FAIL() << "nothing was thrown";
    } catch (const WriteError& error) {
        EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("the reason"), std::string::npos);
    }
    EXPECT_THROW(
        write_stream_atomically(path, [](std::ostream& out) { out.setstate(std::ios::failbit); }),
        WriteError);
    EXPECT_EQ(test::read_bytes(path), "old");
    EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(atomic_file, is_refused_where_none_can_be)
{
    const test::TemporaryFolder folder;
    fs::create_directory(folder / "folder.obj");
    for (const fs::path& path : {folder / "folder.obj", folder / "missing/a.obj", folder / ""})
        EXPECT_THROW(require_writable(path), WriteError) << path;
    EXPECT_NO_THROW(require_writable(folder / "a.obj"));
    EXPECT_EQ(files_in(folder.path()), 1U);
    bool called = false;
    EXPECT_THROW(
        write_atomically(folder / "missing/a.obj", [&](const fs::path&) { called = true; }),
        WriteError);
    EXPECT_FALSE(called);
}

TEST(atomic_file, nothing_comes_into_its_place_once_a_handler_ends_the_process)
{
    const test::TemporaryFolder folder;
    {
        const CommitGuard guard;
        EXPECT_FALSE(hold_commits()) << "files are put in their places now";
    }
    write_atomically(folder / "a.txt", [](const fs::path& t) { test::write_bytes(t, "a"); });
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        const bool held = hold_commits();
        std::thread([&] {
            write_atomically(folder / "b.txt",
                             [](const fs::path& t) { test::write_bytes(t, "b"); });
        }).detach();
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        ::_exit(held && !fs::exists(folder / "b.txt") ? 0 : 1);
    }
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
}

TEST(atomic_file, temporaries_go_when_a_signal_asks)
{
    const test::TemporaryFolder folder;
    EXPECT_THROW(write_atomically(folder / "a.txt",
                                  [&](const fs::path& temporary) {
                                      test::write_bytes(temporary, "half");
                                      remove_temporaries_on_signal();
                                      EXPECT_EQ(files_in(folder.path()), 0U);
                                  }),
                 WriteError);
    EXPECT_EQ(files_in(folder.path()), 0U);
}

} // namespace
} // namespace vdb_shell

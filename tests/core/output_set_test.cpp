// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/output_set.h"

#include "support/files.h"
#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <future>
#include <iterator>
#include <new>
#include <string>
#include <vector>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;
using test::read_bytes;
using test::write_bytes;

class OutputSets : public ::testing::Test
{
protected:
    void add(OutputSet& set, const std::string& name, const std::string& text)
    {
        set.write_stream(folder / name, [&](std::ostream& out) { out << text; });
    }
    std::size_t files() const
    {
        return std::size_t(
            std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()));
    }
    mode_t mode(const std::string& name) const
    {
        struct stat status {
        };
        EXPECT_EQ(::stat((folder / name).c_str(), &status), 0);
        return status.st_mode & 07777;
    }

    test::TemporaryFolder folder;
};

TEST_F(OutputSets, AppearTogether)
{
    write_bytes(folder / "a", "old");
    OutputSet set;
    add(set, "a", "new a");
    add(set, "b", "new b");
    EXPECT_EQ(read_bytes(folder / "a"), "old");
    EXPECT_FALSE(fs::exists(folder / "b"));
    set.commit();
    EXPECT_EQ(read_bytes(folder / "a"), "new a");
    EXPECT_EQ(read_bytes(folder / "b"), "new b");
    EXPECT_EQ(files(), 2u);
}

TEST_F(OutputSets, WithoutACommitNothingHasHappened)
{
    write_bytes(folder / "a", "old");
    {
        OutputSet set;
        add(set, "a", "new");
        add(set, "b", "new");
    }
    EXPECT_EQ(read_bytes(folder / "a"), "old");
    EXPECT_EQ(files(), 1u);
}

TEST_F(OutputSets, AFaultAtTheLastFilePutsBackAllBeforeIt)
{
    write_bytes(folder / "a", "old");
    OutputSet set;
    add(set, "a", "new");
    add(set, "fresh", "new");
    add(set, "z", "new");
    // Somebody makes a folder there meanwhile, which no rename of a file can replace.
    fs::create_directory(folder / "z");
    EXPECT_THROW(set.commit(), WriteError);
    EXPECT_EQ(read_bytes(folder / "a"), "old");
    EXPECT_FALSE(fs::exists(folder / "fresh"));
    EXPECT_EQ(files(), 2u);
}

TEST_F(OutputSets, KeepsModesAndFollowsLinks)
{
    write_bytes(folder / "secret", "old");
    fs::permissions(folder / "secret", fs::perms::owner_read | fs::perms::owner_write);
    fs::create_symlink("secret", folder / "link");
    fs::create_symlink("not there yet", folder / "dangling");
    OutputSet set;
    set.write(folder / "link", [&](const fs::path& temporary) {
        struct stat status {
        };
        ASSERT_EQ(::stat(temporary.c_str(), &status), 0);
        EXPECT_EQ(status.st_mode & 0777, 0600) << "others may look on while it is written";
        write_bytes(temporary, "new");
    });
    add(set, "dangling", "new");
    set.commit();
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(read_bytes(folder / "secret"), "new");
    EXPECT_EQ(mode("secret"), 0600u);
    EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
    EXPECT_EQ(read_bytes(folder / "not there yet"), "new");
    const mode_t mask = ::umask(0);
    ::umask(mask);
    EXPECT_EQ(mode("not there yet"), 0666 & ~mask);
}

TEST_F(OutputSets, RefusesWhatIsReadOnlyOrNoFile)
{
    write_bytes(folder / "kept", "old");
    fs::permissions(folder / "kept", fs::perms::owner_read);
    fs::create_directory(folder / "folder");
    fs::create_symlink("round", folder / "round");
    OutputSet set;
    for (const char* name : {"kept", "folder", "round", "none/a"})
        EXPECT_THROW(add(set, name, "new"), WriteError) << name;
    EXPECT_EQ(read_bytes(folder / "kept"), "old");
    add(set, "a", "new");
    EXPECT_THROW(add(set, "a", "again"), WriteError);
}

TEST_F(OutputSets, KeepsWhatExistsWhenAsked)
{
    write_bytes(folder / "a", "old");
    OutputSet set(Existing::kept);
    EXPECT_THROW(add(set, "a", "new"), WriteError);
    add(set, "b", "new");
    add(set, "c", "new");
    write_bytes(folder / "c", "made by another program meanwhile");
    EXPECT_THROW(set.commit(), WriteError);
    EXPECT_FALSE(fs::exists(folder / "b"));
    EXPECT_EQ(read_bytes(folder / "c"), "made by another program meanwhile");
    add(set, "b", "new");
    set.commit();
    EXPECT_EQ(read_bytes(folder / "b"), "new");
    EXPECT_EQ(files(), 3u);
}

TEST_F(OutputSets, WritesIntoFifosAndDevices)
{
    ASSERT_EQ(::mkfifo((folder / "fifo").c_str(), 0600), 0);
    auto read = std::async(std::launch::async, [&] { return read_bytes(folder / "fifo"); });
    const std::string text(100000, 'x');
    OutputSet set;
    add(set, "fifo", text);
    add(set, "beside", "new");
    set.commit();
    EXPECT_EQ(read.get(), text);
    EXPECT_TRUE(fs::is_fifo(folder / "fifo"));
    EXPECT_EQ(read_bytes(folder / "beside"), "new");

    add(set, "beside", "newer");
    set.write_stream("/dev/full", [](std::ostream& out) { out << "text"; });
    EXPECT_THROW(set.commit(), WriteError);
    EXPECT_EQ(read_bytes(folder / "beside"), "new");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(OutputSets, LeftoversGoAndFilesInUseStay)
{
    const std::string digits = ".vdb_shell-0123456789abcdef01234567.";
    write_bytes(folder / (digits + "tmp.vdb"), "of a process that was killed");
    write_bytes(folder / (digits + "old"), "of a process that was killed");
    write_bytes(folder / ".vdb_shell-mine.tmp", "not of ours");
    const std::string used = digits + "tmp.obj";
    write_bytes(folder / used, "of a process that is at work");
    const int lock = ::open((folder / used).c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
    {
        OutputSet first, second;
        add(first, "a", "first");
        add(second, "a", "second"); // must not take the temporary of the other for a leftover
        first.commit();
        second.commit();
    }
    ::close(lock);
    EXPECT_EQ(read_bytes(folder / "a"), "second");
    EXPECT_TRUE(fs::exists(folder / used));
    EXPECT_TRUE(fs::exists(folder / ".vdb_shell-mine.tmp"));
    EXPECT_EQ(files(), 3u);
}

// Each tidies up the folder, while others make their temporaries in it.
TEST_F(OutputSets, ManyAtOnceInOneFolderLeaveEachOtherAlone)
{
    const auto work = [&](int worker) {
        for (int i = 0; i < 300; ++i) {
            OutputSet set;
            add(set, std::to_string(worker) + "." + std::to_string(i % 3), "text");
            set.commit();
        }
    };
    std::vector<std::future<void>> workers;
    for (int worker = 0; worker < 4; ++worker)
        workers.push_back(std::async(std::launch::async, work, worker));
    for (std::future<void>& worker : workers)
        EXPECT_NO_THROW(worker.get());
    EXPECT_EQ(files(), 12u);
}

TEST_F(OutputSets, NoticesThatItsTemporaryWasExchanged)
{
    write_bytes(folder / "foreign", "foreign");
    OutputSet set;
    EXPECT_THROW(set.write(folder / "a",
                           [&](const fs::path& temporary) {
                               fs::remove(temporary);
                               fs::create_symlink(folder / "foreign", temporary);
                           }),
                 WriteError);
    EXPECT_EQ(read_bytes(folder / "foreign"), "foreign");
    EXPECT_EQ(files(), 1u);
}

TEST_F(OutputSets, LackOfMemoryStaysWhatItIs)
{
    OutputSet set;
    EXPECT_THROW(set.write(folder / "a", [](const fs::path&) { throw std::bad_alloc(); }),
                 std::bad_alloc);
    EXPECT_EQ(files(), 0u);
}

} // namespace
} // namespace vdb_shell

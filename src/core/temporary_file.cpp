// SPDX-License-Identifier: Apache-2.0

// Temporary files: made exclusively, under names of 96 random bits, so that nobody can put a link
// in their way. Each is locked (flock) while its process lives. The system drops the lock of a
// process that dies however it dies, so a file of such a name without a lock is a leftover, and
// numbers of processes, which come again and mean nothing on another machine, need not be asked.
// Names under way are also noted in a table of fixed size, because a signal handler that removes
// them may neither allocate nor lock.

#include "core/temporary_file.h"

#include "core/folder_names.h"
#include "core/output_target.h"
#include "vdb_shell/core/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <random>
#include <system_error>
#include <thread>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

// Where more files than there are slots are under way, or a path is longer, the file is written all
// the same; a signal only leaves its temporary behind, for the next run to remove.
constexpr std::size_t kMaxTemporaries = 64;
constexpr std::size_t kMaxPath = 4096;
constexpr std::size_t kNoSlot = kMaxTemporaries;
struct Slot {
    std::atomic<bool> taken{false}, ready{false};
    std::array<char, kMaxPath> path{};
};
std::array<Slot, kMaxTemporaries> temporaries;
std::atomic<int> commits{0};
/// Handlers that are about to end the process.
std::atomic<int> holds{0};

constexpr const char* kPrefix = ".vdb_shell-";
constexpr std::size_t kDigits = 24;
constexpr const char* kHexadecimal = "0123456789abcdef";

std::string random_digits()
{
    std::random_device random; // the system's, which nobody can foretell
    std::string digits;
    while (digits.size() < kDigits)
        digits += kHexadecimal[random() & 15U];
    return digits;
}

/// Longer ones are none that a library would go by.
std::string short_extension(const fs::path& target)
{
    constexpr std::size_t kLongest = 16;
    const std::string extension = target.extension().string();
    return extension.size() <= kLongest ? extension : "";
}

std::size_t note(const fs::path& path)
{
    const std::string name = path.string();
    for (std::size_t i = 0; i < temporaries.size(); ++i) {
        Slot& slot = temporaries[i];
        if (slot.taken.exchange(true))
            continue;
        if (name.size() + 1 < kMaxPath) {
            std::memcpy(slot.path.data(), name.c_str(), name.size() + 1);
            // Only after the whole name is there, so a handler never sees half of one.
            slot.ready = true;
        }
        return i;
    }
    return kNoSlot;
}

bool is_name_of_ours(const std::string& name)
{
    const std::size_t prefix = std::strlen(kPrefix);
    if (name.compare(0, prefix, kPrefix) != 0 || name.size() < prefix + kDigits)
        return false;
    const std::string digits = name.substr(prefix, kDigits), rest = name.substr(prefix + kDigits);
    return digits.find_first_not_of(kHexadecimal) == std::string::npos &&
           (rest.rfind(".tmp", 0) == 0 || rest.rfind(".old", 0) == 0);
}

/// Whether the path still names the file that is open.
bool is_named(int descriptor, const fs::path& path)
{
    struct stat opened {
    }, named{};
    return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
           opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

void remove_if_left(const fs::path& path)
{
    // O_NONBLOCK, for somebody may have put a fifo there.
    const Descriptor file(
        ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
    struct stat status {
    };
    if (file.number() < 0 || ::fstat(file.number(), &status) != 0 || !S_ISREG(status.st_mode) ||
        status.st_uid != ::geteuid())
        return;
    // Another that tidies up may have removed the file since it was opened, and its owner made it
    // again: that one is locked, and this lock is of a file without a name.
    if (::flock(file.number(), LOCK_EX | LOCK_NB) == 0 && is_named(file.number(), path))
        ::unlink(path.c_str());
}

} // namespace

TemporaryName::TemporaryName(const fs::path& folder, const char* kind, const fs::path& target)
    : path_(folder / (kPrefix + random_digits() + "." + kind + short_extension(target))),
      slot_(note(path_))
{
}

TemporaryName::~TemporaryName()
{
    ::unlink(path_.c_str()); // gone already where it was put in its place
    if (slot_ == kNoSlot)
        return;
    // First not ready, then not taken: in the other order another thread could take the slot and
    // have its own mark cleared here. The file is removed before either, so there is no moment in
    // which a signal would leave it behind.
    temporaries[slot_].ready = false;
    temporaries[slot_].taken = false;
}

Descriptor::~Descriptor()
{
    reset(-1);
}

void Descriptor::reset(int number)
{
    if (number_ >= 0)
        ::close(number_);
    number_ = number;
}

TemporaryFile::TemporaryFile(const fs::path& folder, const fs::path& target, mode_t mode)
    : name_(folder, "tmp", target)
{
    // Whoever tidies up the folder in the moment before the lock takes it for a leftover: frames
    // that run at once, or other processes. The lock waits until he is done.
    constexpr int kMostTries = 100;
    for (int tries = 0; tries < kMostTries; ++tries) {
        file_.reset(
            ::open(path().c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
        if (file_.number() < 0)
            refuse_output(target, std::strerror(errno));
        // Where a file system has no locks, leftovers stay for the user to remove.
        ::flock(file_.number(), LOCK_EX);
        if (still_there())
            return;
    }
    refuse_output(target, "its temporary file was removed by another program");
}

bool TemporaryFile::still_there() const
{
    return is_named(file_.number(), path());
}

std::string no_temporary_folder(const std::error_code& why)
{
    const char* given = std::getenv("TMPDIR");
    return std::string("the folder for temporary files (TMPDIR") +
           (given ? " is " + std::string(given) : "") + ") cannot be used: " + why.message();
}

void remove_leftovers(const fs::path& folder)
{
    std::error_code unknown; // what cannot be listed stays
    for (const std::string& name : names_in(folder, unknown))
        if (is_name_of_ours(name))
            remove_if_left(folder / name);
}

CommitGuard::CommitGuard()
{
    // First counted, then asked; a handler does it in the other order. So one of the two sees the
    // other, and files are not put in their places while their temporaries are removed.
    while (++commits, holds > 0) {
        --commits;
        // Until the process ends, or the handler has let go because of another thread's commit.
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

CommitGuard::~CommitGuard()
{
    --commits;
}

bool files_are_committed_now() noexcept
{
    return commits > 0;
}

bool hold_commits() noexcept
{
    ++holds;
    if (commits == 0)
        return true;
    --holds;
    return false;
}

void remove_temporaries_on_signal() noexcept
{
    for (Slot& slot : temporaries)
        if (slot.ready)
            ::unlink(slot.path.data());
}

} // namespace vdb_shell

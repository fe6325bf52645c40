// SPDX-License-Identifier: Apache-2.0

// Files that appear whole or not at all. The data goes into a temporary file in the target's own
// folder, is flushed with fsync and then renamed over the target. POSIX replaces the old file in
// one step by a rename, but only within one file system; that is why the temporary does not stand
// in the system's folder for such files. A reader finds the old file or the new one at any moment,
// never a part. Files under way are also noted in a table of fixed size, because a signal handler
// that removes them may neither allocate nor lock. Trap: the folder itself is not flushed, so a
// power failure right after the rename may bring the old file back.

#include "vdb_shell/core/atomic_file.h"

#include "vdb_shell/core/error.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

// The names of the temporary files under way, where a signal handler can find them without
// allocating. Where more files than there are slots are under way, or a path is longer, the file is
// written all the same; a signal only leaves its temporary behind.
constexpr std::size_t kMaxTemporaries = 16;
constexpr std::size_t kMaxPath = 4096;
struct Slot {
    std::atomic<bool> taken{false}, ready{false};
    std::array<char, kMaxPath> path{};
};
std::array<Slot, kMaxTemporaries> temporaries;

class Temporary
{
public:
    explicit Temporary(const fs::path& target)
    {
        static std::atomic<unsigned> counter{0};
        // Process and counter are in the name, so that two runs, or two threads, that write the
        // same target do not write into each other's temporary.
        path_ = target.parent_path() /
                ("." + target.stem().string() + ".tmp" + std::to_string(::getpid()) + "-" +
                 std::to_string(counter++) + target.extension().string());
        for (Slot& slot : temporaries) {
            if (slot.taken.exchange(true))
                continue;
            const std::string name = path_.string();
            if (name.size() + 1 < kMaxPath) {
                std::memcpy(slot.path.data(), name.c_str(), name.size() + 1);
                // Only after the whole name is there, so a handler never sees half of one.
                slot.ready = true;
            }
            slot_ = &slot;
            break;
        }
    }
    ~Temporary()
    {
        std::error_code ignored;
        fs::remove(path_, ignored); // gone already where the rename succeeded
        if (!slot_)
            return;
        // First not ready, then not taken: in the other order another thread could take the slot
        // and have its own mark cleared here. The file is removed before either, so there is no
        // moment in which a signal would leave it behind.
        slot_->ready = false;
        slot_->taken = false;
    }
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    const fs::path& path() const { return path_; }

private:
    fs::path path_;
    Slot* slot_ = nullptr;
};

[[noreturn]] void fail(const fs::path& path, const std::string& why)
{
    throw WriteError(path.string() + ": cannot be written: " + why);
}

void flush_to_disk(const fs::path& file, const fs::path& target)
{
    const int handle = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (handle < 0)
        fail(target, std::strerror(errno));
    // A descriptor of its own is enough: fsync concerns the file, whoever wrote the data.
    const int status = ::fsync(handle);
    const int error = errno;
    ::close(handle);
    // Some file systems have no fsync; what they hold is as safe as they can make it.
    if (status != 0 && error != EINVAL && error != EROFS)
        fail(target, std::strerror(error));
}

} // namespace

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write)
{
    require_writable(path);
    const Temporary temporary(path);
    try {
        write(temporary.path());
    } catch (const Error&) {
        // Errors of this project name the file and the cause already; what a library throws seldom
        // does.
        throw;
    } catch (const std::exception& error) {
        fail(path, error.what());
    }
    flush_to_disk(temporary.path(), path);
    std::error_code error;
    fs::rename(temporary.path(), path, error);
    if (error)
        fail(path, error.message());
}

void write_stream_atomically(const fs::path& path, const std::function<void(std::ostream&)>& write)
{
    write_atomically(path, [&](const fs::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        if (!out)
            fail(path, std::strerror(errno));
        write(out);
        // Buffered data may get to the file system only here, so a full disk may show only now.
        out.close();
        if (!out)
            fail(path, "the disk is full or the file system refused the data");
    });
}

void require_writable(const fs::path& path)
{
    std::error_code error;
    if (path.filename().empty())
        fail(path, "it names no file");
    if (fs::is_directory(path, error))
        fail(path, "it is a folder");
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, error))
        fail(path, "its folder does not exist");
    // A rename needs the permission of the folder only, whatever that of the file is. This is an
    // early test, to save the user a long run; the write itself is what decides.
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        fail(path, std::strerror(errno));
}

void remove_temporaries_on_signal() noexcept
{
    for (Slot& slot : temporaries)
        if (slot.ready)
            ::unlink(slot.path.data());
}

} // namespace vdb_shell

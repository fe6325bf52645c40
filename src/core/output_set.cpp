// SPDX-License-Identifier: Apache-2.0

// Takes files one by one; leaves all of them in their places, or none. Each is written into a
// temporary of its target's own folder, since a rename replaces a file in one step only within one
// file system, and flushed. commit() first gives every file that will be replaced a second name,
// then renames; where a step fails, those names are renamed back. Trap: a process that is killed
// between two renames, or a power failure there, leaves some files new and some old, each of them
// whole.

#include "vdb_shell/core/output_set.h"

#include "core/output_target.h"
#include "core/temporary_file.h"
#include "vdb_shell/core/atomic_file.h"
#include "vdb_shell/core/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <set>
#include <string>

namespace vdb_shell
{

namespace fs = std::filesystem;

namespace
{

/// A folder of devices is no place for files.
fs::path folder_of_temporary(const OutputTarget& target)
{
    if (!target.special)
        return target.folder();
    std::error_code none;
    fs::path folder = fs::temp_directory_path(none);
    if (none)
        refuse_output(target.given, no_temporary_folder(none));
    return folder;
}

} // namespace

struct OutputSet::File {
    explicit File(OutputTarget&& where)
        : target(std::move(where)),
          // Nobody may read meanwhile what the replaced file did not let him read.
          temporary(folder_of_temporary(target), target.given, target.existing ? 0600 : 0666)
    {
    }
    OutputTarget target;
    TemporaryFile temporary;
    Descriptor old_lock;                ///< keeps others from taking `old` for a leftover
    std::unique_ptr<TemporaryName> old; ///< what stood at the target
    bool in_place = false;
};

namespace
{

/// Some file systems have no fsync; what they hold is as safe as they can make it.
bool flushed(int descriptor)
{
    return ::fsync(descriptor) == 0 || errno == EINVAL || errno == EROFS;
}

bool not_supported(int error)
{
    return error == EPERM || error == ENOTSUP || error == ENOSYS || error == EMLINK;
}

/// Mode, group and owner of the replaced file, as far as the system lets us. Access lists and
/// extended attributes are not kept.
void keep_permissions(int descriptor, const OutputTarget& target)
{
    struct stat own {
    };
    if (!target.existing || target.special || ::fstat(descriptor, &own) != 0)
        return;
    const struct stat& old = *target.existing;
    mode_t mode = old.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO);
    // One at a time, for a member of the group may keep that without being the owner.
    if (own.st_gid != old.st_gid && ::fchown(descriptor, uid_t(-1), old.st_gid) != 0)
        // Another group must not get what this one had: it gets what all others have.
        mode = (mode & ~mode_t(S_IRWXG)) | (mode & S_IRWXO) << 3;
    if (own.st_uid != old.st_uid && ::fchown(descriptor, old.st_uid, gid_t(-1)) != 0)
        errno = 0; // only the superuser may give files away
    if (::fchmod(descriptor, mode) != 0 && !not_supported(errno))
        refuse_output(target.given, std::strerror(errno));
}

/// A device or a fifo gets the bytes of the temporary.
void write_into(const OutputTarget& target, int from)
{
    const Descriptor to(::open(target.path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (to.number() < 0 || ::lseek(from, 0, SEEK_SET) != 0)
        refuse_output(target.given, std::strerror(errno));
    std::string buffer(std::size_t(1) << 16U, '\0');
    while (true) {
        const ssize_t size = ::read(from, buffer.data(), buffer.size());
        if (size == 0)
            return;
        for (ssize_t done = 0; done < size;) {
            const ssize_t more =
                ::write(to.number(), buffer.data() + done, std::size_t(size - done));
            if (more > 0)
                done += more;
            else if (more == 0 || errno != EINTR)
                refuse_output(target.given, std::strerror(errno));
        }
        if (size < 0)
            refuse_output(target.given, std::strerror(errno));
    }
}

/// What stands at the target gets a second name, and keeps the first one wherever the file system
/// has hard links.
std::unique_ptr<TemporaryName> set_aside(const OutputTarget& target, Descriptor& lock)
{
    struct stat now {
    };
    if (::lstat(target.path.c_str(), &now) != 0)
        return nullptr;
    if (!S_ISREG(now.st_mode))
        refuse_output(target.given, "what stands there was exchanged during the work");
    lock.reset(::open(target.path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    // Before it has the name, so that nobody finds it unlocked.
    if (lock.number() >= 0)
        ::flock(lock.number(), LOCK_SH | LOCK_NB);
    auto name = std::make_unique<TemporaryName>(target.folder(), "old", target.path);
    if (::link(target.path.c_str(), name->path().c_str()) != 0 &&
        (!not_supported(errno) || ::rename(target.path.c_str(), name->path().c_str()) != 0))
        refuse_output(target.given, std::strerror(errno));
    return name;
}

/// In one step, unless the file system has no hard links.
void put_where_nothing_is(const fs::path& temporary, const OutputTarget& target)
{
    if (::link(temporary.c_str(), target.path.c_str()) == 0)
        return;
    struct stat there {
    };
    if (errno == EEXIST || ::lstat(target.path.c_str(), &there) == 0)
        refuse_output(target.given, "it exists, and is to be kept (--no-clobber)");
    if (!not_supported(errno) || ::rename(temporary.c_str(), target.path.c_str()) != 0)
        refuse_output(target.given, std::strerror(errno));
}

void flush_folder(const OutputTarget& target)
{
    const Descriptor folder(::open(target.folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    // A folder that may be written but not read cannot be flushed.
    if (folder.number() >= 0 ? !flushed(folder.number()) : errno != EACCES)
        refuse_output(target.given, std::strerror(errno));
}

} // namespace

OutputSet::OutputSet(Existing existing) : existing_(existing) {}

OutputSet::~OutputSet() = default;

void OutputSet::require_free(const OutputTarget& target) const
{
    if (existing_ == Existing::kept && target.existing && !target.special)
        refuse_output(target.given, "it exists, and is to be kept (--no-clobber)");
    for (const std::unique_ptr<File>& other : files_)
        if (other->target.path == target.path)
            refuse_output(target.given, "it is written twice");
}

void OutputSet::write(const fs::path& path, const std::function<void(const fs::path&)>& write)
{
    OutputTarget target = find_output_target(path);
    require_free(target);
    const fs::path folder = folder_of_temporary(target);
    if (std::none_of(files_.begin(), files_.end(),
                     [&](const auto& file) { return folder_of_temporary(file->target) == folder; }))
        remove_leftovers(folder);
    auto file = std::make_unique<File>(std::move(target));
    const TemporaryFile& temporary = file->temporary;
    try {
        write(temporary.path());
    } catch (const Error&) {
        // Errors of this project name the file and the cause already; what a library throws seldom
        // does.
        throw;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        refuse_output(path, error.what());
    }
    if (!temporary.still_there())
        refuse_output(path, "its temporary file was removed or exchanged by another program");
    keep_permissions(temporary.descriptor(), file->target);
    // A descriptor of its own is enough: fsync concerns the file, whoever wrote the data.
    if (!file->target.special && !flushed(temporary.descriptor()))
        refuse_output(path, std::strerror(errno));
    files_.push_back(std::move(file));
}

void OutputSet::write_stream(const fs::path& path, const std::function<void(std::ostream&)>& write)
{
    this->write(path, [&](const fs::path& temporary) {
        errno = 0;
        std::ofstream out(temporary, std::ios::binary);
        if (out)
            write(out);
        // Buffered data may get to the file system only here, so a full disk may show only now.
        out.close();
        if (!out)
            refuse_output(path,
                          errno != 0 ? std::strerror(errno) : "the file system refused the data");
    });
}

void OutputSet::put_in_places()
{
    if (existing_ == Existing::replaced)
        for (const std::unique_ptr<File>& file : files_)
            file->old = set_aside(file->target, file->old_lock);
    for (const std::unique_ptr<File>& file : files_) {
        const fs::path& temporary = file->temporary.path();
        if (existing_ == Existing::kept)
            put_where_nothing_is(temporary, file->target);
        else if (::rename(temporary.c_str(), file->target.path.c_str()) != 0)
            refuse_output(file->target.given, std::strerror(errno));
        file->in_place = true;
    }
    std::set<fs::path> folders;
    for (const std::unique_ptr<File>& file : files_)
        if (folders.insert(file->target.folder()).second)
            flush_folder(file->target);
}

void OutputSet::put_back() noexcept
{
    for (const std::unique_ptr<File>& file : files_)
        if (file->old)
            ::rename(file->old->path().c_str(), file->target.path.c_str());
        else if (file->in_place)
            ::unlink(file->target.path.c_str());
}

void OutputSet::commit()
{
    // What cannot be undone comes first: where it fails, nothing has been replaced.
    for (const std::unique_ptr<File>& file : files_)
        if (file->target.special)
            write_into(file->target, file->temporary.descriptor());
    const auto last = std::remove_if(files_.begin(), files_.end(),
                                     [](const auto& file) { return file->target.special; });
    files_.erase(last, files_.end());
    const CommitGuard guard;
    try {
        put_in_places();
    } catch (...) {
        put_back();
        files_.clear();
        throw;
    }
    files_.clear(); // removes temporaries and what was set aside
}

void write_together(OutputSet* with, const std::function<void(OutputSet&)>& write)
{
    if (with)
        return write(*with);
    OutputSet alone;
    write(alone);
    alone.commit();
}

} // namespace vdb_shell

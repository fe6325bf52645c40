// SPDX-License-Identifier: Apache-2.0

// Loaded in front of the C library (LD_PRELOAD): the n-th call that could change a folder fails, as
// on a full or broken disk. Environment: FAULT_FOLDER, FAULT_AT (n, from 1), FAULT_LOG (a file that
// gets the name of the call that failed), FAULT_NO_LINKS (no hard links, as on FAT). Only single
// faults: what is done to put things right works.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace
{

std::atomic<long> calls{0};

bool in_folder(const char* path)
{
    const char* folder = std::getenv("FAULT_FOLDER");
    return folder && path && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool in_folder(int descriptor)
{
    std::array<char, 4096> path{};
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    return ::readlink(link.c_str(), path.data(), path.size() - 1) > 0 && in_folder(path.data());
}

/// By numbers of calls, for those by name are the ones below.
void note(const char* what)
{
    const char* log = std::getenv("FAULT_LOG");
    if (!log)
        return;
    const long file = ::syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (file >= 0) {
        ::syscall(SYS_write, file, what, std::strlen(what));
        ::syscall(SYS_close, file);
    }
}

bool fails(bool concerned, const char* what, int error)
{
    const char* at = std::getenv("FAULT_AT");
    if (!concerned || !at || ++calls != std::atol(at))
        return false;
    note(what);
    errno = error;
    return true;
}

template <typename Function> Function next(const char* name)
{
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

int opened(const char* name, const char* path, int flags, mode_t mode)
{
    if (fails(in_folder(path) && (flags & O_ACCMODE) != O_RDONLY, "open", EMFILE))
        return -1;
    return next<int (*)(const char*, int, ...)>(name)(path, flags, mode);
}

FILE* opened(const char* name, const char* path, const char* mode)
{
    if (fails(in_folder(path) && mode[0] != 'r', "fopen", EMFILE))
        return nullptr;
    return next<FILE* (*)(const char*, const char*)>(name)(path, mode);
}

mode_t mode_of(int flags, va_list rest)
{
    return (flags & O_CREAT) != 0 ? va_arg(rest, mode_t) : 0;
}

} // namespace

extern "C" {

int open(const char* path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = mode_of(flags, rest);
    va_end(rest);
    return opened("open", path, flags, mode);
}
int open64(const char* path, int flags, ...)
{
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = mode_of(flags, rest);
    va_end(rest);
    return opened("open64", path, flags, mode);
}
FILE* fopen(const char* path, const char* mode)
{
    return opened("fopen", path, mode);
}
FILE* fopen64(const char* path, const char* mode)
{
    return opened("fopen64", path, mode);
}
ssize_t write(int file, const void* bytes, size_t size)
{
    if (fails(in_folder(file), "write", ENOSPC))
        return -1;
    return next<ssize_t (*)(int, const void*, size_t)>("write")(file, bytes, size);
}
ssize_t writev(int file, const struct iovec* parts, int count)
{
    if (fails(in_folder(file), "writev", ENOSPC))
        return -1;
    return next<ssize_t (*)(int, const struct iovec*, int)>("writev")(file, parts, count);
}
int fsync(int file)
{
    return fails(in_folder(file), "fsync", EIO) ? -1 : next<int (*)(int)>("fsync")(file);
}
int fchmod(int file, mode_t mode) noexcept
{
    return fails(in_folder(file), "fchmod", EIO) ? -1
                                                 : next<int (*)(int, mode_t)>("fchmod")(file, mode);
}
int rename(const char* from, const char* to) noexcept
{
    if (fails(in_folder(to), "rename", EIO))
        return -1;
    return next<int (*)(const char*, const char*)>("rename")(from, to);
}
int link(const char* from, const char* to) noexcept
{
    if (std::getenv("FAULT_NO_LINKS") && in_folder(to)) {
        errno = EPERM;
        return -1;
    }
    if (fails(in_folder(to), "link", EIO))
        return -1;
    return next<int (*)(const char*, const char*)>("link")(from, to);
}

} // extern "C"

// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/io/vdb_header.h"
#include "vdb_shell/write/vdb_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>

namespace vdb_shell::fuzz
{
namespace
{

/// A file in memory, for OpenVDB reads files only. One for all inputs, for to make and
/// remove one takes as long as to read most of them.
class MemoryFile
{
public:
    MemoryFile()
        : descriptor_(::memfd_create("fuzz.vdb", 0)),
          path_("/proc/self/fd/" + std::to_string(descriptor_))
    {
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    const std::filesystem::path& holding(std::string_view bytes) const
    {
        if (::ftruncate(descriptor_, 0) != 0 ||
            ::pwrite(descriptor_, bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
            throw std::runtime_error("there is no file in memory");
        return path_;
    }

private:
    int descriptor_;
    std::filesystem::path path_;
};

} // namespace

void vdb(std::string_view bytes)
{
    try {
        // All readers begin with it; what it refuses need not be put into a file.
        require_whole_vdb(bytes, "fuzz");
    } catch (const ReadError&) {
        return;
    }
    static const MemoryFile file;
    const std::filesystem::path& path = file.holding(bytes);
    try {
        read_shell_vdb(path);
    } catch (const ReadError&) {
    }
    try {
        read_float_grid(path, "");
    } catch (const ReadError&) {
    }
}

} // namespace vdb_shell::fuzz

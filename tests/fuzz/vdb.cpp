// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/write/vdb_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>

namespace vdb_shell::fuzz
{
namespace
{

/// A file in memory, for OpenVDB reads files only.
class MemoryFile
{
public:
    explicit MemoryFile(std::string_view bytes) : descriptor_(::memfd_create("fuzz.vdb", 0))
    {
        if (descriptor_ < 0 || ::write(descriptor_, bytes.data(), bytes.size()) < 0)
            throw std::runtime_error("there is no file in memory");
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

} // namespace

void vdb(std::string_view bytes)
{
    const MemoryFile file(bytes);
    try {
        read_shell_vdb(file.path());
    } catch (const ReadError&) {
    }
    try {
        read_float_grid(file.path(), "");
    } catch (const ReadError&) {
    }
}

} // namespace vdb_shell::fuzz

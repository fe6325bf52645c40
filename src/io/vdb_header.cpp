// SPDX-License-Identifier: Apache-2.0

// Walks the outer form of a .vdb file, header, metadata and the table of grids, before OpenVDB gets
// to read it, because OpenVDB does not notice a file that ends too early. No length is believed:
// each is held against what is left of the file, so no memory is taken by a damaged number, and
// each turn of a loop reads at least some bytes, so that a wrong count ends at the end of the file.
// Grids are skipped, not read; the time does not depend on their size. Numbers are in the byte
// order of the machine, as OpenVDB writes them. Trap: what is inside a grid may still be damaged.

#include "vdb_shell/io/vdb_header.h"

#include "vdb_shell/core/error.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

// Before version 222 voxels were compressed in another way.
constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldestVersion = 222, kNewestVersion = 224;
constexpr std::uint64_t kUuidLength = 36;

/// A file being walked; every read is held against what is left of it.
class Walk
{
public:
    explicit Walk(const fs::path& path) : name_(path.string())
    {
        std::error_code error;
        const fs::file_status status = fs::status(path, error);
        if (!fs::exists(status))
            fail("there is no such file");
        if (!fs::is_regular_file(status))
            fail("it is not a regular file");
        size_ = fs::file_size(path, error);
        stream_.open(path, std::ios::binary);
        if (error || !stream_)
            fail(std::string("cannot be opened: ") + std::strerror(errno));
    }

    template <typename T> T number(const char* what)
    {
        T value{};
        need(sizeof value, what);
        stream_.read(reinterpret_cast<char*>(&value), sizeof value);
        at_ += sizeof value;
        return value;
    }

    /// A length followed by that many bytes; only short ones are kept.
    std::string text(const char* what)
    {
        constexpr std::uint32_t kKept = 256;
        const auto length = number<std::uint32_t>(what);
        need(length, what);
        std::string value(std::min(length, kKept), '\0');
        stream_.read(value.data(), std::streamsize(value.size()));
        go_to(at_ + length);
        return value;
    }

    void skip(std::uint64_t bytes, const char* what)
    {
        need(bytes, what);
        go_to(at_ + bytes);
    }

    void go_to(std::uint64_t place)
    {
        stream_.seekg(std::streamoff(place));
        at_ = place;
    }

    [[noreturn]] void fail(const std::string& what) const { throw ReadError(name_ + ": " + what); }
    std::uint64_t size() const { return size_; }
    std::uint64_t at() const { return at_; }

private:
    void need(std::uint64_t bytes, const char* what) const
    {
        // Written as a difference, which cannot overflow: the place is never beyond the end.
        if (bytes > size_ - at_)
            fail(std::string("the file is truncated or damaged: ") + what + " at byte " +
                 std::to_string(at_) + " needs " + std::to_string(bytes) + " bytes, the file has " +
                 std::to_string(size_));
    }

    std::string name_;
    std::ifstream stream_;
    std::uint64_t size_ = 0, at_ = 0;
};

void walk_metadata(Walk& walk)
{
    const auto count = walk.number<std::uint32_t>("the number of metadata");
    for (std::uint32_t i = 0; i < count; ++i) {
        walk.text("a metadata name");
        walk.text("a metadata type");
        walk.skip(walk.number<std::uint32_t>("a metadata size"), "a metadata value");
    }
}

void walk_grids(Walk& walk)
{
    const auto count = walk.number<std::int32_t>("the number of grids");
    if (count < 0)
        walk.fail("the number of grids is " + std::to_string(count));
    for (std::int32_t i = 0; i < count; ++i) {
        std::string name = walk.text("a grid's name");
        // Where names repeat, a separator and a number follow.
        constexpr char kSeparator = 30;
        name = name.substr(0, name.find(kSeparator));
        walk.text("a grid's type");
        walk.text("a grid's instance parent");
        const auto grid = walk.number<std::int64_t>("a grid's position");
        const auto blocks = walk.number<std::int64_t>("a grid's block position");
        const auto end = walk.number<std::int64_t>("a grid's end");
        // Grids stand one after the other behind their descriptors, so each position must be at or
        // behind the one before; that also keeps the walk from running in a circle.
        const bool ordered = grid >= std::int64_t(walk.at()) && blocks >= grid && end >= blocks;
        if (!ordered || std::uint64_t(end) > walk.size())
            walk.fail("the file is truncated or damaged: grid \"" + name +
                      "\" is said to span bytes " + std::to_string(grid) + " to " +
                      std::to_string(end) + ", the file has " + std::to_string(walk.size()));
        walk.go_to(std::uint64_t(end));
    }
}

} // namespace

void require_whole_vdb(const fs::path& path)
{
    Walk walk(path);
    if (walk.size() == 0)
        walk.fail("the file is empty");
    if (walk.size() < sizeof kMagic || walk.number<std::int64_t>("the magic number") != kMagic)
        walk.fail("it is not a .vdb file: it does not begin with OpenVDB's magic number");
    const auto version = walk.number<std::uint32_t>("the format version");
    if (version < kOldestVersion || version > kNewestVersion)
        walk.fail("its .vdb format version is " + std::to_string(version) + ", versions " +
                  std::to_string(kOldestVersion) + " to " + std::to_string(kNewestVersion) +
                  " can be read");
    walk.skip(2 * sizeof(std::uint32_t), "the library version");
    const bool has_offsets = walk.number<char>("the offsets flag") != 0;
    walk.skip(kUuidLength, "the UUID");
    walk_metadata(walk);
    // A file written as a stream has no table of grids to check.
    if (has_offsets)
        walk_grids(walk);
}

} // namespace vdb_shell

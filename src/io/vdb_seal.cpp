// SPDX-License-Identifier: Apache-2.0

// The digest of a .vdb's bytes, in the one place of the file that its own digest can stand in: the
// UUID, which OpenVDB draws at random and reads as a name and no more. A mark at its start tells it
// from a random one. One flipped bit changes one character of the mark, so a mark with one wrong
// character is a damaged seal and not a missing one; a random UUID has seven of its eight
// characters with probability 3e-8. What is in the entry with the digests finds the damaged part,
// and decides nothing.

#include "io/vdb_seal.h"

#include "core/text_stream.h"
#include "io/vdb_walk.h"
#include "vdb_shell/core/digest.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/io/read_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <vector>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

constexpr std::string_view kMark = "7664625f"; ///< "vdb_"
constexpr std::size_t kPartDigits = 16;

/// All of them but for the UUID. Precondition: the bytes begin where the file does, and hold it.
void add_without_uuid(Digest& digest, std::string_view bytes)
{
    digest.add(bytes.data(), kUuid);
    digest.add(bytes.data() + kUuid + kUuidLength, bytes.size() - kUuid - kUuidLength);
}

std::string uuid_of(const Digest& digest)
{
    // A UUID of version 8, whose bits are free but for these two digits.
    const std::string hex = digest.hex();
    return std::string(kMark) + "-" + hex.substr(0, 4) + "-8" + hex.substr(4, 3) + "-8" +
           hex.substr(7, 3) + "-" + hex.substr(10, 12);
}

std::string uuid_of(std::string_view bytes)
{
    Digest digest;
    add_without_uuid(digest, bytes);
    return uuid_of(digest);
}

bool has_seal(std::string_view bytes)
{
    if (bytes.size() < kUuid + kUuidLength)
        return false;
    std::size_t same = 0;
    for (std::size_t i = 0; i < kMark.size(); ++i)
        same += bytes[kUuid + i] == kMark[i];
    // One wrong character is let pass here, so that check_seal finds the file damaged and not
    // without a seal.
    return same + 1 >= kMark.size();
}

/// A part of the file, and where the digits of its bytes' digest stand.
struct Part {
    std::string name;
    std::string digits;
    std::size_t place = 0; ///< of the digits, 0 where there is no room for them
};

std::string digits_of(const std::array<std::uint64_t, 2>& digest)
{
    return hex_of(digest).substr(0, kPartDigits);
}

const VdbEntry* digests_entry(const VdbOutline& outline)
{
    for (const VdbEntry& entry : outline.metadata)
        if (entry.name == kDigestsKey)
            return &entry;
    return nullptr;
}

/// All bytes before the first grid but for the UUID and the entry with the digests.
std::string head_digits(std::string_view bytes, const VdbOutline& outline, const VdbEntry& entry)
{
    const std::size_t end = outline.grids.empty() ? bytes.size() : outline.grids[0].descriptor;
    const auto begin = std::size_t(entry.value.data() - bytes.data());
    const std::size_t behind = begin + entry.value.size();
    Digest digest;
    digest.add(bytes.data(), kUuid);
    digest.add(bytes.data() + kUuid + kUuidLength, begin - kUuid - kUuidLength);
    digest.add(bytes.data() + behind, end - behind);
    return digits_of(digest.words());
}

/// Where the digits of a part stand: a line of three words that begins with its name.
std::size_t place_of(std::string_view bytes, const VdbEntry& entry, const std::string& name)
{
    std::size_t line = 0;
    while (line < entry.value.size()) {
        const std::size_t end = std::min(entry.value.find('\n', line), entry.value.size());
        InText words{std::string(entry.value.substr(line, end - line))};
        std::string first, values, digits;
        // Lines of attributes have two words only, for their values lie scattered among the bytes
        // of their grid.
        if (words >> first >> values >> digits && first == name && digits.size() == kPartDigits)
            return std::size_t(entry.value.data() - bytes.data()) + end - kPartDigits;
        line = end + 1;
    }
    return 0;
}

/// The file's metadata, and its grids, whose digests are given.
std::vector<Part> parts_of(std::string_view bytes, const VdbOutline& outline,
                           const std::vector<VdbArchive::Grid>& grids)
{
    std::vector<Part> parts;
    const VdbEntry* const entry = digests_entry(outline);
    if (!entry)
        return parts;
    parts.push_back({"metadata", head_digits(bytes, outline, *entry), 0});
    for (const VdbArchive::Grid& grid : grids)
        parts.push_back({grid.name, digits_of(grid.digest), 0});
    for (Part& part : parts)
        part.place = place_of(bytes, *entry, part.name);
    return parts;
}

/// The bytes of the file between two places. A failure stays noted in the stream.
void add_between(Digest& digest, std::fstream& file, std::uint64_t begin, std::uint64_t end)
{
    // Small enough for the processor's cache, so that a large file costs no memory.
    constexpr std::uint64_t kPiece = std::uint64_t(1) << 18;
    std::vector<char> piece(kPiece);
    file.seekg(std::streamoff(begin));
    for (std::uint64_t size = 0; begin < end && file; begin += size) {
        size = std::min(kPiece, end - begin);
        file.read(piece.data(), std::streamsize(size));
        digest.add(piece.data(), size);
    }
}

/// What differs, in words. Precondition: something does.
std::string damaged_part(std::string_view bytes, const std::string& name)
{
    VdbCursor walk(bytes, name);
    const VdbOutline outline = walk_outline(walk);
    std::vector<VdbArchive::Grid> grids;
    for (const VdbGridPart& grid : outline.grids)
        grids.push_back(
            {grid.name, digest_of(bytes.data() + grid.descriptor, grid.end - grid.descriptor)});
    for (const Part& part : parts_of(bytes, outline, grids))
        if (part.place && bytes.substr(part.place, kPartDigits) != part.digits)
            return part.name == "metadata" ? "its metadata"
                                           : "grid " + vdb_shell::quoted(part.name);
    return "no grid and no other metadata but the digests themselves";
}

} // namespace

void seal_vdb(const fs::path& path, const VdbArchive& written)
{
    std::string head = written.head;
    errno = 0;
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    const auto put = [&](std::size_t place, const std::string& text) {
        head.replace(place, text.size(), text);
        file.seekp(std::streamoff(place));
        file.write(text.data(), std::streamsize(text.size()));
    };
    VdbCursor walk(written.head, path.string());
    for (const Part& part : parts_of(written.head, walk_head(walk), written.grids))
        if (part.place)
            put(part.place, part.digits);
    // Last, as it is the digest of all other bytes, those of the parts' digests among them.
    Digest digest;
    add_without_uuid(digest, head);
    add_between(digest, file, head.size(), written.size);
    put(kUuid, uuid_of(digest));
    file.close();
    if (!file)
        throw std::runtime_error("the digests of the bytes cannot be written" +
                                 (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

bool check_seal(std::string_view bytes, const std::string& name)
{
    if (!has_seal(bytes))
        return false;
    if (bytes.substr(kUuid, kUuidLength) != uuid_of(bytes))
        throw ReadError(name +
                        ": the file is damaged: its bytes are not those that were written; " +
                        damaged_part(bytes, name) + " differs");
    return true;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Walks all bytes of a .vdb that OpenVDB is going to decode, before it does, for OpenVDB 10 trusts
// what it reads: it notices neither the end of a file nor a length that does not fit
// (docs/security.md has the argument why what passes is safe). No length is believed: each is held
// against what is left of the file, so no memory is taken by a damaged number, and each turn of a
// loop reads at least some bytes, so that a wrong count ends at the end of the file. Grids of other
// types than floats and points are skipped behind their transform; nothing decodes them. Trap: this
// has to read exactly what OpenVDB reads, no more and no less.

#include "vdb_shell/io/vdb_header.h"

#include "core/grid_instances.h"
#include "io/vdb_seal.h"
#include "io/vdb_walk.h"
#include "vdb_shell/io/read_file.h"

#include <openvdb/io/Compression.h>

#include <cctype>
#include <string>

namespace vdb_shell
{
namespace
{

namespace fs = std::filesystem;

// Before version 222 voxels were compressed in another way; before 224 points were stored in
// another.
constexpr std::int64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldestVersion = 222, kNewestVersion = 224, kPointsVersion = 224;
constexpr const char* kFloats = "Tree_float_5_4_3";
constexpr const char* kVectors = "Tree_vec3s_5_4_3";
constexpr const char* kWholeNumbers = "Tree_int32_5_4_3";
constexpr const char* kPoints = "Tree_ptdataidx32_5_4_3";
constexpr std::string_view kHalfMark = "_HalfFloat";

/// Hexadecimal digits and the dashes between them. OpenVDB 10 reads it as formatted text and passes
/// over white space, so a UUID with any would be longer for OpenVDB than for the walk, and all that
/// follows another thing.
bool is_uuid(std::string_view text)
{
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool dash = i == 8 || i == 13 || i == 18 || i == 23;
        if (dash ? text[i] != '-' : !std::isxdigit(static_cast<unsigned char>(text[i])))
            return false;
    }
    return true;
}

std::uint32_t walk_header(VdbCursor& walk)
{
    if (walk.size() == 0)
        walk.fail("the file is empty");
    if (walk.size() < sizeof kMagic || walk.number<std::int64_t>("the magic number") != kMagic)
        walk.fail("it is not a .vdb file: it does not begin with OpenVDB's magic number");
    const auto version = walk.number<std::uint32_t>("the format version");
    if (version < kOldestVersion || version > kNewestVersion)
        walk.fail("its .vdb format version is " + std::to_string(version) + ", versions " +
                  std::to_string(kOldestVersion) + " to " + std::to_string(kNewestVersion) +
                  " can be read");
    walk.take(2 * sizeof(std::uint32_t), "the library version");
    const auto offsets = walk.number<std::uint8_t>("the offsets flag");
    // Of a stream OpenVDB decodes all grids when it is opened, of whatever type they are.
    if (offsets == 0)
        walk.fail("it was written as a stream, without the places of its grids, and cannot be "
                  "checked before it is decoded; write it as a file");
    walk.require(offsets == 1, "the offsets flag is neither 0 nor 1");
    walk.require(is_uuid(walk.take(kUuidLength, "the UUID")), "the UUID is none");
    return version;
}

/// A name without the number that stands behind it, and a separator, where names repeat.
std::string plain_name(std::string_view name)
{
    constexpr char kSeparator = 30;
    return std::string(name.substr(0, name.find(kSeparator)));
}

VdbGridPart walk_descriptor(VdbCursor& walk)
{
    VdbGridPart part;
    part.descriptor = walk.at();
    part.name = plain_name(walk.text("a grid's name"));
    part.type = walk.text("a grid's type");
    if (part.type.size() >= kHalfMark.size() &&
        part.type.compare(part.type.size() - kHalfMark.size(), kHalfMark.size(), kHalfMark) == 0) {
        part.half = true;
        part.type.resize(part.type.size() - kHalfMark.size());
    }
    const std::string_view parent = walk.text("a grid's instance parent");
    part.parent = plain_name(parent);
    walk.require(part.parent.empty() == parent.empty(), "a tree shared with a grid without a name");
    const auto grid = walk.number<std::int64_t>("a grid's position");
    const auto blocks = walk.number<std::int64_t>("a grid's block position");
    const auto end = walk.number<std::int64_t>("a grid's end");
    // Grids stand one after the other behind their descriptors, so each position must be at or
    // behind the one before; that also keeps the walk from running in a circle.
    // Where there is no tree of its own there are no blocks, and OpenVDB writes 0.
    const bool ordered = grid >= std::int64_t(walk.at()) && end >= grid &&
                         (!part.parent.empty() || (blocks >= grid && end >= blocks));
    if (!ordered || std::uint64_t(end) > walk.size())
        walk.fail("the file is truncated or damaged: grid " + vdb_shell::quoted(part.name) +
                  " is said to span bytes " + std::to_string(grid) + " to " + std::to_string(end) +
                  ", the file has " + std::to_string(walk.size()));
    part.grid = std::uint64_t(grid);
    part.blocks = std::uint64_t(blocks);
    part.end = std::uint64_t(end);
    return part;
}

/// OpenVDB reads half floats where the metadata say so, whatever the descriptor says.
bool is_half(const VdbCursor& walk, const VdbGridPart& part, const std::vector<VdbEntry>& metadata)
{
    bool stated = false;
    for (const VdbEntry& entry : metadata)
        if (entry.name == openvdb::GridBase::META_SAVE_HALF_FLOAT) {
            walk.require(entry.type == "bool", "a mark of half floats that is no bool");
            stated = entry.value[0] != 0;
        }
    walk.require(stated == part.half, "half floats in one place and not in another");
    return stated;
}

/// Reading a grid that shares a tree decodes the other grid, found by its name and of whatever
/// type.
void require_parents(const VdbCursor& walk, const std::vector<VdbGridPart>& grids)
{
    for (const VdbGridPart& part : grids) {
        if (part.parent.empty())
            continue;
        bool found = false;
        for (const VdbGridPart& other : grids) {
            // OpenVDB looks for "name[2]" before it takes that for the second grid of this name.
            if (!other.name.empty() && other.name.back() == ']')
                walk.fail("grid " + vdb_shell::quoted(other.name) +
                          " has a name like that of a repeated one, in a file with shared trees");
            if (other.name != part.parent)
                continue;
            found = true;
            if (other.type != part.type)
                walk.fail("grid " + vdb_shell::quoted(part.name) + " shares the tree of " +
                          vdb_shell::quoted(other.name) + ", which is of another type");
        }
        if (!found)
            walk.fail("grid " + vdb_shell::quoted(part.name) + " shares the tree of " +
                      vdb_shell::quoted(part.parent) + ", which is not there");
    }
}

void walk_grid(VdbCursor& walk, const VdbGridPart& part, std::uint32_t version)
{
    using namespace openvdb::io;
    walk.enter_grid(part.name);
    walk.go_to(part.grid);
    VdbCoding coding;
    coding.compression = walk.number<std::uint32_t>("the compression");
    constexpr std::uint32_t kKnown = COMPRESS_ZIP | COMPRESS_ACTIVE_MASK | COMPRESS_BLOSC;
    walk.require((coding.compression & ~kKnown) == 0, "an unknown compression");
    const std::vector<VdbEntry> metadata = walk_metadata(walk);
    walk_transform(walk);
    const bool points = part.type == kPoints;
    const bool known =
        points || part.type == kFloats || part.type == kVectors || part.type == kWholeNumbers;
    if (!part.parent.empty() || !known)
        return;
    if (points && version < kPointsVersion)
        walk.fail("its points are of .vdb format version " + std::to_string(version) +
                  ", those of version " + std::to_string(kPointsVersion) + " can be read");
    if (part.type == kVectors)
        coding.value_bytes = 3 * sizeof(float);
    // The mark changes how OpenVDB reads real numbers only.
    coding.half = is_half(walk, part, metadata) && !points && part.type != kWholeNumbers;
    coding.points = points;
    const std::vector<std::uint16_t> leaves = walk_topology(walk, coding);
    walk.require(walk.at() == part.blocks, "the topology does not end where the voxels begin");
    if (points)
        walk_points(walk, leaves.size());
    else
        walk_voxels(walk, coding, leaves);
    walk.require(walk.at() == part.end, "the grid does not end where its descriptor says");
}

} // namespace

VdbOutline walk_head(VdbCursor& walk)
{
    VdbOutline outline;
    outline.version = walk_header(walk);
    outline.metadata = walk_metadata(walk);
    return outline;
}

VdbOutline walk_outline(VdbCursor& walk)
{
    VdbOutline outline = walk_head(walk);
    const auto count = walk.number<std::int32_t>("the number of grids");
    if (count < 0)
        walk.fail("the number of grids is " + std::to_string(count));
    for (std::int32_t i = 0; i < count; ++i) {
        outline.grids.push_back(walk_descriptor(walk));
        walk.go_to(outline.grids.back().end);
    }
    require_parents(walk, outline.grids);
    return outline;
}

void require_whole_vdb(std::string_view bytes, const std::string& name)
{
    // The walk asks OpenVDB for the sizes of the types that it knows.
    openvdb::initialize();
    VdbCursor walk(bytes, name);
    const VdbOutline outline = walk_outline(walk);
    // Most damage ends here. What was sealed by somebody who means harm is walked all the same.
    check_seal(bytes, name);
    for (const VdbGridPart& part : outline.grids)
        walk_grid(walk, part, outline.version);
}

void require_whole_vdb(const fs::path& path)
{
    require_whole_vdb(read_whole_file(path), path.string());
}

} // namespace vdb_shell

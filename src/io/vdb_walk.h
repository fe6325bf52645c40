// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/vdb_cursor.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

// The parts of the walk over a .vdb's bytes that require_whole_vdb is made of. Each throws
// ReadError where OpenVDB 10's decoder would read or write outside of what is there, or would take
// other bytes for a thing than the walk does.

namespace vdb_shell
{

/// Where the header has the file's UUID, and its length in characters.
constexpr std::size_t kUuid = 21, kUuidLength = 36;

struct VdbEntry {
    std::string_view name, type, value;
};

/// A grid as its descriptor tells it.
struct VdbGridPart {
    std::string name; ///< without the number that tells equal names apart
    std::string type; ///< without the mark of half floats
    bool half = false;
    std::string parent; ///< the grid whose tree it shares, so that it has none in the file; or ""
    std::uint64_t descriptor = 0, grid = 0, blocks = 0, end = 0; ///< bytes
};

struct VdbOutline {
    std::uint32_t version = 0;
    std::vector<VdbEntry> metadata;
    std::vector<VdbGridPart> grids;
};

/// Header and metadata of the file; no grids.
VdbOutline walk_head(VdbCursor& walk);

/// Header, metadata of the file, descriptors of the grids.
VdbOutline walk_outline(VdbCursor& walk);

/// A map of metadata: the value of every type that OpenVDB knows has that type's size and form.
std::vector<VdbEntry> walk_metadata(VdbCursor& walk);

/// A grid's transform.
void walk_transform(VdbCursor& walk);

/// A chunk of Blosc that stands for `bytes` bytes, by its own header.
bool is_blosc_of(std::string_view chunk, std::uint64_t bytes);

/// How a grid's values are stored.
struct VdbCoding {
    std::uint64_t value_bytes = 4; ///< of a float, a whole number or an index; of vectors 12
    std::uint32_t compression = 0; ///< OpenVDB's flags
    bool half = false;             ///< floats as two bytes
    bool points = false;           ///< indices of points
};

/// The topology of a tree of OpenVDB's standard shape (5, 4, 3); for each leaf, in the order of the
/// file, how many of its voxels are active.
std::vector<std::uint16_t> walk_topology(VdbCursor& walk, const VdbCoding& coding);

/// The voxels of a tree of floats, of vectors of floats, or of whole numbers.
void walk_voxels(VdbCursor& walk, const VdbCoding& coding,
                 const std::vector<std::uint16_t>& leaves);

/// The voxels and attributes of a tree of points with that many leaves.
void walk_points(VdbCursor& walk, std::size_t leaves);

} // namespace vdb_shell

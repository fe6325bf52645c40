// SPDX-License-Identifier: Apache-2.0

// Topology and voxels of a tree, walked as OpenVDB's RootNode, InternalNode and LeafNode read them.
// Nodes follow depth first, the children of a node in the order of its mask, so the places of all
// that follows depend on the masks; they are kept as numbers of active voxels for the second pass,
// which has the voxels. Values are not looked at, but for what says how many there are, and for
// blocks in the topology: OpenVDB 10 leaks a node whose own values do not decompress.

#include "io/vdb_walk.h"

#include <openvdb/Types.h>
#include <openvdb/io/Compression.h>

#include <blosc.h>
#include <zlib.h>

#include <algorithm>
#include <array>

namespace vdb_shell
{
namespace
{

using openvdb::io::COMPRESS_ACTIVE_MASK;
using openvdb::io::COMPRESS_BLOSC;
using openvdb::io::COMPRESS_ZIP;

/// Values of a node by its level: a leaf, and the two kinds of inner nodes.
constexpr std::array<std::uint32_t, 3> kNodeValues{512, 4096, 32768};
constexpr std::int32_t kRootChild = 4096; ///< voxels along an edge of a child of the root

std::uint32_t count_bits(std::string_view mask)
{
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < mask.size(); i += sizeof(std::uint64_t)) {
        std::uint64_t word = 0;
        std::memcpy(&word, mask.data() + i, sizeof word);
        count += std::uint32_t(__builtin_popcountll(word));
    }
    return count;
}

bool disjoint(std::string_view a, std::string_view b)
{
    for (std::size_t i = 0; i < a.size(); ++i)
        if (a[i] & b[i])
            return false;
    return true;
}

enum class Blocks { measured, decompressed };

bool decompresses(std::string_view block, std::uint64_t bytes, bool blosc)
{
    std::vector<char> room(bytes);
    if (blosc)
        return blosc_decompress_ctx(block.data(), room.data(), bytes, 1) == int(bytes);
    uLongf made = bytes;
    return ::uncompress(reinterpret_cast<Bytef*>(room.data()), &made,
                        reinterpret_cast<const Bytef*>(block.data()), block.size()) == Z_OK &&
           made == bytes;
}

/// What readData() reads.
void walk_data(VdbCursor& walk, const VdbCoding& coding, std::uint64_t bytes, Blocks blocks)
{
    if ((coding.compression & (COMPRESS_BLOSC | COMPRESS_ZIP)) == 0) {
        walk.take(bytes, "values");
        return;
    }
    const auto size = walk.number<std::int64_t>("the size of a compressed block");
    if (size <= 0) {
        // The smallest number has no opposite; unsigned arithmetic does not mind.
        walk.require(std::uint64_t(0) - std::uint64_t(size) == bytes,
                     "a block of values of another size than the node's");
        walk.take(bytes, "values");
        return;
    }
    const std::string_view block = walk.take(std::uint64_t(size), "a compressed block");
    // zlib is told how much room there is, and what it made is held against that by OpenVDB.
    const bool blosc = (coding.compression & COMPRESS_BLOSC) != 0;
    walk.require((!blosc || is_blosc_of(block, bytes)) &&
                     (blocks == Blocks::measured || decompresses(block, bytes, blosc)),
                 "a block that does not decompress to its node");
}

/// What readCompressedValues() reads for a node of `count` values, `active` of them active.
void walk_values(VdbCursor& walk, const VdbCoding& coding, std::uint32_t count,
                 std::uint32_t active, Blocks blocks)
{
    using namespace openvdb::io;
    const auto flag = walk.number<std::int8_t>("the kind of inactive values");
    walk.require(flag >= NO_MASK_OR_INACTIVE_VALS && flag <= NO_MASK_AND_ALL_VALS,
                 "an unknown kind of inactive values");
    if (flag == NO_MASK_AND_ONE_INACTIVE_VAL || flag == MASK_AND_ONE_INACTIVE_VAL)
        walk.take(coding.value_bytes, "an inactive value");
    if (flag == MASK_AND_TWO_INACTIVE_VALS)
        walk.take(2 * coding.value_bytes, "inactive values");
    if (flag == MASK_AND_NO_INACTIVE_VALS || flag == MASK_AND_ONE_INACTIVE_VAL ||
        flag == MASK_AND_TWO_INACTIVE_VALS)
        walk.take(count / 8, "a selection mask");
    const bool active_only =
        (coding.compression & COMPRESS_ACTIVE_MASK) && flag != NO_MASK_AND_ALL_VALS;
    const std::uint64_t stored = active_only ? active : count;
    // Of half floats OpenVDB reads nothing at all where there are none, of floats an empty block.
    if (coding.half && stored == 0)
        return;
    walk_data(walk, coding, stored * (coding.half ? coding.value_bytes / 2 : coding.value_bytes),
              blocks);
}

class Topology
{
public:
    Topology(VdbCursor& walk, const VdbCoding& coding) : walk_(walk), coding_(coding) {}

    std::vector<std::uint16_t> root()
    {
        walk_.require(walk_.number<std::int32_t>("the number of buffers") == 1,
                      "a tree of several buffers");
        const std::string_view background = walk_.take(coding_.value_bytes, "the background");
        walk_.require(!coding_.points || background.find_first_not_of('\0') == background.npos,
                      "a background of points");
        const auto tiles = walk_.number<std::uint32_t>("the number of tiles");
        const auto children = walk_.number<std::uint32_t>("the number of nodes");
        // OpenVDB puts tiles and children into one table by their places, so a place that came
        // twice would replace a node whose voxels still follow in the file; its order is that of
        // the table.
        std::vector<openvdb::Coord> tile_places;
        for (std::uint32_t i = 0; i < tiles; ++i) {
            tile_places.push_back(next_place(tile_places));
            walk_.take(coding_.value_bytes, "a tile's value");
            walk_.require(walk_.number<std::uint8_t>("a tile's state") <= 1, "a tile's state");
        }
        std::vector<openvdb::Coord> child_places;
        for (std::uint32_t i = 0; i < children; ++i) {
            child_places.push_back(next_place(child_places));
            walk_.require(
                !std::binary_search(tile_places.begin(), tile_places.end(), child_places.back()),
                "a node where a tile is");
            inner_node(2);
        }
        return std::move(leaves_);
    }

private:
    openvdb::Coord next_place(const std::vector<openvdb::Coord>& before)
    {
        openvdb::Coord place;
        for (int axis = 0; axis < 3; ++axis) {
            place[axis] = walk_.number<std::int32_t>("the place of a node");
            walk_.require(place[axis] % kRootChild == 0, "a node that is out of place");
        }
        walk_.require(before.empty() || before.back() < place, "nodes that are out of order");
        return place;
    }

    void inner_node(std::size_t level)
    {
        const std::uint32_t values = kNodeValues[level];
        const std::string_view children = walk_.take(values / 8, "a mask of children");
        const std::string_view active = walk_.take(values / 8, "a mask of active values");
        // OpenVDB keeps a child's address and a value in the same place.
        walk_.require(disjoint(children, active), "an active value where a child is");
        walk_values(walk_, coding_, values, count_bits(active), Blocks::decompressed);
        // Where the children are does not matter to what follows, only how many there are.
        for (std::uint32_t child = count_bits(children); child > 0; --child)
            if (level == 1)
                leaves_.push_back(
                    std::uint16_t(count_bits(walk_.take(kNodeValues[0] / 8, "a leaf's mask"))));
            else
                inner_node(level - 1);
    }

    VdbCursor& walk_;
    const VdbCoding& coding_;
    std::vector<std::uint16_t> leaves_;
};

} // namespace

std::vector<std::uint16_t> walk_topology(VdbCursor& walk, const VdbCoding& coding)
{
    return Topology(walk, coding).root();
}

void walk_voxels(VdbCursor& walk, const VdbCoding& coding, const std::vector<std::uint16_t>& leaves)
{
    for (const std::uint16_t active : leaves) {
        // OpenVDB skips this mask and goes by that of the topology.
        walk.take(kNodeValues[0] / 8, "a leaf's mask");
        walk_values(walk, coding, kNodeValues[0], active, Blocks::measured);
    }
}

} // namespace vdb_shell

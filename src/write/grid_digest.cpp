// SPDX-License-Identifier: Apache-2.0

// Takes a grid apart into what it means, and gives digests of it. Leaves are taken in the order of
// the tree, each into a digest of its own on all threads, then the digests of all leaves into one,
// so threads do not matter. Metadata that OpenVDB adds when it writes (`file_...`) say how a file
// is stored, and are left out.

#include "write/grid_digest.h"

#include "core/parallel.h"
#include "core/point_grid_instances.h"
#include "core/text_stream.h"
#include "vdb_shell/core/digest.h"
#include "vdb_shell/core/words.h"

#include <openvdb/io/Compression.h>

#include <array>
#include <cstring>

namespace vdb_shell
{
namespace
{

using openvdb::FloatGrid;
using openvdb::GridBase;
using openvdb::points::AttributeArray;
using openvdb::points::PointDataGrid;
using Words = std::array<std::uint64_t, 2>;

template <typename Wanted>
void add_metadata(Digest& digest, const openvdb::MetaMap& metadata, const Wanted& wanted)
{
    for (auto entry = metadata.beginMeta(); entry != metadata.endMeta(); ++entry) {
        if (!wanted(entry->first))
            continue;
        OutText bytes;
        entry->second->write(bytes);
        digest.add_text(entry->first);
        // Two entries of the same bytes may be of different types, a number and a string.
        digest.add_text(entry->second->typeName());
        digest.add_text(bytes.str());
    }
}

/// How values are taken: as the file will have them.
struct AsStored {
    bool half = false;

    float operator()(float value) const
    {
        const float stored = half ? openvdb::io::truncateRealToHalf(value) : value;
        return stored + 0.0f; // which makes a zero of either sign the positive one
    }
    openvdb::PointDataIndex32 operator()(openvdb::PointDataIndex32 value) const { return value; }
};

template <typename Mask> auto words_of(const Mask& mask)
{
    std::array<std::uint64_t, Mask::WORD_COUNT> words;
    for (openvdb::Index i = 0; i < Mask::WORD_COUNT; ++i)
        words[i] = mask.template getWord<std::uint64_t>(i);
    return words;
}

template <typename Mask> void add_mask(Digest& digest, const Mask& mask)
{
    const auto words = words_of(mask);
    digest.add(words.data(), sizeof words);
}

template <typename Node> void add_inner(Digest& digest, const Node& node, const AsStored& as_stored)
{
    digest.add(node.origin().data(), sizeof(openvdb::Coord));
    add_mask(digest, node.getChildMask());
    add_mask(digest, node.getValueMask());
    // Of a place with a child the value means nothing, and OpenVDB keeps a pointer there. It counts
    // as zero.
    std::vector<typename Node::ValueType> values(Node::NUM_VALUES);
    for (openvdb::Index i = 0; i < Node::NUM_VALUES; ++i)
        if (!node.isChildMaskOn(i))
            values[i] = as_stored(node.getTable()[i].getValue());
    digest.add(values.data(), values.size() * sizeof(values[0]));
    if constexpr (Node::LEVEL > 1)
        for (auto child = node.cbeginChildOn(); child; ++child)
            add_inner(digest, *child, as_stored);
}

/// All but the leaves.
template <typename Tree> void add_nodes(Digest& digest, const Tree& tree, const AsStored& as_stored)
{
    const auto background = as_stored(tree.background());
    digest.add(&background, sizeof background);
    for (auto tile = tree.root().cbeginValueAll(); tile; ++tile) {
        const auto value = as_stored(*tile);
        digest.add(tile.getCoord().data(), sizeof(openvdb::Coord));
        digest.add(&value, sizeof value);
        digest.add_number(tile.isValueOn());
    }
    for (auto child = tree.root().cbeginChildOn(); child; ++child)
        add_inner(digest, *child, as_stored);
}

template <typename Leaf> Words leaf_digest(const Leaf& leaf, const AsStored& as_stored)
{
    const auto mask = words_of(leaf.getValueMask());
    std::array<typename Leaf::ValueType, Leaf::SIZE> values;
    // Inactive voxels too: a level set has its signs there.
    const auto* const stored = leaf.buffer().data();
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i)
        values[i] = as_stored(stored[i]);
    // In one piece, which has the digest of its pieces: to take these one after the other costs a
    // state in memory, which is as dear as all voxels of a leaf.
    std::array<char, sizeof(openvdb::Coord) + sizeof mask + sizeof values> bytes;
    std::memcpy(bytes.data(), leaf.origin().data(), sizeof(openvdb::Coord));
    std::memcpy(bytes.data() + sizeof(openvdb::Coord), mask.data(), sizeof mask);
    std::memcpy(bytes.data() + sizeof(openvdb::Coord) + sizeof mask, values.data(), sizeof values);
    return digest_of(bytes.data(), bytes.size());
}

/// The digest of one for each leaf.
template <typename Leaf, typename Of>
void add_leaves(Digest& digest, const std::vector<const Leaf*>& leaves, const Of& of)
{
    std::vector<Words> words(leaves.size());
    for_each_index(leaves.size(), [&](std::size_t i) { words[i] = of(*leaves[i]); });
    digest.add_values(words);
}

/// What every kind of grid has.
void add_head(Digest& digest, const GridBase& grid)
{
    digest.add_text(grid.getName());
    digest.add_text(grid.type());
    OutText transform;
    transform << grid.transform().mapType();
    grid.transform().baseMap()->write(transform);
    digest.add_text(transform.str());
    add_metadata(digest, grid, [](const std::string& name) { return !begins_with(name, "file_"); });
}

template <typename Grid>
std::vector<const typename Grid::TreeType::LeafNodeType*> add_grid(Digest& digest, const Grid& grid)
{
    const AsStored as_stored{grid.saveFloatAsHalf()};
    add_head(digest, grid);
    add_nodes(digest, grid.tree(), as_stored);
    std::vector<const typename Grid::TreeType::LeafNodeType*> leaves;
    grid.tree().getNodes(leaves);
    add_leaves(digest, leaves, [&](const auto& leaf) { return leaf_digest(leaf, as_stored); });
    return leaves;
}

/// The values of one attribute in one leaf. Equal ones may be stored once or each; they are taken
/// one by one.
Words array_digest(const AttributeArray& array)
{
    const std::size_t size = array.storageTypeSize(), count = array.dataSize();
    if (!array.isUniform())
        return digest_of(array.constDataAsByteArray(), size * count);
    std::string bytes;
    bytes.reserve(size * count);
    for (std::size_t i = 0; i < count; ++i)
        bytes.append(array.constDataAsByteArray(), size);
    return digest_of(bytes.data(), bytes.size());
}

std::vector<NamedDigest> digests_of_points(const PointDataGrid& grid)
{
    Digest whole;
    const auto leaves = add_grid(whole, grid);
    std::vector<NamedDigest> found{{grid.getName(), ""}};
    if (!leaves.empty()) {
        // One for all leaves: a grid whose leaves differ in it is refused by its own reader.
        const auto& descriptor = leaves.front()->attributeSet().descriptor();
        // Groups are bits of an attribute. Which bit is whose stands in the descriptor only.
        for (const auto& [name, bit] : descriptor.groupMap()) {
            whole.add_text(name);
            whole.add_number(std::uint64_t(bit));
        }
        for (const auto& [name, place] : descriptor.map()) {
            Digest digest;
            const AttributeArray& first = leaves.front()->constAttributeArray(place);
            digest.add_text(name);
            // The codec as well, since the same bytes mean other values under another one.
            digest.add_text(first.valueType() + "/" + first.codecType());
            digest.add_number(first.stride());
            const std::size_t at = place;
            add_leaves(digest, leaves, [at](const auto& leaf) {
                return array_digest(leaf.constAttributeArray(at));
            });
            found.push_back({grid.getName() + "." + name, digest.hex()});
        }
    }
    found.front().hex = whole.hex();
    return found;
}

} // namespace

std::vector<NamedDigest> digests_of(const GridBase& grid)
{
    if (grid.isType<PointDataGrid>())
        return digests_of_points(static_cast<const PointDataGrid&>(grid));
    if (!grid.isType<FloatGrid>())
        return {};
    Digest digest;
    add_grid(digest, static_cast<const FloatGrid&>(grid));
    return {{grid.getName(), digest.hex()}};
}

NamedDigest digest_of_metadata(const openvdb::MetaMap& metadata, const std::string& except)
{
    Digest digest;
    add_metadata(digest, metadata, [&](const std::string& name) {
        return name != except && (name == "creator" || begins_with(name, "vdb_shell_"));
    });
    return {"metadata", digest.hex()};
}

} // namespace vdb_shell

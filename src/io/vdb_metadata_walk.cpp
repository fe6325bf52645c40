// SPDX-License-Identifier: Apache-2.0

// Metadata and transforms of a .vdb, walked as OpenVDB reads them. OpenVDB reads a value by the
// size of its type, whatever length stands before it, so a wrong length would move all that
// follows. Values of types that it does not know it keeps as bytes.

#include "io/vdb_walk.h"

#include <openvdb/Metadata.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/math/Maps.h>

#include <blosc.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Metadata;
using openvdb::io::DelayedLoadMetadata;

/// One of the two lists of that kind of metadata: a length and a chunk of Blosc, or 0 and as many
/// elements as there are.
void walk_list(VdbCursor& walk, std::uint32_t compressed, std::uint64_t bytes)
{
    // Short lists are filled up before they are compressed.
    constexpr std::uint64_t kPadded = 128;
    if (compressed == 0) {
        walk.take(bytes, "a list of sizes");
        return;
    }
    const std::string_view chunk = walk.take(compressed, "a list of sizes");
    walk.require(is_blosc_of(chunk, bytes) || (bytes <= kPadded && is_blosc_of(chunk, kPadded)),
                 "a list of sizes that does not decompress to its length");
}

/// How OpenVDB finds leaves without reading those before them. Nothing here uses it, but OpenVDB
/// decodes it with the other metadata.
void walk_delayed_load(VdbCursor& walk, std::uint32_t size)
{
    if (size == 0)
        return;
    const std::uint64_t end = walk.at() + size;
    const auto count = walk.number<std::uint32_t>("the number of leaves");
    // A leaf takes more than a byte of the file.
    walk.require(count > 0 && count < walk.size(), "an impossible number of leaves");
    walk_list(walk, walk.number<std::uint32_t>("the size of a list"),
              count * sizeof(DelayedLoadMetadata::MaskType));
    const auto second = walk.number<std::uint32_t>("the size of a list");
    // That number stands for a file without the second list.
    if (second != std::numeric_limits<std::uint32_t>::max())
        walk_list(walk, second, count * sizeof(DelayedLoadMetadata::CompressedSizeType));
    walk.require(walk.at() == end, "lists of sizes of another length than stated");
}

void walk_value(VdbCursor& walk, const std::string& type)
{
    const auto size = walk.number<std::uint32_t>("a metadata size");
    if (size > walk.left())
        walk.take(size, "a metadata value"); // which says so
    if (type == DelayedLoadMetadata::staticTypeName())
        return walk_delayed_load(walk, size);
    const bool any_size = type == "string" || !Metadata::isRegisteredType(type);
    walk.require(any_size || size == Metadata::createMetadata(type)->size(),
                 "a metadata value of another size than its type");
    const std::string_view value = walk.take(size, "a metadata value");
    walk.require(type != "bool" || value[0] == 0 || value[0] == 1,
                 "a bool that is neither 0 nor 1");
}

template <std::size_t N> std::array<double, N> doubles(VdbCursor& walk)
{
    std::array<double, N> values{};
    for (double& value : values) {
        value = walk.number<double>("a transform");
        walk.require(std::isfinite(value), "a number of the transform is not finite");
    }
    return values;
}

/// OpenVDB stores what follows from the scale with it, and takes it as it is.
void walk_scale(VdbCursor& walk)
{
    const auto scale = doubles<3>(walk);
    doubles<3>(walk); // voxel size
    const auto inverse = doubles<3>(walk);
    doubles<6>(walk);
    // OpenVDB goes by the inverse where it looks up voxels and by the scale where it tells places:
    // the two must not disagree.
    constexpr double kRounding = 1e-6;
    for (std::size_t i = 0; i < 3; ++i)
        walk.require(std::abs(scale[i] * inverse[i] - 1.0) < kRounding,
                     "a scale of the transform that is not what its inverse says");
}

bool walk_linear_map(VdbCursor& walk, std::string_view type)
{
    if (type == "AffineMap" || type == "UnitaryMap")
        doubles<16>(walk);
    else if (type == "TranslationMap")
        doubles<3>(walk);
    else if (type == "ScaleMap" || type == "UniformScaleMap")
        walk_scale(walk);
    else if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap") {
        doubles<3>(walk);
        walk_scale(walk);
    } else
        return false;
    return true;
}

} // namespace

bool is_blosc_of(std::string_view chunk, std::uint64_t bytes)
{
    // Blosc promises that decompressing is safe for what passes here.
    std::size_t found = 0;
    return blosc_cbuffer_validate(chunk.data(), chunk.size(), &found) == 0 && found == bytes;
}

std::vector<VdbEntry> walk_metadata(VdbCursor& walk)
{
    std::vector<VdbEntry> entries;
    const auto count = walk.number<std::uint32_t>("the number of metadata");
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::string_view name = walk.text("a metadata name");
        const std::string_view type = walk.text("a metadata type");
        const std::uint64_t begin = walk.at() + sizeof(std::uint32_t);
        walk_value(walk, std::string(type));
        // Behind its length.
        entries.push_back({name, type, walk.bytes().substr(begin, walk.at() - begin)});
    }
    return entries;
}

void walk_transform(VdbCursor& walk)
{
    const std::string_view type = walk.text("the transform's type");
    if (type != "NonlinearFrustumMap") {
        walk.require(walk_linear_map(walk, type), "a transform of an unknown type");
        return;
    }
    doubles<8>(walk); // box, taper, depth
    const std::string_view inner = walk.text("the transform's second type");
    walk.require(walk_linear_map(walk, inner), "a frustum of an unknown type");
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Writes a .vdb file as OpenVDB's own writer does, byte for byte but for the random UUID, with the
// leaves compressed on all threads. The layout is that of OpenVDB's io::Archive and
// io::GridDescriptor (OpenVDB 10.0.1): a header, and for each grid a descriptor with its positions
// in the file, then metadata, transform, topology and the buffers of the leaves. Parts are made in
// memory in any order and written in one, so the bytes do not depend on the threads. Trap: what
// OpenVDB's stream functions need to know they look up on the stream itself, so each stream carries
// its own settings. tests/io/vdb_archive_test.cpp compares both writers.

#include "io/vdb_archive.h"

#include "core/parallel.h"
#include "core/point_grid_instances.h"
#include "io/vdb_point_buffers.h"
#include "vdb_shell/core/digest.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::FloatGrid;
using openvdb::FloatTree;
using openvdb::GridBase;
using openvdb::io::DelayedLoadMetadata;
using openvdb::io::StreamMetadata;
using openvdb::points::PointDataGrid;

using Leaf = FloatTree::LeafNodeType;
using Leaves = openvdb::tree::LeafManager<const FloatTree>;

std::int64_t size_of(const VdbParts& parts)
{
    std::int64_t size = 0;
    for (const std::string& part : parts)
        size += std::int64_t(part.size());
    return size;
}

std::string joined(VdbParts&& parts)
{
    std::string all = parts.empty() ? std::string() : std::move(parts.front());
    for (std::size_t i = 1; i < parts.size(); ++i)
        all += parts[i];
    return all;
}

/// A grid as it stands in the file, but for its descriptor.
struct GridBytes {
    VdbParts head, topology, buffers;
};

/// How many bytes of a written leaf precede its compressed values: its mask, the flag that says
/// what there is of inactive values, and these.
std::int64_t size_before_values(std::int8_t flag)
{
    using namespace openvdb::io;
    constexpr std::int64_t kMaskBytes = sizeof(Leaf::NodeMaskType), kValueBytes = sizeof(float);
    std::int64_t size = kMaskBytes + 1;
    if (flag == NO_MASK_AND_ONE_INACTIVE_VAL || flag == MASK_AND_ONE_INACTIVE_VAL)
        size += kValueBytes;
    if (flag == MASK_AND_TWO_INACTIVE_VALS)
        size += 2 * kValueBytes;
    if (flag == MASK_AND_NO_INACTIVE_VALS || flag == MASK_AND_ONE_INACTIVE_VAL ||
        flag == MASK_AND_TWO_INACTIVE_VALS)
        size += kMaskBytes;
    return size;
}

/// Writes what LeafNode::writeBuffers() writes, which sorts out active values voxel by voxel even
/// where all are active, as they are in most leaves of a solid.
void write_leaf(std::ostream& out, const Leaf& leaf, const StreamMetadata& settings)
{
    if (!leaf.isDense() || settings.halfFloat()) {
        leaf.writeBuffers(out, settings.halfFloat());
        return;
    }
    leaf.valueMask().save(out);
    out.put(char(openvdb::io::NO_MASK_OR_INACTIVE_VALS));
    openvdb::io::writeData(out, leaf.buffer().data(), Leaf::SIZE, settings.compression());
}

/// Leaves `begin` to `end`, and what a reader wants to know about them before it loads them.
std::string leaf_bytes(const Leaves& leaves, std::size_t begin, std::size_t end,
                       const StreamMetadata& settings, DelayedLoadMetadata& sizes)
{
    VdbStream stream(settings);
    std::vector<std::size_t> starts;
    for (std::size_t i = begin; i < end; ++i) {
        starts.push_back(std::size_t(stream.out.tellp()));
        write_leaf(stream.out, leaves.leaf(i), settings);
    }
    starts.push_back(std::size_t(stream.out.tellp()));
    std::string bytes = joined(stream.bytes.take());
    for (std::size_t i = begin; i < end; ++i) {
        const std::size_t start = starts[i - begin], next = starts[i - begin + 1];
        const auto flag = std::int8_t(bytes[start + sizeof(Leaf::NodeMaskType)]);
        sizes.setMask(i, flag);
        // A leaf of half floats without values takes no bytes; OpenVDB counts those of the size all
        // the same.
        constexpr std::int64_t kSizeBytes = sizeof(std::int64_t);
        sizes.setCompressedSize(
            i, std::max(std::int64_t(next - start) - size_before_values(flag), kSizeBytes));
    }
    return bytes;
}

/// The buffers of all leaves in parts, in the order of the tree.
VdbParts float_buffers(const FloatGrid& grid, const StreamMetadata& settings,
                       DelayedLoadMetadata& sizes)
{
    const Leaves leaves(grid.constTree());
    const std::size_t count = leaves.leafCount();
    sizes.resizeMask(count);
    sizes.resizeCompressedSize(count);
    constexpr std::size_t kLeavesInPart = 256;
    // Each part is compressed into a stream of its own; a leaf's bytes do not depend on the leaves
    // before it.
    VdbParts parts((count + kLeavesInPart - 1) / kLeavesInPart);
    for_each_index(
        parts.size(),
        [&](std::size_t i) {
            const std::size_t begin = i * kLeavesInPart;
            parts[i] =
                leaf_bytes(leaves, begin, std::min(begin + kLeavesInPart, count), settings, sizes);
        },
        1);
    return parts;
}

/// Gives access to the parts of OpenVDB's writer.
class Archive : public openvdb::io::Archive
{
public:
    Archive()
    {
        // What Houdini writes.
        setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
    }

    std::string head(const openvdb::MetaMap& metadata, std::size_t grids) const
    {
        VdbStream stream{StreamMetadata()};
        writeHeader(stream.out, /*seekable=*/true);
        metadata.writeMeta(stream.out);
        const auto count = std::int32_t(grids);
        stream.out.write(reinterpret_cast<const char*>(&count), sizeof count);
        return joined(stream.bytes.take());
    }

    GridBytes bytes_of(const GridBase& grid) const
    {
        StreamMetadata settings;
        settings.setHalfFloat(grid.saveFloatAsHalf());
        settings.gridMetadata() = static_cast<const openvdb::MetaMap&>(grid);
        VdbStream head(settings);
        setGridCompression(head.out, grid);
        GridBytes bytes;
        // The metadata that only the file has are added to a copy, which shares the tree with the
        // grid.
        const GridBase::Ptr described = openvdb::ConstPtrCast<GridBase>(grid.copyGrid());
        if (grid.isType<FloatGrid>()) {
            // Writing the topology notes the background, which the buffers need.
            VdbStream topology(*head.settings);
            grid.writeTopology(topology.out);
            bytes.topology = topology.bytes.take();
            DelayedLoadMetadata sizes;
            bytes.buffers =
                float_buffers(static_cast<const FloatGrid&>(grid), *topology.settings, sizes);
            described->insertMeta(GridBase::META_FILE_DELAYED_LOAD, sizes);
        } else {
            VdbStream all(*head.settings);
            grid.writeTopology(all.out);
            bytes.topology = all.bytes.take();
            if (has_alike_leaves(grid)) {
                bytes.buffers =
                    point_buffers(static_cast<const PointDataGrid&>(grid), *all.settings);
            } else {
                grid.writeBuffers(all.out);
                bytes.buffers = all.bytes.take();
            }
        }
        described->addStatsMetadata();
        described->insertMeta(GridBase::META_FILE_COMPRESSION,
                              openvdb::StringMetadata(
                                  openvdb::io::compressionToString(head.settings->compression())));
        described->writeMeta(head.out);
        grid.writeTransform(head.out);
        bytes.head = head.bytes.take();
        return bytes;
    }
};

/// The descriptor of a grid that stands at a place of the file.
VdbParts descriptor_bytes(std::int64_t place, const GridBase& grid, const GridBytes& bytes)
{
    VdbStream stream{StreamMetadata()};
    openvdb::io::GridDescriptor descriptor(grid.getName(), grid.type(), grid.saveFloatAsHalf());
    descriptor.writeHeader(stream.out);
    // The grid begins behind its three positions, which are written before it.
    constexpr std::int64_t kPositionsSize = 3 * sizeof(std::int64_t);
    descriptor.setGridPos(place + std::int64_t(stream.out.tellp()) + kPositionsSize);
    descriptor.setBlockPos(descriptor.getGridPos() + size_of(bytes.head) + size_of(bytes.topology));
    descriptor.setEndPos(descriptor.getBlockPos() + size_of(bytes.buffers));
    descriptor.writeStreamPos(stream.out);
    return stream.bytes.take();
}

VdbArchive::Grid write_grid(std::ostream& out, const GridBase& grid, const GridBytes& bytes)
{
    Digest digest;
    const auto write = [&](const VdbParts& parts) {
        for (const std::string& part : parts) {
            digest.add(part.data(), part.size());
            out.write(part.data(), std::streamsize(part.size()));
        }
    };
    write(descriptor_bytes(std::int64_t(out.tellp()), grid, bytes));
    write(bytes.head);
    write(bytes.topology);
    write(bytes.buffers);
    return {grid.getName(), digest.words()};
}

} // namespace

std::string creator_name()
{
    return std::string("vdb_shell ") + VDB_SHELL_VERSION;
}

VdbArchive write_vdb_archive(const std::filesystem::path& path, openvdb::GridPtrVec grids,
                             const openvdb::MetaMap& metadata)
{
    const Archive archive;
    VdbArchive result;
    result.head = archive.head(metadata, grids.size());
    errno = 0;
    std::ofstream out(path, std::ios::binary);
    out.write(result.head.data(), std::streamsize(result.head.size()));
    // The reason is known to the thread alone that met it, and only at once.
    int reason = out ? 0 : errno;
    // A grid is on its way to the disk while the next one is compressed.
    GridBytes ready;
    for (std::size_t i = 0; i <= grids.size(); ++i) {
        GridBytes next;
        run_together(
            [&] {
                if (i == 0)
                    return;
                errno = 0;
                result.grids.push_back(write_grid(out, *grids[i - 1], ready));
                reason = !out && reason == 0 ? errno : reason;
                ready = {};
                grids[i - 1].reset();
            },
            [&] {
                if (i < grids.size())
                    next = archive.bytes_of(*grids[i]);
            });
        ready = std::move(next);
    }
    errno = 0;
    result.size = std::uint64_t(out.tellp());
    out.close();
    reason = !out && reason == 0 ? errno : reason;
    // Callers put the name of the output before it; not that of the temporary.
    if (!out)
        throw std::runtime_error(reason != 0 ? std::strerror(reason)
                                             : "the file system refused the data");
    return result;
}

} // namespace vdb_shell

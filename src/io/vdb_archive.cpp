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
#include <mutex>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <streambuf>
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

using Leaf = FloatTree::LeafNodeType;
using Leaves = openvdb::tree::LeafManager<const FloatTree>;

/// What is written to it, in a string that can be taken: std::ostringstream gives copies only, and
/// the grids of points of a million triangles have a hundred megabytes each.
class Bytes : public std::streambuf
{
public:
    std::string take() { return std::exchange(bytes_, {}); }

private:
    int_type overflow(int_type c) override
    {
        if (!traits_type::eq_int_type(c, traits_type::eof()))
            bytes_.push_back(traits_type::to_char_type(c));
        return traits_type::not_eof(c);
    }
    std::streamsize xsputn(const char* data, std::streamsize size) override
    {
        bytes_.append(data, std::size_t(size));
        return size;
    }
    /// Where the next byte goes; nothing can be written over.
    pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override
    {
        return by == 0 && from != std::ios_base::beg ? pos_type(off_type(bytes_.size()))
                                                     : pos_type(off_type(-1));
    }

    std::string bytes_;
};

/// A stream in memory that OpenVDB finds its settings on.
struct Stream {
    explicit Stream(const StreamMetadata& wanted)
        : settings(std::make_shared<StreamMetadata>(wanted))
    {
        openvdb::io::setStreamMetadataPtr(out, settings);
    }
    Bytes bytes;
    std::ostream out{&bytes};
    StreamMetadata::Ptr settings;
};

/// A grid as it stands in the file, but for its descriptor.
struct GridBytes {
    std::string head, topology;
    std::vector<std::string> buffers;

    std::int64_t buffers_size() const
    {
        std::int64_t sum = 0;
        for (const std::string& part : buffers)
            sum += std::int64_t(part.size());
        return sum;
    }
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
    Stream stream(settings);
    std::vector<std::size_t> starts;
    for (std::size_t i = begin; i < end; ++i) {
        starts.push_back(std::size_t(stream.out.tellp()));
        write_leaf(stream.out, leaves.leaf(i), settings);
    }
    starts.push_back(std::size_t(stream.out.tellp()));
    std::string bytes = stream.bytes.take();
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
std::vector<std::string> float_buffers(const FloatGrid& grid, const StreamMetadata& settings,
                                       DelayedLoadMetadata& sizes)
{
    const Leaves leaves(grid.constTree());
    const std::size_t count = leaves.leafCount();
    sizes.resizeMask(count);
    sizes.resizeCompressedSize(count);
    constexpr std::size_t kLeavesInPart = 256;
    // Each part is compressed into a stream of its own; a leaf's bytes do not depend on the leaves
    // before it.
    std::vector<std::string> parts((count + kLeavesInPart - 1) / kLeavesInPart);
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
        Stream stream{StreamMetadata()};
        writeHeader(stream.out, /*seekable=*/true);
        metadata.writeMeta(stream.out);
        const auto count = std::int32_t(grids);
        stream.out.write(reinterpret_cast<const char*>(&count), sizeof count);
        return stream.bytes.take();
    }

    GridBytes bytes_of(const GridBase& grid) const
    {
        StreamMetadata settings;
        settings.setHalfFloat(grid.saveFloatAsHalf());
        settings.gridMetadata() = static_cast<const openvdb::MetaMap&>(grid);
        Stream head(settings);
        setGridCompression(head.out, grid);
        GridBytes bytes;
        // The metadata that only the file has are added to a copy, which shares the tree with the
        // grid.
        const GridBase::Ptr described = openvdb::ConstPtrCast<GridBase>(grid.copyGrid());
        if (grid.isType<FloatGrid>()) {
            // Writing the topology notes the background, which the buffers need.
            Stream topology(*head.settings);
            grid.writeTopology(topology.out);
            bytes.topology = topology.bytes.take();
            DelayedLoadMetadata sizes;
            bytes.buffers =
                float_buffers(static_cast<const FloatGrid&>(grid), *topology.settings, sizes);
            described->insertMeta(GridBase::META_FILE_DELAYED_LOAD, sizes);
        } else {
            Stream all(*head.settings);
            grid.writeTopology(all.out);
            bytes.topology = all.bytes.take();
            grid.writeBuffers(all.out);
            bytes.buffers.push_back(all.bytes.take());
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

void write_bytes(std::ostream& out, const std::string& bytes)
{
    out.write(bytes.data(), std::streamsize(bytes.size()));
}

/// The descriptor of a grid that stands at a place of the file.
std::string descriptor_bytes(std::int64_t place, const GridBase& grid, const GridBytes& bytes)
{
    Stream stream{StreamMetadata()};
    openvdb::io::GridDescriptor descriptor(grid.getName(), grid.type(), grid.saveFloatAsHalf());
    descriptor.writeHeader(stream.out);
    // The grid begins behind its three positions, which are written before it.
    constexpr std::int64_t kPositionsSize = 3 * sizeof(std::int64_t);
    descriptor.setGridPos(place + std::int64_t(stream.out.tellp()) + kPositionsSize);
    descriptor.setBlockPos(descriptor.getGridPos() +
                           std::int64_t(bytes.head.size() + bytes.topology.size()));
    descriptor.setEndPos(descriptor.getBlockPos() + bytes.buffers_size());
    descriptor.writeStreamPos(stream.out);
    return stream.bytes.take();
}

VdbArchive::Grid write_grid(std::ostream& out, const GridBase& grid, const GridBytes& bytes)
{
    Digest digest;
    const auto write = [&](const std::string& part) {
        digest.add(part.data(), part.size());
        write_bytes(out, part);
    };
    write(descriptor_bytes(std::int64_t(out.tellp()), grid, bytes));
    write(bytes.head);
    write(bytes.topology);
    for (const std::string& part : bytes.buffers)
        write(part);
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
    write_bytes(out, result.head);
    // The reason is known to the thread alone that met it, and only at once.
    int reason = out ? 0 : errno;
    std::mutex writing;
    std::vector<std::optional<GridBytes>> ready(grids.size());
    std::size_t written = 0;
    // The last grid is begun first. Where there are points it is that of the tets, which takes the
    // longest, as one thread writes it; the other grids are on their way to the disk, and their
    // memory is free, when that one is done.
    for_each_index(
        grids.size(),
        [&](std::size_t i) {
            const std::size_t last = grids.size() - 1 - i;
            GridBytes bytes = archive.bytes_of(*grids[last]);
            // Grids that are written are freed after the lock is: OpenVDB frees on all threads, and
            // a thread that waits for the others may take up the next grid here meanwhile, which
            // needs the lock.
            openvdb::GridPtrVec done;
            const std::lock_guard<std::mutex> lock(writing);
            ready[last] = std::move(bytes);
            for (; written < grids.size() && ready[written]; ++written) {
                errno = 0;
                result.grids.push_back(write_grid(out, *grids[written], *ready[written]));
                reason = !out && reason == 0 ? errno : reason;
                ready[written].reset();
                done.push_back(std::move(grids[written]));
            }
        },
        1);
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

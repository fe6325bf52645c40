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
#include "vdb_shell/core/digest.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
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
using openvdb::points::PointDataGrid;

using Leaf = FloatTree::LeafNodeType;
using Leaves = openvdb::tree::LeafManager<const FloatTree>;

/// Bytes of a file in the order in which they stand there.
using Parts = std::vector<std::string>;

std::int64_t size_of(const Parts& parts)
{
    std::int64_t size = 0;
    for (const std::string& part : parts)
        size += std::int64_t(part.size());
    return size;
}

std::string joined(Parts&& parts)
{
    std::string all = parts.empty() ? std::string() : std::move(parts.front());
    for (std::size_t i = 1; i < parts.size(); ++i)
        all += parts[i];
    return all;
}

void append(Parts&& added, Parts& parts)
{
    std::move(added.begin(), added.end(), std::back_inserter(parts));
}

/// What is written to it, in strings that can be taken: std::ostringstream gives copies only, and
/// the grids of points of a million triangles have a hundred megabytes each. One string would be
/// copied each time that it has to grow.
class Bytes : public std::streambuf
{
public:
    Parts take()
    {
        size_ = 0;
        return std::exchange(parts_, {});
    }

private:
    int_type overflow(int_type c) override
    {
        if (traits_type::eq_int_type(c, traits_type::eof()))
            return traits_type::not_eof(c);
        const char byte = traits_type::to_char_type(c);
        xsputn(&byte, 1);
        return c;
    }
    std::streamsize xsputn(const char* data, std::streamsize size) override
    {
        constexpr std::size_t kPart = std::size_t(1) << 20;
        const auto count = std::size_t(size);
        if (parts_.empty() || parts_.back().size() + count > kPart)
            parts_.emplace_back();
        parts_.back().append(data, count);
        size_ += size;
        return size;
    }
    /// Where the next byte goes; nothing can be written over.
    pos_type seekoff(off_type by, std::ios_base::seekdir from, std::ios_base::openmode) override
    {
        return by == 0 && from != std::ios_base::beg ? pos_type(off_type(size_))
                                                     : pos_type(off_type(-1));
    }

    Parts parts_;
    std::streamsize size_ = 0;
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
    Parts head, topology, buffers;
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
Parts float_buffers(const FloatGrid& grid, const StreamMetadata& settings,
                    DelayedLoadMetadata& sizes)
{
    const Leaves leaves(grid.constTree());
    const std::size_t count = leaves.leafCount();
    sizes.resizeMask(count);
    sizes.resizeCompressedSize(count);
    constexpr std::size_t kLeavesInPart = 256;
    // Each part is compressed into a stream of its own; a leaf's bytes do not depend on the leaves
    // before it.
    Parts parts((count + kLeavesInPart - 1) / kLeavesInPart);
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

/// What OpenVDB writes of points' voxels and attributes (openvdb/points/PointDataGrid.h): a number
/// of passes, and these: sizes of voxels; attributes' names and types; for each attribute the sizes
/// of its pages; the voxels; for each attribute its pages. A page holds values of many leaves and
/// of one attribute, so each pass can be written by itself.
class PointBuffers
{
public:
    PointBuffers(const PointDataGrid& grid, const StreamMetadata& settings)
        : grid_(grid), settings_(settings)
    {
        grid.constTree().getNodes(leaves_);
        attributes_ = std::uint32_t(leaves_.front()->attributeSet().size());
    }

    /// Whether these are points, and all leaves have the same attributes.
    static bool apply_to(const GridBase& any)
    {
        if (!any.isType<PointDataGrid>())
            return false;
        const auto& grid = static_cast<const PointDataGrid&>(any);
        const auto first = grid.constTree().cbeginLeaf();
        bool same = bool(first);
        for (auto leaf = first; leaf && same; ++leaf)
            same = leaf->attributeSet().descriptorPtr() == first->attributeSet().descriptorPtr();
        return same;
    }

    Parts write() const
    {
        std::vector<Parts> parts(2 * attributes_ + 2);
        // The pages first, which take the longest.
        for_each_index(
            parts.size(),
            [&](std::size_t i) {
                const std::size_t place = parts.size() - 1 - i;
                parts[place] = part(std::uint32_t(place));
            },
            1);
        Parts all;
        for (Parts& part : parts)
            append(std::move(part), all);
        return all;
    }

private:
    Parts part(std::uint32_t place) const
    {
        Stream stream(settings_);
        const std::uint32_t voxels = 1 + attributes_;
        if (place == 0) {
            const auto passes = std::uint16_t(leaves_.front()->buffers());
            stream.out.write(reinterpret_cast<const char*>(&passes), sizeof passes);
            add_pass(0, stream);
            add_pass(1, stream);
        } else if (place == voxels) {
            add_pass(attributes_ + 2, stream);
        } else {
            add_pages(place < voxels ? place - 1 : place - voxels - 1, place < voxels, stream);
        }
        return stream.bytes.take();
    }

    void add_pass(std::uint32_t pass, Stream& stream) const
    {
        stream.settings->setPass(leaves_.front()->buffers() << 16U | pass);
        grid_.constTree().writeBuffers(stream.out, grid_.saveFloatAsHalf());
    }

    void add_pages(std::uint32_t attribute, bool sizes, Stream& stream) const
    {
        openvdb::compression::PagedOutputStream pages;
        pages.setOutputStream(stream.out);
        pages.setSizeOnly(sizes);
        for (const auto* leaf : leaves_)
            leaf->attributeSet().getConst(attribute)->writePagedBuffers(pages,
                                                                        /*outputTransient=*/false);
        pages.flush();
    }

    const PointDataGrid& grid_;
    const StreamMetadata& settings_;
    std::vector<const PointDataGrid::TreeType::LeafNodeType*> leaves_;
    std::uint32_t attributes_ = 0;
};

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
        return joined(stream.bytes.take());
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
            if (PointBuffers::apply_to(grid)) {
                bytes.buffers =
                    PointBuffers(static_cast<const PointDataGrid&>(grid), *all.settings).write();
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
Parts descriptor_bytes(std::int64_t place, const GridBase& grid, const GridBytes& bytes)
{
    Stream stream{StreamMetadata()};
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
    const auto write = [&](const Parts& parts) {
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

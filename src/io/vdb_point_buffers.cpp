// SPDX-License-Identifier: Apache-2.0

// The buffers of points as they stand in a .vdb. OpenVDB writes them in passes over the leaves
// (openvdb/points/PointDataGrid.h, OpenVDB 10.0.1), whose number comes first: sizes of voxels;
// attributes' names and types; for each attribute the sizes of its pages; the voxels; for each
// attribute its pages. A page holds values of many leaves and of one attribute, so each pass can be
// written by itself. tests/io/vdb_archive_test.cpp compares the bytes with OpenVDB's.

#include "io/vdb_point_buffers.h"

#include "core/parallel.h"

#include <openvdb/points/StreamCompression.h>

#include <algorithm>
#include <iterator>

namespace vdb_shell
{
namespace
{

using openvdb::io::StreamMetadata;
using openvdb::points::PointDataGrid;

class PointBuffers
{
public:
    PointBuffers(const PointDataGrid& grid, const StreamMetadata& settings)
        : grid_(grid), settings_(settings)
    {
        grid.constTree().getNodes(leaves_);
        attributes_ = std::uint32_t(leaves_.front()->attributeSet().size());
    }

    VdbParts write() const
    {
        std::vector<VdbParts> parts(2 * attributes_ + 2);
        // The pages first, which take the longest.
        for_each_index(
            parts.size(),
            [&](std::size_t i) {
                const std::size_t place = parts.size() - 1 - i;
                parts[place] = part(std::uint32_t(place));
            },
            1);
        VdbParts all;
        for (VdbParts& part : parts)
            std::move(part.begin(), part.end(), std::back_inserter(all));
        return all;
    }

private:
    VdbParts part(std::uint32_t place) const
    {
        VdbStream stream(settings_);
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

    void add_pass(std::uint32_t pass, VdbStream& stream) const
    {
        stream.settings->setPass(leaves_.front()->buffers() << 16U | pass);
        grid_.constTree().writeBuffers(stream.out, grid_.saveFloatAsHalf());
    }

    void add_pages(std::uint32_t attribute, bool sizes, VdbStream& stream) const
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

} // namespace

bool has_alike_leaves(const openvdb::GridBase& grid)
{
    if (!grid.isType<PointDataGrid>())
        return false;
    const auto& points = static_cast<const PointDataGrid&>(grid);
    const auto first = points.constTree().cbeginLeaf();
    bool same = bool(first);
    for (auto leaf = first; leaf && same; ++leaf)
        same = leaf->attributeSet().descriptorPtr() == first->attributeSet().descriptorPtr();
    return same;
}

VdbParts point_buffers(const PointDataGrid& grid, const StreamMetadata& settings)
{
    return PointBuffers(grid, settings).write();
}

} // namespace vdb_shell

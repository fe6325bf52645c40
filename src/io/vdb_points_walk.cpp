// SPDX-License-Identifier: Apache-2.0

// Voxels and attributes of a tree of points, walked as OpenVDB's PointDataLeafNode reads them: in
// passes over all leaves, first sizes and the table of attributes, then for each attribute the
// sizes of its pages, then the voxels, then the pages. A page holds the values of several leaves,
// and OpenVDB copies them out of it by their sizes alone, so those have to fill it exactly. What
// OpenVDB can write and has not written since version 5 is refused: leaves of different attributes,
// tuples of varying length, arrays compressed in memory.

#include "io/vdb_walk.h"

#include <openvdb/points/AttributeArray.h>
#include <openvdb/points/AttributeGroup.h>

#include <blosc.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::points::AttributeArray;

constexpr std::size_t kLeafVoxels = 512;
constexpr std::uint64_t kMaskBytes = kLeafVoxels / 8;
/// What a compressed byte can stand for at most: a little more than zlib can make of one (1032
/// bytes). More is not believed, for memory is taken by it.
constexpr std::uint64_t kMostExpansion = 1100;
/// Shorter pages are filled up before they are compressed.
constexpr std::int32_t kPaddedPage = 128;

/// The values of one attribute in one leaf.
struct Array {
    std::uint64_t bytes = 0;
    std::uint32_t points = 0;
    bool uniform = false, paged = false;
};

struct Page {
    std::int32_t stored = 0; ///< bytes in the file, negative where they are not compressed
    std::int32_t bytes = 0;
};

class PointsWalk
{
public:
    PointsWalk(VdbCursor& walk, std::size_t leaves) : walk_(walk), leaves_(leaves) {}

    void run()
    {
        const auto passes = walk_.number<std::uint16_t>("the number of passes");
        if (leaves_ == 0)
            return;
        walk_.take(sizeof(std::uint16_t) * leaves_, "the sizes of leaves");
        descriptor();
        walk_.require(passes == 4 + 2 * sizes_.size(), "a wrong number of passes");
        // Each array takes bytes of the file, so no more memory is taken than that.
        for (std::size_t leaf = 0; leaf < leaves_; ++leaf)
            for (const std::uint64_t size : sizes_)
                arrays_.push_back(array(size));
        std::vector<std::vector<Page>> pages;
        for (std::size_t i = 0; i < sizes_.size(); ++i)
            pages.push_back(page_sizes(i));
        for (std::size_t leaf = 0; leaf < leaves_; ++leaf)
            voxels(leaf);
        for (std::size_t i = 0; i < sizes_.size(); ++i)
            values(i, pages[i]);
    }

private:
    const Array& array_of(std::size_t leaf, std::size_t attribute) const
    {
        return arrays_[leaf * sizes_.size() + attribute];
    }

    /// Names, types and groups, which all leaves share.
    void descriptor()
    {
        const auto header = walk_.number<std::uint8_t>("the header of the attributes");
        walk_.require(header == 1, "leaves of different attributes");
        const auto count = walk_.number<std::uint64_t>("the number of attributes");
        // OpenVDB counts passes by 16 bits, of which every attribute takes two.
        constexpr std::uint64_t kMost = std::numeric_limits<std::uint16_t>::max() / 2;
        walk_.require(count > 0 && count <= kMost && count <= walk_.left(),
                      "an impossible number of attributes");
        std::uint64_t group_bits = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::string value(walk_.text("an attribute's type"));
            const std::string codec(walk_.text("an attribute's codec"));
            const openvdb::NamePair type(value, codec);
            walk_.require(AttributeArray::isRegistered(type), "an attribute of an unknown type");
            // Asked of OpenVDB itself, since a codec stores a value in other sizes than its type
            // has.
            sizes_.push_back(AttributeArray::create(type, 1, 1)->storageTypeSize());
            if (type == openvdb::points::GroupAttributeArray::attributeType())
                // A group is one bit of an array of bytes, so each such array has room for eight.
                group_bits += 8;
        }
        names(count, count, /*distinct=*/true);
        names(walk_.number<std::uint64_t>("the number of groups"), group_bits, false);
        walk_metadata(walk_);
    }

    /// Names, each with a number below `limit`.
    void names(std::uint64_t count, std::uint64_t limit, bool distinct)
    {
        std::vector<std::string_view> seen_names;
        std::vector<std::uint64_t> seen;
        for (std::uint64_t i = 0; i < count; ++i) {
            seen_names.push_back(walk_.text("a name of the points"));
            seen.push_back(walk_.number<std::uint64_t>("the place of a name"));
            walk_.require(seen.back() < limit, "a place out of range");
        }
        std::sort(seen_names.begin(), seen_names.end());
        std::sort(seen.begin(), seen.end());
        walk_.require(std::adjacent_find(seen_names.begin(), seen_names.end()) == seen_names.end(),
                      "a name that comes twice");
        walk_.require(!distinct || std::adjacent_find(seen.begin(), seen.end()) == seen.end(),
                      "a place that comes twice");
    }

    Array array(std::uint64_t value_size)
    {
        constexpr std::uint8_t kFlags =
            AttributeArray::TRANSIENT | AttributeArray::HIDDEN | AttributeArray::CONSTANTSTRIDE;
        constexpr std::uint8_t kSerialFlags = AttributeArray::WRITESTRIDED |
                                              AttributeArray::WRITEUNIFORM |
                                              AttributeArray::WRITEPAGED;
        // The size counts flags and length too.
        constexpr std::uint64_t kExtra = sizeof(std::int16_t) + sizeof(std::uint32_t);
        const auto bytes = walk_.number<std::uint64_t>("the size of an array");
        const auto flags = walk_.number<std::uint8_t>("the flags of an array");
        const auto serial = walk_.number<std::uint8_t>("the flags of an array");
        walk_.require((flags & ~kFlags) == 0 && (flags & AttributeArray::CONSTANTSTRIDE),
                      "an array of an unknown kind");
        walk_.require((serial & ~kSerialFlags) == 0, "an array that is stored in an unknown way");
        Array found;
        found.points = walk_.number<std::uint32_t>("the length of an array");
        found.uniform = serial & AttributeArray::WRITEUNIFORM;
        found.paged = serial & AttributeArray::WRITEPAGED;
        std::uint64_t stride = 1;
        if (serial & AttributeArray::WRITESTRIDED)
            stride = walk_.number<std::uint32_t>("the stride of an array");
        // Two numbers below 2^32: their product fits, and is bounded before it is multiplied again.
        // OpenVDB counts the bytes of a page by int32.
        constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
        const std::uint64_t elements = found.uniform ? 1 : found.points * stride;
        walk_.require(stride > 0 && bytes > kExtra && elements <= kMost &&
                          bytes - kExtra == elements * value_size,
                      "an array of another size than its length and type");
        found.bytes = bytes - kExtra;
        return found;
    }

    /// As PagedInputStream::createHandle goes.
    std::vector<Page> page_sizes(std::size_t attribute)
    {
        std::vector<Page> pages;
        std::uint64_t left = 0;
        for (std::size_t leaf = 0; leaf < leaves_; ++leaf) {
            const Array& one = array_of(leaf, attribute);
            if (!one.paged)
                continue;
            if (left == 0) {
                pages.push_back(page_size());
                left = std::uint64_t(pages.back().bytes);
            }
            // Invariant: `left` are the bytes of the last page that no leaf has taken yet. A page
            // ends with an array, never within one.
            walk_.require(one.bytes <= left, "values that go beyond their page");
            left -= one.bytes;
        }
        walk_.require(left == 0, "a page that is not filled");
        return pages;
    }

    Page page_size()
    {
        Page page;
        page.stored = walk_.number<std::int32_t>("the size of a page");
        if (page.stored > 0) {
            page.bytes = walk_.number<std::int32_t>("the size of a page");
            walk_.require(page.bytes > 0 && std::uint64_t(page.bytes) / kMostExpansion <=
                                                std::uint64_t(page.stored),
                          "a page of impossible size");
        } else {
            walk_.require(page.stored < 0 && page.stored > std::numeric_limits<std::int32_t>::min(),
                          "a page without bytes");
            // A page that is not compressed has one number for both sizes.
            page.bytes = -page.stored;
        }
        return page;
    }

    /// The points up to and with each voxel of a leaf. Who goes over the points of a voxel takes
    /// them for indices into all arrays of the leaf.
    void voxels(std::size_t leaf)
    {
        std::array<std::uint32_t, kLeafVoxels> ends{};
        walk_.take(kMaskBytes, "a leaf's mask");
        const auto size = walk_.number<std::uint16_t>("the size of a leaf's voxels");
        if (size == std::numeric_limits<std::uint16_t>::max()) {
            const std::string_view stored = walk_.take(sizeof ends, "a leaf's voxels");
            std::memcpy(ends.data(), stored.data(), sizeof ends);
        } else {
            const std::string_view chunk = walk_.take(size, "a leaf's voxels");
            walk_.require(is_blosc_of(chunk, sizeof ends) &&
                              blosc_decompress_ctx(chunk.data(), ends.data(), sizeof ends, 1) ==
                                  int(sizeof ends),
                          "voxels that do not decompress");
        }
        walk_.require(std::is_sorted(ends.begin(), ends.end()), "voxels that are out of order");
        for (std::size_t i = 0; i < sizes_.size(); ++i)
            walk_.require(array_of(leaf, i).points == ends.back(),
                          "an array of another length than its leaf has points");
    }

    /// As PagedInputStream::read goes.
    void values(std::size_t attribute, const std::vector<Page>& pages)
    {
        auto page = pages.begin();
        std::uint64_t left = 0;
        for (std::size_t leaf = 0; leaf < leaves_; ++leaf) {
            const Array& one = array_of(leaf, attribute);
            if (!one.paged) {
                if (!one.uniform)
                    walk_.require(walk_.number<std::uint8_t>("the kind of an array") == 0,
                                  "an array that is compressed by itself");
                walk_.take(one.bytes, "the values of an array");
                continue;
            }
            if (left == 0) {
                left = std::uint64_t(page->bytes);
                page_values(*page++);
            }
            left -= one.bytes;
        }
    }

    void page_values(const Page& page)
    {
        const std::string_view stored =
            walk_.take(std::uint64_t(std::abs(page.stored)), "the values of a page");
        if (page.stored > 0)
            walk_.require(is_blosc_of(stored, std::uint64_t(page.bytes)) ||
                              (page.bytes < kPaddedPage && is_blosc_of(stored, kPaddedPage)),
                          "a page that does not decompress to its size");
    }

    VdbCursor& walk_;
    std::size_t leaves_;
    std::vector<std::uint64_t> sizes_; ///< bytes of a value, by attribute
    std::vector<Array> arrays_;        ///< leaf by leaf
};

} // namespace

void walk_points(VdbCursor& walk, std::size_t leaves)
{
    PointsWalk(walk, leaves).run();
}

} // namespace vdb_shell

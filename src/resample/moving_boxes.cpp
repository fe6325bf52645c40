// SPDX-License-Identifier: Apache-2.0

// Takes boxes, one at a time, and finds those that overlap a box: an R-tree of Boost.Geometry. The
// trees of core/ are built for all boxes at once; here each operation on a surface changes a few of
// them. A lattice of cells for each size of boxes, which stood here before, looked at a cell for
// each small box that there could have been: 60 us a query on a scan of 40,000 triangles with a few
// small ones, instead of 1 us.

#include "resample/moving_boxes.h"

// One of its headers is called deprecated by another of Boost's own.
#define BOOST_ALLOW_DEPRECATED_HEADERS
#include <boost/geometry/algorithms/covered_by.hpp>
#include <boost/geometry/algorithms/equals.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

// Entries of boxes that have gone may be that many before the tree is built anew, and half of all.
constexpr std::size_t kFewestGone = 64;

namespace bg = boost::geometry;
using Corner = bg::model::point<float, 3, bg::cs::cartesian>;
using Box = bg::model::box<Corner>;
using Entry = std::pair<Box, std::pair<std::uint32_t, std::uint32_t>>; // item and time

Box box_of(const FloatBox& box)
{
    return {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
}

} // namespace

struct MovingBoxes::Tree {
    // Of 8 and 16 a node, split by linear, quadratic and R* rules, as fast as any, within a tenth,
    // for a query and for a change on a scan and on a plate of needles.
    bg::index::rtree<Entry, bg::index::quadratic<8>> entries;
};

MovingBoxes::MovingBoxes() : tree_(std::make_unique<Tree>()) {}
MovingBoxes::~MovingBoxes() = default;

void MovingBoxes::build(std::vector<FloatBox> boxes)
{
    boxes_ = std::move(boxes);
    times_.assign(boxes_.size(), 1);
    build_tree();
}

void MovingBoxes::build_tree()
{
    std::vector<Entry> entries;
    entries.reserve(boxes_.size());
    for (std::uint32_t i = 0; i < boxes_.size(); ++i)
        if (times_[i] % 2 != 0)
            entries.push_back({box_of(boxes_[i]), {i, times_[i]}});
    tree_->entries = decltype(tree_->entries)(entries.begin(), entries.end());
    gone_ = 0;
}

void MovingBoxes::insert(std::uint32_t item, const FloatBox& box)
{
    if (item >= boxes_.size()) {
        boxes_.resize(std::size_t(item) + 1);
        times_.resize(boxes_.size());
    }
    boxes_[item] = box;
    tree_->entries.insert({box_of(box), {item, ++times_[item]}});
}

void MovingBoxes::remove(std::uint32_t item)
{
    ++times_[item];
    // The tree would look for the entry in all nodes that overlap its box, which among needles are
    // most of them: a third of what remeshing such a part took.
    if (++gone_ > std::max(kFewestGone, tree_->entries.size() / 2))
        build_tree();
}

void MovingBoxes::overlaps(const FloatBox& box, std::vector<std::uint32_t>& found) const
{
    found.clear();
    const auto overlapping = bg::index::intersects(box_of(box));
    for (auto entry = tree_->entries.qbegin(overlapping); entry != tree_->entries.qend(); ++entry) {
        const auto [item, time] = entry->second;
        if (times_[item] == time)
            found.push_back(item);
    }
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/float_box.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vdb_shell
{

/// Boxes of any size that come and go one by one, and are looked up by box.
class MovingBoxes
{
public:
    MovingBoxes();
    ~MovingBoxes();
    MovingBoxes(const MovingBoxes&) = delete;
    MovingBoxes& operator=(const MovingBoxes&) = delete;
    MovingBoxes(MovingBoxes&&) = delete;
    MovingBoxes& operator=(MovingBoxes&&) = delete;

    /// These boxes, numbered from 0, in place of what there was.
    void build(std::vector<FloatBox> boxes);
    /// Precondition: there is no box of that number.
    void insert(std::uint32_t item, const FloatBox& box);
    /// Precondition: there is one.
    void remove(std::uint32_t item);
    const FloatBox& box(std::uint32_t item) const { return boxes_[item]; }
    /// Fills `found` with the items whose boxes overlap this one.
    void overlaps(const FloatBox& box, std::vector<std::uint32_t>& found) const;

private:
    void build_tree();

    struct Tree; // Boost's headers stay out of this one
    std::unique_ptr<Tree> tree_;
    std::vector<FloatBox> boxes_; ///< by item, of those that have gone too
    /// By item: how often it has come or gone, so odd while it is there. Entries of the tree carry
    /// the number of their time.
    std::vector<std::uint32_t> times_;
    std::size_t gone_ = 0; ///< entries of the tree whose boxes have gone
};

} // namespace vdb_shell

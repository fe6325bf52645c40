// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "core/parallel.h"
#include "core/stage_progress.h"

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{

using TetIndexLeaf = openvdb::Int32Tree::LeafNodeType;

/// Leaves of a grid under construction, one for each leaf of a grid of tets: threads fill them, and
/// the tree is made of them afterwards in order.
template <typename Grid> class VoxelLeaves
{
public:
    using Leaf = typename Grid::TreeType::LeafNodeType;
    using Value = typename Grid::ValueType;

    VoxelLeaves() = default;
    VoxelLeaves(std::string name, const Value& background, std::size_t count)
        : name_(std::move(name)), background_(background), leaf_(count)
    {
    }

    bool wanted() const { return !leaf_.empty(); }
    /// With the active voxels of `like`, or with none.
    void begin(std::size_t i, const TetIndexLeaf& like, bool active = true)
    {
        if (!wanted())
            return;
        leaf_[i] = std::make_unique<Leaf>(like.origin(), background_, false);
        if (active)
            leaf_[i]->setValueMask(like.getValueMask());
    }
    void set(std::size_t i, openvdb::Index voxel, const Value& value)
    {
        if (wanted())
            leaf_[i]->setValueOnly(voxel, value);
    }
    void set_on(std::size_t i, openvdb::Index voxel, const Value& value)
    {
        leaf_[i]->setValueOn(voxel, value);
    }

    /// Leaves without an active voxel are left out.
    typename Grid::Ptr grid(const openvdb::math::Transform& transform)
    {
        auto made = Grid::create(background_);
        made->setTransform(transform.copy());
        made->setName(name_);
        for (std::unique_ptr<Leaf>& leaf : leaf_)
            if (leaf && !leaf->isEmpty())
                made->tree().addLeaf(leaf.release());
        return made;
    }

private:
    std::string name_;
    Value background_{};
    std::vector<std::unique_ptr<Leaf>> leaf_;
};

/// body(i, leaf) for the leaves of a grid, on all threads, asking now and then whether to stop.
template <typename Body>
void for_each_leaf(const openvdb::Int32Grid& tets, const StageProgress& progress, const Body& body)
{
    std::vector<const TetIndexLeaf*> leaves;
    tets.tree().getNodes(leaves);
    // Some milliseconds of work a block on two threads: soon enough for who waits for an answer.
    constexpr std::size_t kBlock = 2048;
    for (std::size_t begin = 0; begin < leaves.size(); begin += kBlock) {
        progress.stop_if_interrupted(int(100 * begin / leaves.size()));
        for_each_index(
            std::min(kBlock, leaves.size() - begin),
            [&](std::size_t i) { body(begin + i, *leaves[begin + i]); }, 1);
    }
}

} // namespace vdb_shell

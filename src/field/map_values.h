// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <openvdb/tree/NodeManager.h>

namespace vdb_shell
{

/// What map_values does to a node.
template <typename Change> struct MapNode {
    const Change& change;

    void operator()(openvdb::FloatTree::LeafNodeType& leaf) const
    {
        float* const values = leaf.buffer().data();
        for (openvdb::Index i = 0; i < leaf.SIZE; ++i)
            values[i] = change(values[i]);
    }
    template <typename Node> void operator()(Node& node) const
    {
        for (auto value = node.beginValueAll(); value; ++value)
            value.setValue(change(*value));
    }
};

/// Replaces every value of the tree, active or not, and its background by change(value); called
/// from several threads at a time. The iterators of tools::foreach climb the tree from value to
/// value.
template <typename Change> void map_values(openvdb::FloatTree& tree, const Change& change)
{
    openvdb::tree::NodeManager<openvdb::FloatTree> nodes(tree);
    nodes.foreachTopDown(MapNode<Change>{change});
    // Inactive values are changed already, so the root must not replace them once more.
    tree.root().setBackground(change(tree.background()), false);
}

} // namespace vdb_shell

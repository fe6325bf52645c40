// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "core/parallel.h"

#include <vector>

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

/// MapNode for all nodes of one level.
template <typename Node, typename Change>
void map_nodes(openvdb::FloatTree& tree, const Change& change, std::size_t grain)
{
    std::vector<Node*> nodes;
    tree.getNodes(nodes);
    for_each_index(
        nodes.size(), [&](std::size_t i) { MapNode<Change>{change}(*nodes[i]); }, grain);
}

/// Replaces every value of the tree, active or not, and its background by change(value); called
/// from several threads at a time. The iterators of tools::foreach climb the tree from value to
/// value.
template <typename Change> void map_values(openvdb::FloatTree& tree, const Change& change)
{
    using Root = openvdb::FloatTree::RootNodeType;
    using Upper = Root::ChildNodeType;
    using Lower = Upper::ChildNodeType;
    map_nodes<openvdb::FloatTree::LeafNodeType>(tree, change, 64);
    map_nodes<Lower>(tree, change, 1);
    map_nodes<Upper>(tree, change, 1);
    MapNode<Change>{change}(tree.root());
    // Inactive values are changed already, so the root must not replace them once more.
    tree.root().setBackground(change(tree.background()), false);
}

} // namespace vdb_shell

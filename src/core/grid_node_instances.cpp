// SPDX-License-Identifier: Apache-2.0

// The inner nodes of the tree of floats, compiled once (grid_instances.h). Apart from the tree, so
// that neither source takes long.

#include "core/grid_instances.h"

template class openvdb::tree::InternalNode<
    openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType, 5>;
template class openvdb::tree::InternalNode<openvdb::FloatTree::LeafNodeType, 4>;

// SPDX-License-Identifier: Apache-2.0

// The grid of whole numbers, its tree and nodes, compiled once (grid_instances.h).

#include "core/grid_instances.h"

template class openvdb::Grid<openvdb::Int32Tree>;
template class openvdb::tree::Tree<openvdb::Int32Tree::RootNodeType>;
template class openvdb::tree::InternalNode<
    openvdb::Int32Tree::RootNodeType::ChildNodeType::ChildNodeType, 5>;
template class openvdb::tree::InternalNode<openvdb::Int32Tree::LeafNodeType, 4>;

// SPDX-License-Identifier: Apache-2.0

// The grid of vectors, its tree and nodes, compiled once (grid_instances.h).

#include "core/grid_instances.h"

template class openvdb::Grid<openvdb::Vec3STree>;
template class openvdb::tree::Tree<openvdb::Vec3STree::RootNodeType>;
template class openvdb::tree::InternalNode<
    openvdb::Vec3STree::RootNodeType::ChildNodeType::ChildNodeType, 5>;
template class openvdb::tree::InternalNode<openvdb::Vec3STree::LeafNodeType, 4>;

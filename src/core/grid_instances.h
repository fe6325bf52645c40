// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB's grids of floats, whole numbers and vectors for sources that look into them, with their
// code in one place (grid_instances.cpp, grid_node_instances.cpp, int_grid_instances.cpp,
// vector_grid_instances.cpp). Without these lines every source that makes or copies a grid compiles
// all virtual functions of grid, tree and nodes again, a thousand of them: contour.cpp 24 s
// without, 6 s with, coordinate_grids.cpp 22 and 5 s (GCC 12, OpenVDB 10.0.1). Functions that the
// compiler takes for small are put in line as before. Leaves and the root are left out, for OpenVDB
// has functions there that nobody can call.

#include <openvdb/openvdb.h>

extern template class openvdb::Grid<openvdb::FloatTree>;
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
extern template class openvdb::tree::InternalNode<
    openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType, 5>;
extern template class openvdb::tree::InternalNode<openvdb::FloatTree::LeafNodeType, 4>;

extern template class openvdb::Grid<openvdb::Int32Tree>;
extern template class openvdb::tree::Tree<openvdb::Int32Tree::RootNodeType>;
extern template class openvdb::tree::InternalNode<
    openvdb::Int32Tree::RootNodeType::ChildNodeType::ChildNodeType, 5>;
extern template class openvdb::tree::InternalNode<openvdb::Int32Tree::LeafNodeType, 4>;

extern template class openvdb::Grid<openvdb::Vec3STree>;
extern template class openvdb::tree::Tree<openvdb::Vec3STree::RootNodeType>;
extern template class openvdb::tree::InternalNode<
    openvdb::Vec3STree::RootNodeType::ChildNodeType::ChildNodeType, 5>;
extern template class openvdb::tree::InternalNode<openvdb::Vec3STree::LeafNodeType, 4>;

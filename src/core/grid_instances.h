// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB's grids of floats, whole numbers and vectors for sources that look into them, with their
// code in one place (grid_instances.cpp, grid_node_instances.cpp, int_grid_instances.cpp,
// vector_grid_instances.cpp). Without these lines every source that makes or copies a grid compiles
// all virtual functions of grid, tree and nodes again, a thousand of them: contour.cpp 24 s without,
// 6 s with, coordinate_grids.cpp 22 and 5 s (GCC 12, OpenVDB 10.0.1). Functions that the compiler
// takes for small are put in line as before. Leaves and the root are left out, for OpenVDB has
// functions there that nobody can call.

#include <openvdb/openvdb.h>

// `linkage`: extern, or nothing where the code is.
#define VDB_SHELL_TREE(linkage, Type)                                                              \
    linkage template class openvdb::Grid<Type>;                                                    \
    linkage template class openvdb::tree::Tree<Type::RootNodeType>;
#define VDB_SHELL_NODES(linkage, Type)                                                             \
    linkage template class openvdb::tree::InternalNode<                                            \
        Type::RootNodeType::ChildNodeType::ChildNodeType, 5>;                                      \
    linkage template class openvdb::tree::InternalNode<Type::LeafNodeType, 4>;

VDB_SHELL_TREE(extern, openvdb::FloatTree)
VDB_SHELL_NODES(extern, openvdb::FloatTree)
VDB_SHELL_TREE(extern, openvdb::Int32Tree)
VDB_SHELL_NODES(extern, openvdb::Int32Tree)
VDB_SHELL_TREE(extern, openvdb::Vec3STree)
VDB_SHELL_NODES(extern, openvdb::Vec3STree)

// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB's grids for sources that look into them, without the code that OpenVDB's library holds
// already: its initialize() registers these grids, and so all virtual functions of their trees are
// in it. Without this each source that makes or copies a grid compiles them again, more than
// half of its time (pipeline.cpp: 25 s with, 11 s without; GCC 12, OpenVDB 10.0.1). CMake tries
// whether the library at hand gives them away, and only optimised builds rely on it: others call
// functions out of line that the library may not have.

#include <openvdb/openvdb.h>

#ifdef VDB_SHELL_GRIDS_IN_OPENVDB
#define VDB_SHELL_GRID_IN_OPENVDB(TreeType)                                                        \
    extern template class openvdb::tree::Tree<TreeType::RootNodeType>;                             \
    extern template class openvdb::tree::RootNode<TreeType::RootNodeType::ChildNodeType>
#else
#define VDB_SHELL_GRID_IN_OPENVDB(TreeType) static_assert(true)
#endif

VDB_SHELL_GRID_IN_OPENVDB(openvdb::FloatTree);
VDB_SHELL_GRID_IN_OPENVDB(openvdb::Int32Tree);
VDB_SHELL_GRID_IN_OPENVDB(openvdb::BoolTree);

// SPDX-License-Identifier: Apache-2.0

// The grid of whole numbers, its tree and nodes, compiled once (grid_instances.h).

#include "core/grid_instances.h"

VDB_SHELL_TREE(, openvdb::Int32Tree)
VDB_SHELL_NODES(, openvdb::Int32Tree)

// SPDX-License-Identifier: Apache-2.0

// The grid of vectors, its tree and nodes, compiled once (grid_instances.h).

#include "core/grid_instances.h"

VDB_SHELL_TREE(, openvdb::Vec3STree)
VDB_SHELL_NODES(, openvdb::Vec3STree)

// SPDX-License-Identifier: Apache-2.0

// The grid of floats and its tree, compiled once (grid_instances.h).

#include "core/grid_instances.h"

VDB_SHELL_TREE(, openvdb::FloatTree)

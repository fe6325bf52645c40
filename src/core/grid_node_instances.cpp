// SPDX-License-Identifier: Apache-2.0

// The inner nodes of the tree of floats, compiled once (grid_instances.h). Apart from the tree, so
// that neither source takes long.

#include "core/grid_instances.h"

VDB_SHELL_NODES(, openvdb::FloatTree)

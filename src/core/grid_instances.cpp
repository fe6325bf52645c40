// SPDX-License-Identifier: Apache-2.0

// The grid of floats and its tree, compiled once (grid_instances.h).

#include "core/grid_instances.h"

template class openvdb::Grid<openvdb::FloatTree>;
template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;

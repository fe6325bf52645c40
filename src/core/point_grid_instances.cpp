// SPDX-License-Identifier: Apache-2.0

// The grid of points and its tree, compiled once (point_grid_instances.h).

#include "core/point_grid_instances.h"

template class openvdb::Grid<openvdb::points::PointDataTree>;
template class openvdb::tree::Tree<openvdb::points::PointDataTree::RootNodeType>;

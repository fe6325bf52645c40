// SPDX-License-Identifier: Apache-2.0

// The grid of points' indices and its tree, compiled once (point_grid_instances.h).

#include "core/point_grid_instances.h"

template class openvdb::Grid<openvdb::tools::PointIndexTree>;
template class openvdb::tree::Tree<openvdb::tools::PointIndexTree::RootNodeType>;

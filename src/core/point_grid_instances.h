// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB's grids of points and of their indices, as core/grid_instances.h has that of floats.

#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/PointIndexGrid.h>

extern template class openvdb::Grid<openvdb::points::PointDataTree>;
extern template class openvdb::tree::Tree<openvdb::points::PointDataTree::RootNodeType>;
extern template class openvdb::Grid<openvdb::tools::PointIndexTree>;
extern template class openvdb::tree::Tree<openvdb::tools::PointIndexTree::RootNodeType>;

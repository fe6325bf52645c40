// SPDX-License-Identifier: Apache-2.0
#pragma once

// OpenVDB's grids of points, as core/grid_instances.h has the others.

#include "core/grid_instances.h"

#include <openvdb/points/PointDataGrid.h>
#include <openvdb/tools/PointIndexGrid.h>

VDB_SHELL_GRID_IN_OPENVDB(openvdb::points::PointDataTree);
// Of the tree of indices the library lacks some functions of its root.
#ifdef VDB_SHELL_GRIDS_IN_OPENVDB
extern template class openvdb::tree::Tree<openvdb::tools::PointIndexTree::RootNodeType>;
#endif

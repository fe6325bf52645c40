// SPDX-License-Identifier: Apache-2.0

// Links if OpenVDB's library gives away its grids (core/grid_instances.h). For CMake only.

#include "write/point_grid_instances.h"

namespace
{

template <class Tree> bool is_empty()
{
    const openvdb::TreeBase::Ptr tree = std::make_shared<Tree>();
    return tree->activeVoxelCount() == 0;
}

} // namespace

int main()
{
    return is_empty<openvdb::FloatTree>() && is_empty<openvdb::Int32Tree>() &&
                   is_empty<openvdb::BoolTree>() && is_empty<openvdb::points::PointDataTree>() &&
                   is_empty<openvdb::tools::PointIndexTree>()
               ? 0
               : 1;
}

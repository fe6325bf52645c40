// SPDX-License-Identifier: Apache-2.0

// Takes a grid; gives the range of its active values. Here alone, for OpenVDB's reduction over a
// tree takes each source that calls it three seconds (GCC 12, OpenVDB 10.0.1).

#include "field/value_range.h"

#include "core/grid_instances.h"

#include <openvdb/tools/Count.h>

namespace vdb_shell
{

ValueRange value_range(const openvdb::FloatGrid& grid)
{
    const auto range = openvdb::tools::minMax(grid.tree());
    return {range.min(), range.max()};
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"

namespace vdb_shell
{

/// The least and the greatest active value of a grid.
struct ValueRange {
    float least, greatest;
};
ValueRange value_range(const openvdb::FloatGrid& grid);

} // namespace vdb_shell

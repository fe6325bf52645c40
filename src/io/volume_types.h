// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "vdb_shell/core/error.h"

#include <string>

namespace vdb_shell
{

/// Volumes that are read and worked on: those, besides points, that require_whole_vdb walks to the
/// end.
using VolumeTypes = openvdb::TypeList<openvdb::FloatGrid, openvdb::Vec3SGrid, openvdb::Int32Grid>;

/// use(grid) with the grid's own type. `what`: what cannot be done with others, for InvalidOption.
template <typename Use>
void with_volume(const openvdb::GridBase& grid, const char* what, const Use& use)
{
    if (!grid.apply<VolumeTypes>(use))
        throw InvalidOption("grid \"" + grid.getName() + "\" has values of type " +
                            grid.valueType() + "; floats, vectors and whole numbers can be " +
                            what);
}

} // namespace vdb_shell

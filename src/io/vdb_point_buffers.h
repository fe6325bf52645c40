// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/point_grid_instances.h"
#include "io/vdb_bytes.h"

namespace vdb_shell
{

/// Whether these are points, some of them, and all leaves have the same attributes.
bool has_alike_leaves(const openvdb::GridBase& grid);

/// What OpenVDB writes of points behind their topology, byte for byte, on all threads.
/// Precondition: has_alike_leaves. `settings` are those of the stream that the topology was written
/// to.
VdbParts point_buffers(const openvdb::points::PointDataGrid& grid,
                       const openvdb::io::StreamMetadata& settings);

} // namespace vdb_shell

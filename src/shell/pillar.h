// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

namespace vdb_shell
{

/// outer + length * inward as the nearest float32 point, stepped back by single floats while the
/// pillar is longer than `length` (exact::longer_than). It has the very bits of `outer` when the
/// length is lost in the rounding.
openvdb::Vec3s end_of_pillar(const openvdb::Vec3s& outer, const openvdb::Vec3d& inward,
                             double length);

} // namespace vdb_shell

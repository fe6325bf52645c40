// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <vector>

namespace vdb_shell::samples
{

// Motions to try poses with. `phase` goes from 0, the rest shape, to 1.

/// The creature walking, from step to step: 24 bones, linear blend skinning. Knees bend up to 130
/// degrees, so the skin crosses itself in some frames, as skins do. Phase 0 is not the rest shape.
std::vector<openvdb::Vec3s> walk(const std::vector<openvdb::Vec3s>& rest, double phase);

/// Turned about its longest axis, one end against the other by `degrees` at phase 1.
std::vector<openvdb::Vec3s> twist(const std::vector<openvdb::Vec3s>& rest, double degrees,
                                  double phase);

/// Along its longest axis to `share` of its length at phase 1, and as much wider as keeps volume.
std::vector<openvdb::Vec3s> squash(const std::vector<openvdb::Vec3s>& rest, double share,
                                   double phase);

/// Its longest axis on an arc of `degrees` at phase 1, both ends moved towards y; its length is
/// kept on the axis. Precondition: its longest axis is not y, and 0 < `degrees` < 360.
std::vector<openvdb::Vec3s> bend(const std::vector<openvdb::Vec3s>& rest, double degrees,
                                 double phase);

} // namespace vdb_shell::samples

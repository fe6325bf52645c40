// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <vector>

namespace vdb_shell::exact
{

/// The other two corners of a triangle at an apex, counter-clockwise from outside.
using Side = std::array<openvdb::Vec3s, 2>;

/// Whether some direction d sees all triangles (apex, side) from inside: det(q - apex, p - apex, d)
/// > 0 for each side p, q, so that a point near the apex makes a positive tet with each. By
/// rational numbers on the float32 coordinates: always right. A triangle without area is seen from
/// nowhere.
bool a_direction_sees(const openvdb::Vec3s& apex, const std::vector<Side>& sides);

/// Whether some point makes a positive tet (a, b, c, point) with each of these triangles, wherever
/// they lie. Always right, as above.
bool a_point_sees(const std::vector<std::array<openvdb::Vec3s, 3>>& triangles);

} // namespace vdb_shell::exact

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdb_shell::exact
{

/// Sign (-1, 0, 1) of the volume enclosed by the chosen triangles, which close up: always right.
int volume_sign(const std::vector<openvdb::Vec3s>& points,
                const std::vector<openvdb::Vec3I>& triangles,
                const std::vector<std::uint32_t>& chosen);

/// The same of each of `count` components, to which vertices belong. Precondition: all corners of a
/// triangle belong to one.
std::vector<int> volume_signs(const std::vector<openvdb::Vec3s>& points,
                              const std::vector<openvdb::Vec3I>& triangles,
                              const std::vector<int>& component_of_vertex, int count);

/// Whether the signed volumes of the tets sum up to the volume that the triangles enclose, which
/// close up: always right, in whole numbers of any size.
bool same_volume(const std::vector<openvdb::Vec3s>& points, const std::vector<openvdb::Vec4I>& tets,
                 const std::vector<openvdb::Vec3s>& surface_points,
                 const std::vector<openvdb::Vec3I>& triangles);

} // namespace vdb_shell::exact

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <openvdb/Types.h>

#include <vector>

namespace vdb_shell
{

/// `v` at unit length, or zero where it is shorter than 1e-9 of `scale`: the length that it would
/// have if nothing in it had cancelled.
openvdb::Vec3d unit_or_zero(const openvdb::Vec3d& v, double scale);

/// Angle-weighted pseudo-normals, outward, unit length (zero where the incident triangles cancel).
std::vector<openvdb::Vec3d> pseudo_normals(const TriangleMesh& mesh);

/// Smallest cosine between `outward` and the normals of the triangles around each vertex.
std::vector<double> visibility_of(const TriangleMesh& mesh,
                                  const std::vector<openvdb::Vec3d>& outward);

} // namespace vdb_shell

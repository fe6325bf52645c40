// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

namespace vdb_shell
{

/// A closed, embedded surface around closed ones, oriented outward: no point of it, and so no point
/// outside of it, is nearer to the mesh than `distance`, measured between triangles in doubles. It
/// is a voxel farther out at most, or nearly so, a voxel being half the distance, or more where
/// the mesh is large beside that. Same result for any number of threads.
/// Throws InvalidOption for a distance of which float32 leaves nothing; GeometryError; Cancelled.
/// Precondition: the mesh is closed, manifold, embedded and outward, and has no part inside
/// another; the distance is positive.
TriangleMesh offset_surface(const TriangleMesh& mesh, double distance,
                            Interrupter* interrupter = nullptr);

TriangleMesh without_unused_points(const TriangleMesh& mesh);

} // namespace vdb_shell

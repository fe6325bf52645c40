// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <vector>

namespace vdb_shell
{

/// The triangles of a closed mesh by how many other components enclose theirs: entry 0 holds the
/// outermost surfaces, entry 1 cavities, entry 2 solids inside cavities... All entries keep the
/// points of the whole mesh.
/// Bodies that cross are not within each other unless one lies wholly in the other. The interrupter
/// may be null; throws Cancelled.
std::vector<TriangleMesh> split_by_nesting(const TriangleMesh& mesh, Interrupter* interrupter);

/// Takes a cavity out of a solid, in place: max(solid, -cavity) wherever either is active.
/// Precondition: `cavity` is negative inside the cavity, with all of its interior active and an
/// exterior band as deep as the solid is.
void subtract_cavity(openvdb::FloatGrid& solid, const openvdb::FloatGrid& cavity);

/// Adds a solid that stands in a cavity of the first one, in place: min of both.
void add_solid(openvdb::FloatGrid& solid, const openvdb::FloatGrid& added);

} // namespace vdb_shell

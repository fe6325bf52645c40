// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/field/level_set.h"
#include "vdb_shell/growth/grow.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/step/directions.h"
#include "vdb_shell/step/line_step.h"

#include <openvdb/openvdb.h>

#include <cstdint>

namespace vdb_shell::bench
{

/// Surfaces whose shells are well understood: what changes between two runs is the code.
enum class Surface {
    icosphere, ///< size: subdivisions; 20 * 4^size triangles
    torus,     ///< size: vertices around; 4/3 * size^2 triangles
};
const char* name_of(Surface surface);

/// Voxels along the longest side of the bounding box, in every stage that reads a field.
inline constexpr int kResolution = 256;

/// Options of a level set that is as deep as lines go, and of a usual one, three voxels to either
/// side.
LevelSetOptions deep_options();
LevelSetOptions narrow_options(const TriangleMesh& mesh);

/// A surface and what the stages before the measured one make of it: made at the first call, then
/// kept, so that no benchmark pays for the stages before its own.
const TriangleMesh& mesh_of(Surface surface, std::int64_t size);
const openvdb::FloatGrid& deep_field_of(Surface surface, std::int64_t size);
/// By mesh_to_narrow_band.
const openvdb::FloatGrid& narrow_field_of(Surface surface, std::int64_t size);
const Directions& directions_of(Surface surface, std::int64_t size);
const LineLengths& lengths_of(Surface surface, std::int64_t size);
const GrowResult& shell_of(Surface surface, std::int64_t size);
const TetMesh& tets_of(Surface surface, std::int64_t size);

} // namespace vdb_shell::bench

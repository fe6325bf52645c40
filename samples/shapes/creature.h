// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/polygon_mesh.h"

namespace vdb_shell::samples
{

/// The creature as a field: negative inside, zero on its skin, roughly a distance near it. It looks
/// along +z with y up, is some 2.9 long, and leans a little to one side everywhere. Only arithmetic
/// and square roots, so that the values do not depend on a maths library.
double creature_field(const openvdb::Vec3d& position);

/// The creature's skin as triangles.
PolygonMesh creature();

} // namespace vdb_shell::samples

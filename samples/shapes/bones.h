// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/polygon_mesh.h"

namespace vdb_shell::samples
{

/// Bones for the creature, all inside its skin and apart from each other: skull, spine, tail,
/// thighs and shins.
PolygonMesh creature_bones();

} // namespace vdb_shell::samples

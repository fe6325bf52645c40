// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/field/contour.h"

#include <functional>

namespace vdb_shell
{

using PointMap = std::function<openvdb::Vec3d(const openvdb::Vec3d&)>;

/// contour() with a map from index space to the world of its own: a transform of OpenVDB cannot
/// hold voxels under 1.5e-5. Precondition: the map is affine. Where it mirrors, triangles come
/// out inside out, and contour() turns them back.
TriangleMesh contour_mapped(const openvdb::FloatGrid& field, const PointMap& to_world,
                            const ContourOptions& options, ContourReport& report,
                            Interrupter* interrupter);

} // namespace vdb_shell

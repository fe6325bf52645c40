// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

namespace vdb_shell
{

struct SubdivideOptions {
    /// How often every triangle is cut into four, 0 or more.
    int levels = 0;
};
OptionList describe(SubdivideOptions& options);

/// Every triangle cut into four at the middles of its edges, `levels` times: 4^levels times as many
/// triangles on the same shape. The middles are rounded to float32, so surface and middle are apart
/// by half a unit in the last place of the coordinates; on triangles not much larger than that the
/// surface may cross itself afterwards, which check_mesh tells. Points of before keep their
/// indices. Throws InvalidOption for a negative number of levels or one that would give 2^30
/// triangles or more. Precondition: corners index the points.
TriangleMesh subdivide(const TriangleMesh& mesh, const SubdivideOptions& options);

} // namespace vdb_shell

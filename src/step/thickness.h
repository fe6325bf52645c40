// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/step/line_step.h"

namespace vdb_shell
{

/// The user's largest length per vertex, from the number and the painted grid (may be null), the
/// smaller where both are given; infinite where there is neither. Throws GeometryError with the
/// vertex where the grid's sample is negative or not finite.
std::vector<double> largest_lengths(const TriangleMesh& mesh, const LineStepOptions& options,
                                    const openvdb::FloatGrid* thickness_grid);

} // namespace vdb_shell

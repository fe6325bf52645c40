// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pipeline.h"

#include "report/stage_clock.h"

namespace vdb_shell
{

/// Puts the surface to work with into `result`: wrapped, repaired or mended as the options ask for,
/// checked, found usable and turned outward. Throws GeometryError for one that is not usable, and
/// what wrap_mesh and repair_mesh throw.
void prepare_surface(ShellResult& result, const TriangleMesh& mesh, const ShellOptions& options,
                     StageClock& clock, Interrupter* interrupter);

} // namespace vdb_shell

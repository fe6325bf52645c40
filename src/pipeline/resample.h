// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pipeline.h"

#include "report/stage_clock.h"

namespace vdb_shell
{

/// Retriangulates, decimates, remeshes and subdivides the surface as the options ask for, and looks
/// at it anew.
void resample_surface(ShellResult& result, const ShellOptions& options, StageClock& clock,
                      Interrupter* interrupter);

/// build_sides, and then as often as RefineOptions asks for: triangles cut where the shell leaves
/// voids, and build_sides again in the same field, on from the shell there is. Keeps the shell of
/// the highest fill with its surface; of the raw method, the last.
void build_and_refine(ShellResult& result, const ShellOptions& options, const GrowStart& start,
                      const openvdb::FloatGrid* thickness_grid, StageClock& clock,
                      Interrupter* interrupter);

} // namespace vdb_shell

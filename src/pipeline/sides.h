// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pipeline.h"

#include "report/stage_clock.h"

namespace vdb_shell
{

/// What growth inward begins with: coarser surfaces where the surface has triangles enough
/// (GrowOptions::coarse_from). Only their lines are stepped then.
GrowStart start_of_growth(const ShellOptions& options, const TriangleMesh& surface,
                          Interrupter* interrupter);

/// Why the lines need a dense field, or an empty string when a narrow band will do. Reads the
/// result's surface and what the check found.
std::string why_not_sparse(const ShellOptions& options, const ShellResult& result,
                           const GrowStart& start, const openvdb::FloatGrid* thickness_grid);

/// The band that the lines of the options' side need, no deeper than the longest line that the user
/// allows.
LevelSetOptions band_for(const ShellOptions& options, const TriangleMesh& surface,
                         const openvdb::FloatGrid* thickness_grid);

/// The stages from directions to scale, once for each side: fills in lines, stack and their parts
/// of the report. Leaves the level set as it was. `start` is that of growth inward.
void build_sides(ShellResult& result, const ShellOptions& options,
                 const openvdb::FloatGrid* thickness_grid, StageClock& clock,
                 Interrupter* interrupter, const GrowStart& start);

} // namespace vdb_shell

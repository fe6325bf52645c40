// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/pipeline.h"

#include "report/stage_clock.h"

#include <vector>

namespace vdb_shell
{

/// Looks at the cores and makes them part of the surface, pinned. Without cores it does nothing.
void join_with_cores(ShellResult& result, const std::vector<CoreMesh>& cores,
                     const ShellOptions& options, StageClock& clock, Interrupter* interrupter);

/// The result without them, after the certificate; the tets are the same, and the pillars get their
/// feet on the cores.
void part_from_cores(ShellResult& result, const ShellOptions& options, StageClock& clock);

/// The surfaces of the cores as what fills the shell has to leave them; empty without cores.
TriangleMesh holes_of(const ShellResult& result);

/// What the surface encloses, less the cores.
TriangleMesh solid_to_fill(const ShellResult& result);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "growth/grow_state.h"
#include "growth/relax_options.h"
#include "vdb_shell/growth/grow.h"

#include <vector>

namespace vdb_shell::growth
{

/// Inner vertices leave their lines: each minimises the volume inside the inner surface with an
/// interior barrier on the tets around it and on the separating planes near it, and every move is
/// tested exactly before it is made. Never ends with less fill than it began with. Adds to the
/// report's rounds, flips and released pins. Pinned vertices of positive `visibility` are tried
/// again on the way.
void relax(GrowState& s, const std::vector<double>& visibility, const GrowOptions& options,
           const RelaxOptions& relax_options, const StageProgress& progress, GrowReport& report);

/// Leaves the twelve-tet test for the three-tet test, on which the state stays.
void test_three_tets(GrowState& s);

/// All the rounds on the surface itself, under the test that the options ask for; for
/// Method::thickest under the twelve-tet test, unless the state has left it, and then under the
/// three-tet test. `rounds` counts for any other method.
void relax_fully(GrowState& s, StartedFrom from, std::vector<double> predicted_gain,
                 const std::vector<double>& visibility, const GrowOptions& options,
                 const AttemptRounds& rounds, const StageProgress& progress, GrowReport& report);

} // namespace vdb_shell::growth

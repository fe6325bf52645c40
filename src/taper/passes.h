// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "taper/taper_state.h"

#include <cstddef>

namespace vdb_shell::taper
{

struct MergeOptions {
    /// Nodes of the innermost surface that are no neighbours are tried too where they are nearer
    /// than this share of the way to the nearest neighbour: across the void, to close it. 0: none.
    double across = 0.5;
    bool into_level_above = false; ///< also a place with the one above it: a layer ends there
};

/// One try of each change of a kind, in an order of its own; how many were made. Deterministic.
/// Throws Cancelled between two tries.
std::size_t merge_pass(TaperState& s, const MergeOptions& options, const StageProgress& progress,
                       int percent);
std::size_t move_pass(TaperState& s, const StageProgress& progress, int percent);
std::size_t hand_over_pass(TaperState& s, const StageProgress& progress, int percent);
std::size_t turn_pass(TaperState& s, const StageProgress& progress, int percent);

} // namespace vdb_shell::taper

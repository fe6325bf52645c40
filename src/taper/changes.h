// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "taper/taper_state.h"

#include <cstddef>

namespace vdb_shell::taper
{

/// Single changes of a valid state, each made only if the state is valid after it and costs less.
/// True: it was made.

/// Node `from` becomes one with node `to`, at the best of few points: the two and the one halfway.
bool merge(TaperState& s, int from, int to);

/// A Newton step of the node's own convex problem, halved until it passes.
bool move(TaperState& s, int n);

/// A place of a node that has others goes over to node `to`.
bool reassign(TaperState& s, int place, int to);

/// Turns the diagonal over an edge of a layer.
bool turn(TaperState& s, int layer, int edge);

/// Passes over all of the state's nodes; each returns how many changes it made.
std::size_t merge_pass(TaperState& s);
std::size_t move_pass(TaperState& s);
std::size_t reassign_pass(TaperState& s);
std::size_t turn_pass(TaperState& s);

} // namespace vdb_shell::taper

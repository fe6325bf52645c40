// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "growth/initialise.h"
#include "growth/relax_options.h"
#include "vdb_shell/growth/grow.h"

#include <cstddef>
#include <vector>

namespace vdb_shell::growth
{

/// A way to a shell.
struct Attempt {
    GrowFrom from;
    LineStart start; ///< GrowFrom::lines
    GrowOptions options;
    AttemptRounds rounds = {};
};

/// Whether a surface of so many triangles is grown in one way alone, for each takes its time.
bool too_large_for_attempts(std::size_t triangles, const GrowOptions& options);

/// The ways that are tried until a shell is full enough, the one that is the best on most surfaces
/// first; one alone for a large surface on levels, and for a start from a shell. Beside needles and
/// between flat walls the first leads into a corner, and nothing tells beforehand which does not
/// (docs/measurements/tried.md, "Machined parts").
std::vector<Attempt> attempts_of(const GrowStart& start, std::size_t triangles,
                                 const GrowOptions& options);

/// Share of the solid from which no way after this one is tried.
double enough_for(const Attempt& attempt);

/// Growth from the shell that it has come to: a barrier that weighs as much as at first parts inner
/// vertices that have jammed, and rounds win some of what they had left. Nothing is lost by that,
/// for the fuller shell is kept.
struct Restarts {
    Attempt attempt; ///< from the fullest shell
    int most;        ///< how often, as long as each wins RestartSchedule::least_gain_of_void
    double enough;   ///< share of the solid from which there is none
};
/// After that attempt and the others.
Restarts restarts_of(const Attempt& first, std::size_t triangles);

} // namespace vdb_shell::growth

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/resample/refine_triangles.h"
#include "vdb_shell/shell/prism_shell.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdb_shell
{

/// What makes a triangle worth cutting.
enum class RefineBy {
    contacts, ///< its area times the mean over its corners of how much shorter their pillars are
              ///< than their neighbours', where a contact, a prism or a stop test ends them, or
              ///< nobody asked (GrowOptions::stop_reasons)
    voids,    ///< the volume that its prism leaves empty: half the way to the next inner triangle
    area,     ///< its area; with a share of 1 all triangles are cut: uniform subdivision in rounds
};
const NameTable<RefineBy>& names(RefineBy);

struct RefineOptions {
    /// Rounds of building, cutting triangles in four where it is worth it, and growing on from the
    /// shell there is. 0: none.
    int rounds = 0;
    RefineBy by = RefineBy::contacts;
    /// In each round as many triangles are cut, those of the largest predicted gain first, as make
    /// up this share of the sum over all; more than 0, up to 1.
    double share = 0.5;
    /// No round makes a surface whose prisms, in all layers, could give more tets than this.
    std::optional<std::size_t> max_tets;
    /// The rounds end when the fill (of the layers inside) has reached this.
    std::optional<double> target_fill;
    /// The rounds end when one has gained less fill than this; 0: never for that reason.
    double min_gain = 0;
};
OptionList describe(RefineOptions& options);

/// Throws InvalidOption when an option is out of its range.
void require_sensible(const RefineOptions& options);

/// Why the rounds ended.
enum class RefineEnd {
    rounds,      ///< all were made
    target_fill, ///< the wanted fill is reached
    max_tets,    ///< no triangle could be cut within the wanted number of tets
    small_gain,  ///< the last round gained less than was asked for
    nothing,     ///< nothing is left that could be cut
};

/// Name for reports: "rounds", "target_fill", ...
const char* name_of(RefineEnd end);

struct RefineRound {
    std::size_t triangles = 0, tets = 0;
    double fill = 0;
    std::size_t cut = 0;          ///< triangles chosen for the next round
    std::size_t barred_edges = 0; ///< edges left whole for rounding's sake, RefinedMesh
};

struct RefineReport {
    std::vector<RefineRound> rounds; ///< the first is the shell before refinement
    std::size_t kept = 0;            ///< the round whose shell is the result
    RefineEnd end = RefineEnd::rounds;

    /// Fill gained in round `round` for each tet more than in the one before; 0 for round 0.
    double gain_per_tet(std::size_t round) const;
};

/// The predicted gain of cutting each triangle, by the given measure, 0 or more.
std::vector<double> refinement_gain(const PrismShell& shell, RefineBy by);

/// The triangles to cut, those of the largest predicted gain first: the fewest that have `share` of
/// the sum.
std::vector<std::uint32_t> triangles_to_cut(const std::vector<double>& gain, double share);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/growth/schedule.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/resample/coarsen.h"
#include "vdb_shell/shell/prism_test.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/step/directions.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace vdb_shell
{

/// How the inner vertices get their places.
enum class Method {
    raw,       ///< the lengths of line stepping as they are (the paper): overlaps are reported, not
               ///< prevented
    certified, ///< grown from a valid start, which passes GrowOptions::prism_test throughout
    thickest,  ///< thicker, for more time: grown on under the three-tet test until it is .998 full
};
const NameTable<Method>& names(Method);

/// Each lever is an option of its own; docs/measurements/thickness.md has its gain and cost.
struct GrowOptions {
    Method method = Method::certified;
    /// Which tets of a prism growth keeps positive, under Method::certified. With all twelve every
    /// diagonal and every thinner shell is valid too (docs/theory.md, "One prism: the twelve
    /// tets"), layers are cut without loss, and coordinates are one-to-one. The three chosen ones
    /// leave more room: sooner and fuller on large surfaces
    /// (docs/measurements/enough_fill.md), but those that come after may have to shorten pillars.
    PrismTest prism_test = PrismTest::twelve_tets;
    bool mend_directions = true;   ///< a direction that sees a triangle from behind, or nearly so,
                                   ///< gives way to the one that sees its worst triangle best
    bool smooth_directions = true; ///< bilateral smoothing of the directions, visibility kept
    bool top_down = true;          ///< start from long lines, made valid, instead of a thin shell
    bool grow_lines = true;    ///< lengthen along the lines: outward, and inward where the start
                               ///< is nearly full already (round and convex solids) or thin
    bool free_moves = true;    ///< let inner vertices leave their lines
    bool soft_contacts = true; ///< free moves keep clear of near triangles before they touch
    bool flips = true;         ///< choose diagonals again while moving, under the three-tet test,
                               ///< and for quality at the end; prolonged prisms that fail get
                               ///< others anyway
    /// From so many triangles on, growth begins on a surface of a thousand or two, and comes to the
    /// whole over some in between: sooner, and as thick. Fewer triangles than the default's have
    /// too little of their shape left then. 0: never.
    std::size_t coarse_from = 5000;
    /// Upper bound on rounds of free moves on the surface itself, under each prism test; coarser
    /// surfaces have their own. Unset: 40; but after a start on
    /// coarser surfaces (50,000 / triangles) squared under Method::certified, and they end sooner,
    /// when one wins little for what it costs, and ask only vertices that can win. Given, growth
    /// takes its time: thicker (docs/measurements/benchmarks.md).
    std::optional<int> free_rounds;
    /// Share of the solid. Growth ends once it has filled so much, and goes on for it as long as
    /// rounds win something; coarser surfaces are filled as far. Unset: .998 ends it, and after a
    /// start on coarser surfaces rounds go on for .9855 under Method::certified. Without meaning
    /// for a side that has no bound, which has no solid to fill.
    std::optional<double> enough_fill;
    /// Bound that the mean ratio of every tet should reach (shell/quality.h), 0 or more and less
    /// than 1; 0 asks for nothing. Inner vertices of tets below it are moved for better tets at the
    /// end, at a cost in thickness; those that cannot reach it are counted in the report.
    double min_quality = 0;
    /// Whether each vertex is asked at the end what holds it back: shell.stop, for the report. Some
    /// four microseconds a vertex (1,120,000 triangles of docs/measurements/size.md, two threads).
    /// Without, it is told for pinned vertices and those at their cap; all others have
    /// StopReason::not_asked.
    bool stop_reasons = true;
    /// Every other number that steers growth. None bears on validity.
    GrowthSchedule schedule;
};
OptionList describe(GrowOptions& options);

/// The test that a shell grown with these options passes: Method::thickest has the chosen tets.
PrismTest prism_test_of(const GrowOptions& options);

struct GrowReport {
    std::size_t rounds = 0;             ///< rounds of free moves
    std::size_t flips = 0;              ///< diagonals turned
    std::size_t released = 0;           ///< pins of the start that growth could release
    double fill_after_lines = 0;        ///< shell / |enclosed volume| before the first free move
    std::size_t quality_rounds = 0;     ///< rounds of moves towards GrowOptions::min_quality
    std::size_t tets_below_quality = 0; ///< tets that did not reach it
    std::size_t vertices_below_quality = 0; ///< inner vertices of such tets, pinned ones included
};

/// Surfaces for growth to begin on, each of fewer triangles than the one before, as
/// GrowOptions::coarse_from asks. Those of a large mesh stand in an order in which near vertices
/// are near in memory, so that the first one's `from` need not be ascending. None for a side
/// without bound, for a surface of few triangles or one that cannot be coarsened. Same result for
/// any number of threads. Throws Cancelled.
std::vector<Coarsened> coarse_levels(const TriangleMesh& mesh, const GrowOptions& options,
                                     Interrupter* interrupter = nullptr);

/// The vertices of the mesh from whose lines growth on such levels begins, ascending: those of the
/// last, or all.
std::vector<std::uint32_t> vertices_of_coarsest(const TriangleMesh& mesh,
                                                const std::vector<Coarsened>& levels);

/// What growth sets out from.
enum class GrowFrom {
    lines,  ///< the lines of the mesh itself
    levels, ///< GrowStart::levels, or the lines of the mesh where there are none
    shell,  ///< GrowStart::inner
};

struct GrowStart {
    GrowFrom from = GrowFrom::lines;
    /// GrowFrom::shell: the inner points of a shell to grow on from, as that of a coarser surface
    /// on the refined one: one per vertex, the vertex itself where it is pinned.
    std::vector<openvdb::Vec3s> inner;
    /// GrowFrom::levels: surfaces to begin on, of coarse_levels.
    std::vector<Coarsened> levels;
};

struct GrowResult {
    PrismShell shell;
    PrismSplit split;
    GrowReport report;
};

/// Grows the shell of an embedded surface to the thickest that the levers find, through valid
/// states only: every accepted move is tested exactly on the float32 coordinates, so no tet inverts
/// and no two surfaces touch, nor does one component end up inside another's shell (docs/theory.md,
/// "Growth"). Begins on coarse_levels of the mesh. A surface of up to 12,000 triangles
/// (MultilevelSchedule::most_coarsest_triangles) whose thickness nothing bounds, and that is less
/// than .99 full then (after coarser ones .9; enough_fill where that is less), is grown from other
/// starts too, and the fullest shell is taken that has no more pins. From that growth goes on anew
/// as long as it wins, until the shell is .99 full; after coarser surfaces .9855, with more than
/// 12,000 triangles .97, with 50,000 or more never.
/// `stepped` gives the first lengths to try (line stepping) where they exceed half the ray to the
/// other side; they bound nothing. `cap` bounds
/// |inner - outer| per vertex exactly (the user's thickness; infinite where there is none).
/// Vertices that no direction serves are pinned. shell.stop tells what holds each vertex back,
/// as far as GrowOptions::stop_reasons wants that.
/// `split` is honoured under the twelve-tet test, where any diagonals are valid; with `flips` and
/// SplitRule::length_descending they are then turned for quality. The three-tet test has its own.
/// Same bits for any number of threads. Terminates: rounds are bounded, and in a round each vertex
/// is tried a bounded number of times.
/// Precondition: closed, manifold mesh, oriented so that the side to fill lies behind its
/// triangles; one entry per vertex in all lists; cap not negative, and finite where that side has
/// no bound (a reversed surface: shell/sides.h); method not raw. On a surface that crosses itself
/// the result is some shell; only a certificate tells. Throws InvalidOption when free_rounds is
/// negative, enough_fill or min_quality out of range, Cancelled.
GrowResult grow_shell(const TriangleMesh& mesh, const Directions& directions,
                      const LineLengths& stepped, const std::vector<double>& cap,
                      const GrowOptions& options, const SplitOptions& split,
                      Interrupter* interrupter = nullptr);

/// The same from another start. From a shell growth goes on after moving, or else shortening, what
/// is not valid in it, and `stepped` is not read. With levels, `stepped` is of use at
/// vertices_of_coarsest alone and may be 0 elsewhere. Precondition: start.inner has one point per
/// vertex if it is a shell; start.levels are those of this mesh.
GrowResult grow_shell_from(const GrowStart& start, const TriangleMesh& mesh,
                           const Directions& directions, const LineLengths& stepped,
                           const std::vector<double>& cap, const GrowOptions& options,
                           const SplitOptions& split, Interrupter* interrupter = nullptr);

} // namespace vdb_shell

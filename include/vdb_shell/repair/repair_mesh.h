// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

struct RepairOptions {
    /// Points nearer than this to an earlier one become that one, world units. 0: points of equal
    /// position only.
    double weld_tolerance = 0;
    /// Triangles whose smallest height is below this are collapsed or turned away, world units.
    /// 0: triangles of exactly zero area only.
    double sliver_height = 0;
    /// Drop loose pieces, such as single triangles: open ones of less than a hundredth of the area
    /// each, and a quarter together, that no fill closes; and try the other holes again.
    bool drop_loose = false;
    /// Cut out triangles that cross or touch others when all else is done, and close the holes that
    /// leaves; more around them where a fill does not succeed.
    bool cut_crossings = false;
    /// Close a hole even where every fill that was tried crosses the surface.
    bool keep_crossing_fills = false;
};
OptionList describe(RepairOptions& options);

/// How a hole was closed, from the fairest to the plainest; each is tried only when those before it
/// cross the surface.
enum class FillMethod : std::uint8_t {
    smooth,   ///< refined, then continuing the slopes of the rim (least squared Laplacians)
    membrane, ///< refined, then each new point the mean of its neighbours
    dihedral, ///< no new points; the flattest edges (Liepa 2003, "Filling holes in meshes")
    area,     ///< no new points; the least area (Barequet and Sharir 1995), or ears cut from a rim
              ///< of more than 1000 edges
    none,     ///< left open
};
const char* name_of(FillMethod method);

inline constexpr std::uint32_t kNoSource = UINT32_MAX;

struct HoleFill {
    std::uint32_t first_point = 0; ///< of the rim, in the repaired mesh; kNoSource: cut out
    std::size_t edges = 0;         ///< of the rim
    double length = 0;             ///< of the rim, world units
    FillMethod method = FillMethod::none;
    std::size_t new_points = 0, new_triangles = 0;
    /// Pairs of a new triangle and another one that cross or touch; of the best fill tried when
    /// the hole was left open. Counted up to kMostCounted, and of thousands of holes to fewer: a
    /// thousand holes in a crowd would take the square of that otherwise.
    std::size_t crossings = 0;
    bool crossings_at_least = false; ///< it was not counted further
    static constexpr std::size_t kMostCounted = 1000;
};

/// Every change, counted. Indices are those of the input unless said otherwise.
struct RepairReport {
    Defect<std::uint32_t> welded_points; ///< became an earlier point
    Defect<std::uint32_t> collapsed;     ///< triangles that welding left with fewer than 3 points
    Defect<std::uint32_t> degenerate;    ///< triangles of zero area, dropped
    Defect<std::uint32_t> slivers;       ///< triangles below the sliver height, dropped
    Defect<std::uint32_t> recut;         ///< neighbours of those, cut in two or shifted to a corner
    Defect<std::uint32_t> duplicates;    ///< dropped repeats; both where the two cancel
    Defect<std::uint32_t> sheets;        ///< triangles of sheets that hang on the surface, dropped
    Defect<std::uint32_t> turned;        ///< triangles reversed
    Defect<std::uint32_t> split_points;  ///< points that got copies
    std::size_t copies = 0;              ///< how many
    std::size_t split_edges = 0;         ///< edges of three or more triangles parted
    std::size_t moved_points = 0;        ///< copies (and originals) moved apart
    double largest_move = 0;             ///< world units
    Defect<std::uint32_t> loose;         ///< triangles of loose pieces (RepairOptions::drop_loose)
    bool loose_dropped = false;          ///< whether they are gone
    Defect<std::uint32_t> cut;      ///< triangles cut out because they or others near them cross
    std::vector<HoleFill> holes;    ///< in the order of the attempts; after cuts, some come twice
    std::size_t kept_triangles = 0; ///< input triangles in the result with their coordinates bit
                                    ///< for bit, turned ones included
    MeshCheck after;

    bool changed() const;
};

struct RepairResult {
    TriangleMesh mesh;
    /// By triangle of `mesh`: the input's triangle that it is, or kNoSource for one that was made
    /// or changed.
    std::vector<std::uint32_t> source_triangle;
    RepairReport report;
};
/// Makes a closed, oriented, manifold surface of what is nearly one, and keeps the rest bit for bit
/// (docs/stages/repair.md): welds; drops triangles without area, repeats and sheets that bound no
/// solid; orients consistently; parts fans and sheets that meet in a point or an edge; closes
/// holes; turns components outward by their nesting. Holes of one-sided pieces stay open. What it
/// cannot mend is in `report.after`; self-intersections of the input are only touched when asked
/// (cut_crossings), and so are pieces that cannot be closed (drop_loose). Precondition as
/// check_mesh, else InvalidOption; also for a tolerance that is negative or not finite. Same bytes
/// for any number of threads.
RepairResult repair_mesh(const TriangleMesh& mesh, const RepairOptions& options = {},
                         Interrupter* interrupter = nullptr);

/// The report for a person, one line a kind of change; and as a JSON object, two-space indent.
std::string repair_text(const RepairReport& report);
std::string repair_json(const RepairReport& report);

} // namespace vdb_shell

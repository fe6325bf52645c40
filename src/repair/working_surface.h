// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "mesh/topology.h"
#include "vdb_shell/repair/repair_mesh.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::repair
{

/// What the steps of the repair pass on.
struct WorkingSurface {
    TriangleMesh mesh;
    std::vector<std::uint32_t> source; ///< by triangle: of the input, or kNoSource
    /// Points that stand in one place since they were parted; each list starts with the one that
    /// stays there if it can.
    std::vector<std::vector<std::uint32_t>> copies;
};

/// Drops the marked triangles.
void drop_triangles(WorkingSurface& surface, const std::vector<char>& drop);
/// Reports the marked triangles by their numbers in the input. Fills and others that a step has
/// made have none, so they are not reported.
void add_sources(Defect<std::uint32_t>& defect, const WorkingSurface& surface,
                 const std::vector<char>& marked);
/// Marks the triangles at open rims. Precondition: uses sorted by edge.
void mark_rims(const EdgeUses& uses, std::vector<char>& marked);

// The steps, in order. Each adds what it did to the report.

void weld_points(WorkingSurface& surface, double tolerance, RepairReport& report);
void drop_degenerate(WorkingSurface& surface, double sliver_height, RepairReport& report);
void drop_duplicates(WorkingSurface& surface, RepairReport& report);
/// Sheets: pieces without which every edge of their rim has fewer faults; see
/// docs/stages/repair.md.
void drop_sheets(WorkingSurface& surface, const StageProgress& progress, RepairReport& report);
void orient(WorkingSurface& surface, RepairReport& report);
/// Gives every fan of triangles its own point and every pair of triangles its own edge. Open fans
/// share their point where the holes between them can be walked round.
void part_fans(WorkingSurface& surface, RepairReport& report);
void fill_holes(WorkingSurface& surface, const RepairOptions& options, RepairReport& report,
                Interrupter* interrupter);
/// Marks the triangles of open pieces of less than a hundredth of the area. A closed piece bounds a
/// solid however small it is.
std::vector<char> loose_triangles(const TriangleMesh& mesh);
/// After fill_holes: counts the triangles of loose pieces, and drops them if that is wanted. True
/// if any was dropped; then the holes that were left open are no longer in the report.
bool drop_loose_pieces(WorkingSurface& surface, bool wanted, RepairReport& report);
/// Triangles that cross or touch another one, or have no area.
std::vector<char> crossing_triangles(const TriangleMesh& mesh, Interrupter* interrupter);
/// Drops crossing triangles, from round 1 on also those at open rims, from round 2 on with growing
/// rings of neighbours; and the small pieces that this cuts off. False when there is nothing to
/// cut.
bool cut_crossings(WorkingSurface& surface, int round, RepairReport& report,
                   Interrupter* interrupter);
/// Moves points that were parted out of each other's way.
void move_copies_apart(WorkingSurface& surface, RepairReport& report, Interrupter* interrupter);

} // namespace vdb_shell::repair

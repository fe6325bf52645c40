// SPDX-License-Identifier: Apache-2.0

// Takes any triangles with finite points and leaves a closed, oriented manifold where it can, and
// every triangle that needed no change bit for bit. The order is the idea: equal points first,
// since all that follows goes by indices; then triangles that are faulty by themselves, repeats and
// sheets, whose edges of three and more triangles keep neighbours apart; then orientation, which
// fans and rims need; then fans, then holes, whose fills need fans; at last nesting and contacts,
// which mean something on closed surfaces only. It proves nothing: the result is checked anew, and
// the check is in the report.

#include "vdb_shell/repair/repair_mesh.h"

#include "core/stage_progress.h"
#include "mesh/components.h"
#include "mesh/surface_defects.h"
#include "repair/working_surface.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include <cmath>
#include <numeric>
#include <utility>

namespace vdb_shell
{
namespace
{

/// Turns closed components that are oriented against their nesting.
void turn_by_nesting(repair::WorkingSurface& surface, RepairReport& report,
                     Interrupter* interrupter)
{
    const MeshCheck check = check_mesh(surface.mesh, interrupter);
    if (check.inside_out_components() == 0)
        return;
    const std::vector<std::uint32_t> component_of = component_of_triangles(
        sorted_edge_uses(surface.mesh.triangles), surface.mesh.triangles.size());
    surface.mesh = turn_outward(std::move(surface.mesh), check);
    for (std::size_t t = 0; t < component_of.size(); ++t)
        if (check.components[component_of[t]].inside_out && surface.source[t] != kNoSource)
            add_to(report.turned, surface.source[t]);
}

/// From triangles that are sound each for itself to a closed surface.
void close_up(repair::WorkingSurface& surface, const RepairOptions& options, RepairReport& report,
              Interrupter* interrupter)
{
    // Copies of an earlier round have been moved, or put back because no move helped: they are not
    // moved again.
    surface.copies.clear();
    const StageProgress progress(interrupter, "mending");
    repair::drop_sheets(surface, progress, report);
    repair::orient(surface, report);
    progress.stop_if_interrupted(20);
    repair::part_fans(surface, report);
    progress.stop_if_interrupted(30);
    repair::fill_holes(surface, options, report, interrupter);
    if (repair::drop_loose_pieces(surface, options.drop_loose, report))
        repair::fill_holes(surface, options, report, interrupter);
    turn_by_nesting(surface, report, interrupter);
    repair::move_copies_apart(surface, report, interrupter);
    // Components that touched have been moved apart, so their nesting may come out otherwise now.
    turn_by_nesting(surface, report, interrupter);
}

/// Leaves out points that no triangle uses, so that every point has a pillar to stand on.
void drop_unused_points(TriangleMesh& mesh, RepairReport& report)
{
    std::vector<std::uint32_t> new_index(mesh.points.size(), kNoSource);
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            new_index[t[corner]] = 0;
    // Marks become new indices. A rim whose first point a later cut has removed keeps kNoSource
    // here, by which the report says that it was cut out.
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < new_index.size(); ++v) {
        if (new_index[v] == kNoSource)
            continue;
        mesh.points[kept] = mesh.points[v];
        new_index[v] = kept++;
    }
    mesh.points.resize(kept);
    for (openvdb::Vec3I& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            t[corner] = new_index[t[corner]];
    for (HoleFill& hole : report.holes)
        if (hole.first_point != kNoSource)
            hole.first_point = new_index[hole.first_point];
}

} // namespace

const char* name_of(FillMethod method)
{
    switch (method) {
    case FillMethod::smooth:
        return "smooth";
    case FillMethod::membrane:
        return "membrane";
    case FillMethod::dihedral:
        return "dihedral";
    case FillMethod::area:
        return "area";
    case FillMethod::none:
        break;
    }
    return "none";
}

OptionList describe(RepairOptions& o)
{
    return in_group(
        "Surface",
        {option("weld_tolerance", o.weld_tolerance, "--weld-tolerance",
                "Repair: merge points nearer than this, world units; 0 is equal ones only")
             .in(Unit::world_length)
             .within(at_least(0)),
         option("sliver_height", o.sliver_height, "--sliver-height",
                "Repair: remove triangles lower than this, world units; 0 is those of no area")
             .in(Unit::world_length)
             .within(at_least(0)),
         option("drop_loose", o.drop_loose, "--drop-loose",
                "Repair: drop small open pieces that no fill closes, as single triangles"),
         option("cut_crossings", o.cut_crossings, "--cut-crossings",
                "Repair: cut out triangles that cross others, and close the holes"),
         option("keep_crossing_fills", o.keep_crossing_fills, "--keep-crossing-fills",
                "Close holes also where every fill tried crosses the surface")});
}

RepairResult repair_mesh(const TriangleMesh& mesh, const RepairOptions& options,
                         Interrupter* interrupter)
{
    require_in_range(options, "repair");
    require_well_formed(mesh, "repair_mesh");
    // The steps below frame themselves where they are long; what is between them asks all the same.
    LatchedInterrupter asked_by_loops(interrupter);
    const StageStopScope scope(interrupter ? &asked_by_loops : stage_stop());
    stop_if_stage_wants();
    RepairReport report;
    repair::WorkingSurface surface{mesh, std::vector<std::uint32_t>(mesh.triangles.size()), {}};
    std::iota(surface.source.begin(), surface.source.end(), 0U);
    repair::weld_points(surface, options.weld_tolerance, report);
    repair::drop_degenerate(surface, options.sliver_height, report);
    repair::drop_duplicates(surface, report);
    close_up(surface, options, report, interrupter);
    // Each round cuts a triangle at least, but the fills add others that may cross in their turn,
    // so that only this bound is sure to end the loop.
    constexpr int kMostCuts = 6;
    for (int round = 0; round < kMostCuts && options.cut_crossings; ++round) {
        if (!repair::cut_crossings(surface, round, report, interrupter))
            break;
        close_up(surface, options, report, interrupter);
    }
    drop_unused_points(surface.mesh, report);
    for (const std::uint32_t source : surface.source)
        report.kept_triangles += source != kNoSource;
    report.after = check_mesh(surface.mesh, interrupter);
    return {std::move(surface.mesh), std::move(surface.source), std::move(report)};
}

bool RepairReport::changed() const
{
    return welded_points.count + collapsed.count + degenerate.count + slivers.count + recut.count +
               duplicates.count + sheets.count + turned.count + cut.count +
               (loose_dropped ? loose.count : 0) + copies + holes.size() >
           0;
}

} // namespace vdb_shell

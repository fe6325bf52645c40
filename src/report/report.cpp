// SPDX-License-Identifier: Apache-2.0

// Takes: the figures of one run, after its end. Gives: the report as JSON text
// (docs/file_format.md). Nothing is measured here, and only angles change their unit, so a figure
// is the same for programs, for people and for who uses the library. Keys stand in the order in
// which they are written below: the same run gives the same bytes, but for seconds and memory,
// which can be left out. Keys of the top level do not come and go with the options, `stages` aside:
// what does not apply is null, or an empty list. The report is stored in files and compared with
// their contents when these are checked (write/verify_file.cpp), so a renamed key would break older
// files. Trap: a number that is not finite becomes null.

#include "vdb_shell/report/report.h"

#include "core/degrees.h"
#include "mesh/components_json.h"
#include "mesh/defect_json.h"
#include "mesh/mesh_check_json.h"
#include "mesh/placement_json.h"
#include "report/checks_report.h"
#include "report/cores_report.h"
#include "report/pose_report.h"
#include "report/resample_report.h"
#include "report/shape_report.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{
namespace
{

using nlohmann::ordered_json;

ordered_json read_json(const ReadReport& read)
{
    return {{"format", read.format},
            {"file_vertices", read.file_vertices},
            {"file_faces", read.file_faces},
            {"polygons_triangulated", read.polygons_triangulated},
            {"welded_vertices", read.welded_vertices},
            {"unused_vertices", read.unused_vertices},
            {"skipped_faces", read.skipped_faces},
            // Without it nobody could find a place of the report in a file that was moved on
            // reading.
            {"placement", placement_json(read.placement)},
            {"largest_rounding", read.largest_rounding}};
}

/// The surface that a level set or a wrap gave, before anything was resampled.
ordered_json contour_json(const ContourReport& contour)
{
    return {{"method", name_in_table(contour.method)},
            // Not 0 only where that surface was given up for the other method.
            {"volume_to_mesh_defects", contour.volume_to_mesh_defects},
            {"triangles", contour.triangles},
            {"simplified_triangles", contour.simplified_triangles},
            {"simplification_repeats", contour.simplification_repeats},
            {"components", contour.components},
            {"dropped_components", contour.dropped_components}};
}

ordered_json wrap_json(const WrapReport& wrap)
{
    return {{"voxel_size", wrap.voxel_size},
            {"voxels", wrap.voxels},
            {"filled_voxels", wrap.filled_voxels},
            {"boundary_share", wrap.boundary_share},
            {"sheet_share", wrap.sheet_share},
            {"interior_share", wrap.interior_share},
            {"contour", contour_json(wrap.contour)},
            // Both ways, because neither bounds the other: a part of the input that the wrap has
            // lost shows in the first only, a part that it has made up in the second.
            {"input_to_wrap", distance_json(wrap.input_to_wrap)},
            {"wrap_to_input", distance_json(wrap.wrap_to_input)}};
}

ordered_json mesh_json(const ShellReport& report)
{
    ordered_json json = mesh_check_json(report.mesh);
    json["components"] = components_json(report.mesh.components);
    json["split_vertices"] = defect_json(report.split_vertices);
    json["vertex_copies"] = report.vertex_copies;
    return json;
}

/// Lengths in world units; `interior_depth` is the depth of the deepest voxel.
ordered_json field_json(const FieldReport& field)
{
    return {{"origin", field.origin},
            {"sparse", field.sparse},
            {"voxel_size", field.voxel_size},
            {"active_voxels", field.active_voxels},
            {"memory_bytes", field.memory_bytes},
            {"interior_depth", field.interior_depth},
            {"smooth",
             {{"mean_drift", field.smooth.mean_drift}, {"max_drift", field.smooth.max_drift}}}};
}

ordered_json lines_json(const LineReport& lines)
{
    // Every reason has a key, also where it ended no line, so that tables over many meshes have the
    // same columns.
    ordered_json stops;
    for (int reason = 0; reason < kStopReasonCount; ++reason)
        stops[name_of(StopReason(reason))] = lines.stops[std::size_t(reason)];
    return {{"min_visibility", lines.min_visibility},
            {"blind_vertices", lines.blind_vertices},
            {"stuck_vertices", lines.stuck_vertices},
            // Fewer than there are vertices where growth begins on a coarser surface.
            {"stepped", lines.lines},
            {"steps", lines.steps},
            {"stop_reasons", stops},
            {"length", spread_json(lines.length)},
            {"length_voxels", spread_json(lines.length_voxels)}};
}

ordered_json growth_json(const GrowReport& grow)
{
    return {{"rounds", grow.rounds},
            {"flips", grow.flips},
            {"released_pins", grow.released},
            // On this surface: after a start on coarser ones most of the fill has been won there,
            // by free moves too.
            {"fill_after_lines", grow.fill_after_lines},
            {"quality_rounds", grow.quality_rounds},
            {"tets_below_quality", grow.tets_below_quality},
            {"vertices_below_quality", grow.vertices_below_quality}};
}

/// A tet that is not positive is either inverted or flat (docs/conventions.md), by exact signs.
ordered_json tets_json(const ShellReport& report)
{
    return {{"tets", report.signs.tets},
            {"inverted", report.signs.inverted.count},
            {"first_inverted", report.signs.inverted.first},
            {"flat", report.signs.flat.count},
            {"first_flat", report.signs.flat.first}};
}

ordered_json layers_json(const ShellReport& report)
{
    // An array from the beginning: a shell of one layer has an empty list here, not null.
    ordered_json layers = ordered_json::array();
    for (const LayerFigures& layer : report.layers)
        layers.push_back({{"tets", layer.tets},
                          {"pinned_vertices", layer.pinned_vertices},
                          {"volume", layer.volume},
                          {"length", spread_json(layer.length)},
                          {"quality", quality_json(layer.quality)}});
    return layers;
}

/// What gave way where layers were cut: points that were moved to keep tets positive, and pillars
/// that could not be cut (docs/theory.md, "Layers, and shells scaled down").
ordered_json cut_json(const LayerReport& cut)
{
    return {{"moved_points", cut.moved}, {"uncut_pillars", cut.uncut}, {"empty_layers", cut.empty}};
}

/// Of the core alone: other figures of the report are those of the shell.
ordered_json core_fill_json(const CoreFillReport& fill)
{
    return {{"program", name_in_table(fill.program)},
            {"void_triangles", fill.void_triangles},
            {"points", fill.points},
            {"moved_points", fill.moved_points},
            {"tets", fill.tets},
            {"volume", fill.volume},
            {"min_dihedral_degrees", degrees(fill.min_dihedral_radians)}};
}

ordered_json taper_json(const TaperReport& taper)
{
    return {{"runs", taper.runs},
            {"rounds", taper.rounds},
            {"merges", taper.merges},
            {"moves", taper.moves},
            {"handed_over", taper.handed_over},
            {"turned_diagonals", taper.turned},
            {"inner_points", taper.inner_points},
            {"prisms_by_tets", taper.prisms_by_tets},
            {"undone", taper.undone}};
}

ordered_json scale_json(const ScaleReport& scale)
{
    return {{"shortened_pillars", scale.shortened}, {"pinned_pillars", scale.pinned}};
}

/// Round 0 is the shell before refinement. The last round need not be the one that was kept, since
/// a round may lose fill.
ordered_json refine_json(const RefineReport& refine)
{
    ordered_json rounds = ordered_json::array();
    for (std::size_t k = 0; k < refine.rounds.size(); ++k) {
        const RefineRound& round = refine.rounds[k];
        rounds.push_back({{"triangles", round.triangles},
                          {"tets", round.tets},
                          {"fill", round.fill},
                          {"gain_per_tet", refine.gain_per_tet(k)},
                          {"triangles_cut", round.cut},
                          {"barred_edges", round.barred_edges}});
    }
    return {{"rounds", rounds}, {"kept", refine.kept}, {"end", name_of(refine.end)}};
}

/// A shell on both sides has lines, growth and scaling twice. Those inward stand at the top level,
/// where they also stand for a shell on one side, so that scripts find them in one place.
ordered_json outside_json(const OutsideReport& outside)
{
    return {{"lines", lines_json(outside.lines)},
            {"growth", outside.grow ? growth_json(*outside.grow) : ordered_json()},
            {"scale", outside.scale ? scale_json(*outside.scale) : ordered_json()}};
}

ordered_json mend_json(const std::vector<MendAttempt>& attempts)
{
    ordered_json json = ordered_json::array();
    for (const MendAttempt& attempt : attempts)
        json.push_back({{"tried", name_in_table(attempt.tried)},
                        {"refusal", attempt.refusal.empty() ? ordered_json()
                                                            : ordered_json(attempt.refusal)}});
    return json;
}

/// In the order in which stages ran. Memory is the most that the process had held by the end of
/// each.
ordered_json costs_json(const std::vector<StageCost>& stages)
{
    ordered_json costs = ordered_json::array();
    for (const StageCost& cost : stages)
        costs.push_back({{"stage", cost.stage},
                         {"seconds", cost.seconds},
                         {"peak_memory_bytes", cost.peak_memory_bytes}});
    return costs;
}

/// Of the whole report: raised when a key comes, goes or changes its meaning
/// (docs/schema/report.schema.json).
constexpr int kSchema = 6;

/// What was read and what became of it before lines were stepped.
void add_surface(ordered_json& json, const ShellReport& report)
{
    json["schema"] = kSchema;
    json["source"] = report.source;
    json["read"] = report.read ? read_json(*report.read) : ordered_json();
    json["mend"] = report.mend.empty() ? ordered_json() : mend_json(report.mend);
    // The repair report has a JSON form of its own, for a repair without a shell. Its text is
    // parsed here instead of being built a second time, so the two cannot differ.
    json["repair"] =
        report.repair ? ordered_json::parse(repair_json(*report.repair)) : ordered_json();
    json["wrap"] = report.wrap ? wrap_json(*report.wrap) : ordered_json();
    json["contour"] = report.contour ? contour_json(*report.contour) : ordered_json();
    json["mesh"] = mesh_json(report);
    json["retriangulate"] =
        report.retriangulate ? retriangulate_json(*report.retriangulate) : ordered_json();
    json["decimate"] = report.decimate ? decimate_json(*report.decimate) : ordered_json();
    json["remesh"] = report.remesh ? remesh_json(*report.remesh) : ordered_json();
    // The number of triangles before; null says that nothing was subdivided, as 0 would look like a
    // count.
    json["subdivided_from"] =
        report.subdivided_from > 0 ? ordered_json(report.subdivided_from) : ordered_json();
}

/// How the shell came about, and what it consists of.
void add_shell(ordered_json& json, const ShellReport& report)
{
    json["field"] = field_json(report.field);
    json["side"] = name_in_table(report.side);
    json["lines"] = lines_json(report.lines);
    json["growth"] = report.grow ? growth_json(*report.grow) : ordered_json();
    json["scale"] = report.scale ? scale_json(*report.scale) : ordered_json();
    json["refine"] = report.refine ? refine_json(*report.refine) : ordered_json();
    json["outside"] = report.outside ? outside_json(*report.outside) : ordered_json();
    json["cut"] = report.cut ? cut_json(*report.cut) : ordered_json();
    json["taper"] = report.taper ? taper_json(*report.taper) : ordered_json();
    json["cores"] = report.cores ? cores_json(*report.cores) : ordered_json();
    json["pose"] = report.pose ? pose_json(*report.pose) : ordered_json();
    json["core_fill"] = report.core_fill ? core_fill_json(*report.core_fill) : ordered_json();
    json["layers"] = layers_json(report);
    json["prisms"] = {{"prisms", report.prisms},
                      {"pinned_vertices", report.pinned_vertices},
                      {"demanded_pins", defect_json(report.demanded_pins)},
                      {"triangles_without_tet", defect_json(report.triangles_without_tet)},
                      {"without_tet_demanded", report.without_tet_demanded},
                      {"ripples", report.ripples}};
    json["tets"] = tets_json(report);
}

} // namespace

const NameTable<Mending>& names(Mending)
{
    static const NameTable<Mending> table{{"as-it-is", Mending::none},
                                          {"repair", Mending::repair},
                                          {"drop-loose", Mending::drop_loose},
                                          {"cut-crossings", Mending::cut_crossings},
                                          {"wrap", Mending::wrap}};
    return table;
}

std::string report_json(const ShellReport& report, bool with_costs)
{
    ordered_json json;
    add_surface(json, report);
    add_shell(json, report);
    add_checks(json, report);
    // The only part that differs from run to run; a file that holds the report has to have the same
    // bytes each time.
    if (with_costs)
        json["stages"] = costs_json(report.stages);
    // A file name may hold bytes that are no UTF-8. They are replaced, since JSON cannot hold them
    // and a report must not fail for the name of its input.
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

} // namespace vdb_shell

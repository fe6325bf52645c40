// SPDX-License-Identifier: Apache-2.0

// Takes: the reports of retriangulation, decimation, remeshing and refinement. Gives: their part of
// the report, as JSON and in lines for a person. Angles in degrees, as everywhere in reports.

#include "report/resample_report.h"

#include "core/degrees.h"
#include "report/text_lines.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{

using nlohmann::ordered_json;

namespace
{

/// Of the triangles of one surface.
ordered_json figures_json(const TriangleFigures& figures)
{
    return {{"min_angle_degrees", degrees(figures.min_angle_radians)},
            {"mean_min_angle_degrees", degrees(figures.mean_min_angle_radians)},
            {"triangles_under_20_degrees", figures.under_20_degrees},
            {"triangles_under_30_degrees", figures.under_30_degrees},
            {"edge_length",
             {{"min", figures.shortest_edge},
              {"mean", figures.mean_edge},
              {"max", figures.longest_edge}}}};
}

std::string angles_text(const TriangleFigures& figures)
{
    return number(degrees(figures.min_angle_radians), 3) + " degrees, mean of the triangles' " +
           number(degrees(figures.mean_min_angle_radians), 3) + ", " +
           number(figures.under_30_degrees, 12) + " under 30";
}

/// Both ways, as neither bounds the other: what was cut off shows in the first only, what was made
/// up in the second.
std::string farthest_text(const DistanceFigures& there, const DistanceFigures& back)
{
    return "farthest input to result " + number(there.max) + ", result to input " +
           number(back.max);
}

/// What remeshing and retriangulation say alike.
void angles_line(std::ostringstream& out, const TriangleFigures& before,
                 const TriangleFigures& after)
{
    line(out, "  angles",
         "smallest " + angles_text(after) + " (before " + angles_text(before) + ")");
}

} // namespace

/// Distances are sampled, so their number says how far mean and maximum can be trusted.
ordered_json distance_json(const DistanceFigures& distance)
{
    return {{"mean", distance.mean}, {"max", distance.max}, {"samples", distance.samples}};
}

ordered_json retriangulate_json(const RetriangulateReport& retriangulate)
{
    return {{"flat_triangles", retriangulate.flat_triangles},
            {"flat_parts", retriangulate.flat_parts},
            {"flips", retriangulate.flips},
            {"kept_parts", retriangulate.kept_parts},
            {"tolerance", retriangulate.tolerance},
            {"farthest", retriangulate.farthest},
            {"before", figures_json(retriangulate.shape_before)},
            {"after", figures_json(retriangulate.shape)}};
}

ordered_json decimate_json(const DecimateReport& decimate)
{
    return {{"triangles_before", decimate.before},
            {"triangles_wanted", decimate.wanted},
            {"triangles", decimate.triangles},
            // Collapses may end before: the tolerance goes before the number of triangles.
            {"reached", decimate.reached()},
            {"input_to_result", distance_json(decimate.input_to_result)},
            {"result_to_input", distance_json(decimate.result_to_input)},
            {"repeats", decimate.repeats}};
}

ordered_json remesh_json(const RemeshReport& remesh)
{
    return {{"triangles_before", remesh.before},
            {"triangles_wanted", remesh.wanted ? ordered_json(*remesh.wanted) : ordered_json()},
            {"triangles", remesh.triangles},
            {"edge_length", remesh.edge_length},
            {"tolerance", remesh.tolerance},
            {"features",
             {{"edges", remesh.feature_edges},
              {"curves", remesh.feature_curves},
              {"corners", remesh.corners}}},
            {"before", figures_json(remesh.shape_before)},
            {"after", figures_json(remesh.shape)},
            {"edges_in_range", remesh.edges_in_range},
            {"input_to_result", distance_json(remesh.input_to_result)},
            {"result_to_input", distance_json(remesh.result_to_input)},
            {"repeats", remesh.repeats},
            {"kept_input", remesh.kept_input}};
}

void retriangulate_lines(std::ostringstream& out, const RetriangulateReport& retriangulate)
{
    std::string text = number(retriangulate.flips, 12) + " edges turned inside " +
                       number(retriangulate.flat_parts, 12) + " of them, of " +
                       number(retriangulate.flat_triangles, 12) + " triangles; surfaces at most " +
                       number(retriangulate.farthest) + " apart, tolerance " +
                       number(retriangulate.tolerance);
    // Said only where it happened.
    if (retriangulate.kept_parts > 0)
        text += "; " + number(retriangulate.kept_parts, 12) +
                " left as they were, for they would have touched others";
    line(out, "flat parts", text);
    angles_line(out, retriangulate.shape_before, retriangulate.shape);
}

void decimate_line(std::ostringstream& out, const DecimateReport& decimate)
{
    std::string text =
        number(decimate.before, 12) + " triangles to " + number(decimate.triangles, 12);
    // The tolerance comes before the number, so fewer collapses than were wanted are no error, but
    // the user has to know.
    if (!decimate.reached())
        text += " (wanted " + number(decimate.wanted, 12) + ": no more can be had)";
    line(out, "decimate",
         text + "; " + farthest_text(decimate.input_to_result, decimate.result_to_input));
}

void remesh_lines(std::ostringstream& out, const RemeshReport& remesh)
{
    std::string text = number(remesh.before, 12) + " triangles to " + number(remesh.triangles, 12);
    // Capitals, for the user asked for other triangles and did not get them.
    if (remesh.kept_input)
        text += ": THE INPUT ITSELF, no other was within the tolerance";
    line(out, "remesh",
         text + "; " + farthest_text(remesh.input_to_result, remesh.result_to_input) +
             ", tolerance " + number(remesh.tolerance));
    line(out, "  edges",
         "wanted " + number(remesh.edge_length) + ", mean " + number(remesh.shape.mean_edge) +
             ", " + percent(remesh.edges_in_range) + " from 4/5 to 4/3 of it; " +
             number(remesh.feature_edges, 12) + " feature edges, " + number(remesh.corners, 12) +
             " corners kept");
    angles_line(out, remesh.shape_before, remesh.shape);
}

void refine_lines(std::ostringstream& out, const RefineReport& refine)
{
    line(out, "refine",
         // Round 0 is the shell before refinement: it is in the list and is no round of it.
         number(refine.rounds.size() - 1, 12) + " rounds, kept " + number(refine.kept, 12) +
             ", ended by " + name_of(refine.end));
    for (std::size_t k = 0; k < refine.rounds.size(); ++k) {
        const RefineRound& round = refine.rounds[k];
        std::string text = number(round.triangles, 12) + " triangles, " + number(round.tets, 12) +
                           " tets, fill " + percent(round.fill);
        // Round 0 has added no tets to divide by.
        if (k > 0)
            text += ", gained per added tet " + number(refine.gain_per_tet(k), 3);
        line(out, ("  round " + number(k, 12)).c_str(), text);
    }
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes: the figures of one run. Gives: the same for a person, one line a stage, about in the order
// in which the stages ran; the last line says whether the shell can be trusted. Lines of stages
// that did not run are left out, where the JSON has null. Figures are rounded to what can be read
// at a glance; whoever needs all digits takes the JSON (report.cpp). Capitals mark what is wrong
// with a mesh or a shell.

#include "vdb_shell/report/report.h"

#include "core/degrees.h"
#include "core/text_stream.h"
#include "report/cores_report.h"
#include "report/pose_report.h"
#include "report/resample_report.h"
#include "report/shape_report.h"
#include "report/surface_text.h"
#include "report/text_lines.h"

#include <algorithm>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

namespace vdb_shell
{
namespace
{

/// Only reasons that ended a line: most surfaces have two or three of them.
std::string stop_text(const LineReport& lines)
{
    std::string text;
    for (int reason = 0; reason < kStopReasonCount; ++reason)
        if (const std::size_t count = lines.stops[std::size_t(reason)])
            text += (text.empty() ? "" : ", ") + std::string(name_of(StopReason(reason))) + " " +
                    number(count, 12);
    return text.empty() ? "none stepped" : text;
}

/// Fill is a share of the solid, so a shell that lies outside only has none: what is outside has no
/// bound to be a share of, and is put in relation to the solid instead (docs/theory.md, "Outward
/// shells, and shells on both sides").
std::string volume_shares(const ShellReport& report)
{
    std::string text;
    if (report.side != Side::outward)
        text += ", fill " + percent(report.fill);
    if (report.side != Side::inward)
        text += ", outside " + number(report.outside_volume, 6) + " (" +
                percent(report.outside_volume / report.solid_volume) + " of the solid's)";
    return text;
}

std::string coverage_text(const Coverage& coverage, Side side)
{
    // Without samples all shares are nought, which would read like an empty shell.
    if (coverage.samples == 0)
        return "not estimated";
    return percent(coverage.covered_share) +
           (side == Side::inward ? " of the solid (+- " : " of what the outer surface holds (+- ") +
           percent(coverage.standard_error) + "), more than once " +
           percent(coverage.overlap_share) + "; " + number(coverage.samples, 12) +
           " points: " + number(coverage.in_none, 12) + " in no tet, " +
           number(coverage.in_several, 12) + " in two or more";
}

/// Says what was proven, not just that it was: with the chosen tets alone nothing is said about
/// other diagonals or thinner shells (docs/theory.md, "One prism: the twelve tets").
std::string certificate_text(const StackCertificate& certificate)
{
    const std::vector<Certificate>& layers = certificate.layers;
    if (certificate.certified() && certificate.complex)
        return "yes (all tets positive, their free faces embedded, no place in two tets)";
    if (certificate.certified())
        return std::string("yes (") +
               (!layers.empty() && layers.front().test == PrismTest::chosen_tets
                    ? "the 3 chosen tets"
                    : "12 tets") +
               " of each prism positive, surfaces embedded and disjoint" +
               (layers.size() > 1 ? ", in all " + number(layers.size()) + " layers)" : ")");
    std::string text = certificate.locally_valid() ? "NO, only locally valid: " : "NO: ";
    const std::vector<std::string> failures = certificate.failures();
    for (std::size_t i = 0; i < failures.size(); ++i)
        text += (i ? ", " : "") + failures[i];
    return text;
}

void taper_line(std::ostringstream& out, const ShellReport& report)
{
    if (!report.taper)
        return;
    std::string text = number(report.taper->inner_points, 12) + " inner points; prisms of ";
    for (std::size_t tets = 1; tets <= 3; ++tets)
        text += std::to_string(tets) + (tets < 3 ? ", " : " tets: ");
    for (std::size_t tets = 1; tets <= 3; ++tets)
        text += number(report.taper->prisms_by_tets[tets], 12) + (tets < 3 ? ", " : "");
    // The shell is then the one before tapering, and the figures above are of what was given up.
    if (report.taper->undone)
        text += "; UNDONE, for it was not certified";
    line(out, "taper", text);
}

/// One line a layer, numbered as in the failures of the certificate.
void layer_lines(std::ostringstream& out, const ShellReport& report)
{
    taper_line(out, report);
    if (report.cut)
        line(out, "layers",
             number(report.layers.size(), 12) + "; " + number(report.cut->moved, 12) +
                 " points between them moved, " + number(report.cut->uncut, 12) +
                 " pillars left whole" +
                 (report.cut->empty == 0
                      ? std::string()
                      : "; " + number(report.cut->empty, 12) + " LAYERS ARE EMPTY"));
    for (std::size_t k = 0; k < report.layers.size(); ++k) {
        const LayerFigures& layer = report.layers[k];
        const std::string label = "  layer " + number(k);
        line(out, label.c_str(),
             number(layer.tets, 12) + " tets, volume " + number(layer.volume, 6) + ", lengths to " +
                 number(layer.length.max) + ", " + number(layer.pinned_vertices, 12) +
                 " pinned, mean ratio min " + number(layer.quality.mean_ratio.min) +
                 ", 1 % under " + number(layer.quality.mean_ratio.p1) + ", median " +
                 number(layer.quality.mean_ratio.median));
    }
}

/// Of one side. A shell on both sides has these lines twice, those outward under a line of their
/// own.
void line_figures(std::ostringstream& out, const LineReport& lines)
{
    line(out, "directions",
         "smallest visibility " + number(lines.min_visibility) + ", " +
             number(lines.blind_vertices, 12) + " blind vertices");
    line(out, "lines",
         number(lines.lines, 12) + " stepped, " + number(lines.steps, 12) + " steps, " +
             number(lines.stuck_vertices, 12) + " stuck vertices");
    line(out, "stops", stop_text(lines));
    line(out, "lengths", spread(lines.length));
    line(out, "  in voxels", spread(lines.length_voxels));
}

void growth_line(std::ostringstream& out, const GrowReport& grow)
{
    line(out, "growth",
         number(grow.rounds, 12) + " rounds, " + number(grow.flips, 12) + " diagonals turned, " +
             number(grow.released, 12) + " pins released");
}

/// What the user wanted and the stages after growth could not give: tets of the wanted quality, and
/// pillars as long as scaling alone would have left them.
void concession_lines(std::ostringstream& out, const std::optional<GrowReport>& grow,
                      const std::optional<ScaleReport>& scale)
{
    if (grow && grow->quality_rounds > 0)
        line(out, "min quality",
             number(grow->quality_rounds, 12) +
                 " rounds; still below: " + number(grow->tets_below_quality, 12) + " tets, " +
                 number(grow->vertices_below_quality, 12) + " inner vertices");
    if (scale)
        line(out, "scale",
             number(scale->shortened, 12) + " pillars shortened further, " +
                 number(scale->pinned, 12) + " of them pinned");
}

/// As many as the defect names, and a mark that there are more.
std::string first_of(const Defect<std::uint32_t>& elements)
{
    std::string text;
    for (const std::uint32_t index : elements.first)
        text += (text.empty() ? "" : ", ") + std::to_string(index);
    return text + (elements.first.size() < elements.count ? ", ..." : "");
}

std::string shown_share(const Overlaps& overlaps)
{
    return number(overlaps.certified_prisms(), 12) + " of " + number(overlaps.prisms, 12) +
           " prisms certified by themselves";
}

/// What was not looked at is not called right. Faults come first, even where there is a
/// certificate: signs, conformity and sample points are counted without it, and a contradiction
/// between the two has to show. Then the strongest statement that was proven, then what was merely
/// seen.
std::string verdict(const ShellReport& report)
{
    const std::string wrong = faults_of(report);
    if (!wrong.empty())
        return "NOT VALID: " + wrong +
               (report.overlaps ? "; " + shown_share(*report.overlaps) : std::string());
    if (report.certificate && report.certificate->certified())
        return "no tet inverted, none overlapping: proven";
    // Tet by tet it says no more than that interiors are disjoint; how the tets touch is for
    // conformity and for the certificate of the whole (docs/theory.md, "A surface that crosses
    // itself").
    if (report.overlaps && report.overlaps->none())
        return "no tet inverted, none overlapping: proven tet by tet; not certified as a whole";
    if (report.coverage.samples == 0)
        return "tets positive and conforming; overlaps not looked for, not certified";
    return "tets positive and conforming, no overlap seen among the sample points; not certified";
}

/// The stages follow one another, so their seconds add up; memory is a high-water mark of the
/// process, so the largest is that of the whole run, with whatever the process held before.
void cost_lines(std::ostringstream& out, const std::vector<StageCost>& stages)
{
    double total = 0.0;
    std::uint64_t peak = 0;
    std::string text;
    for (const StageCost& cost : stages) {
        total += cost.seconds;
        peak = std::max(peak, cost.peak_memory_bytes);
        text += (text.empty() ? "" : ", ") + cost.stage + " " + number(cost.seconds, 3);
    }
    line(out, "seconds", number(total, 3) + " (" + text + ")");
    line(out, "memory", number(double(peak) / (1 << 20), 4) + " MiB at most");
}

void field_lines(std::ostringstream& out, const FieldReport& field)
{
    line(out, "field",
         "voxel " + number(field.voxel_size) + ", " + number(field.active_voxels, 12) +
             " active voxels, " + number(double(field.memory_bytes) / (1 << 20)) + " MiB, depth " +
             number(field.interior_depth) + (field.origin.empty() ? "" : "; " + field.origin));
    line(out, "drift",
         "zero crossing at the vertices: mean " + number(field.smooth.mean_drift) + ", max " +
             number(field.smooth.max_drift));
}

/// What lines and growth did.
void stage_lines(std::ostringstream& out, const ShellReport& report)
{
    if (report.side != Side::inward)
        line(out, "side", name_in_table(report.side));
    line_figures(out, report.lines);
    if (report.grow)
        growth_line(out, *report.grow);
    concession_lines(out, report.grow, report.scale);
    if (report.outside) {
        line(out, "outward", "");
        line_figures(out, report.outside->lines);
        if (report.outside->grow)
            growth_line(out, *report.outside->grow);
        concession_lines(out, report.outside->grow, report.outside->scale);
    }
    if (report.refine)
        refine_lines(out, *report.refine);
    if (report.cores)
        cores_line(out, *report.cores);
    layer_lines(out, report);
}

void tets_line(std::ostringstream& out, const ShellReport& report)
{
    line(out, "tets",
         number(report.signs.tets, 12) + ": " + number(report.signs.inverted.count, 12) +
             " inverted, " + number(report.signs.flat.count, 12) + " flat, " +
             (report.conformity.conforming() ? "conforming" : "NOT CONFORMING"));
}

/// Whether needles are why a solid that could be filled is not: what nobody sees from the fill
/// alone. On surfaces without them growth fills more.
bool needles_hold_back(const ShellReport& report)
{
    // Share of the solid, and longest over shortest edge. Machined parts that are less full
    // (docs/measurements/machined.md, tried.md) have triangles of 70 to 18,000.
    constexpr double kLittle = 0.95, kNeedle = 20;
    const bool by_thickness =
        report.scale || report.cores || report.lines.stops[std::size_t(StopReason::thickness)] > 0;
    return report.grow && report.side == Side::inward && !by_thickness && report.fill < kLittle &&
           report.surface_bounds.edge_ratio.max >= kNeedle;
}

/// Of what helps there, what has not been used yet.
std::string advice_on_needles(const ShellReport& report)
{
    // A tapered stack has no certificates of layers.
    const bool by_twelve_tets = report.certificate && !report.certificate->layers.empty() &&
                                report.certificate->layers.front().test == PrismTest::twelve_tets;
    std::string text = "needles hold pillars back";
    if (!report.remesh && !report.retriangulate)
        text += "; --retriangulate cuts flat parts into better triangles first";
    if (!report.remesh)
        text += "; --remesh-to N makes the whole surface anew";
    if (by_twelve_tets)
        text += "; --thickest fills more";
    return text;
}

void tet_lines(std::ostringstream& out, const ShellReport& report)
{
    line(out, "prisms",
         number(report.prisms, 12) + ", " + number(report.pinned_vertices, 12) +
             " pinned vertices, " + number(report.demanded_pins.count, 12) +
             " that geometry demands, " + number(report.ripples, 12) + " ripples");
    if (report.triangles_without_tet.count > 0)
        line(out, "",
             number(report.triangles_without_tet.count, 12) + " triangles have no tet, " +
                 number(report.without_tet_demanded, 12) +
                 " of them at three demanded pins: " + first_of(report.triangles_without_tet));
    tets_line(out, report);
    // The lower end is told twice: by the very worst tet, and by the lowest hundredth, which a
    // single tet hardly moves.
    line(out, "mean ratio",
         spread(report.quality.mean_ratio) + "; 1 % under " + number(report.quality.mean_ratio.p1));
    line(out, "dihedral",
         "smallest " + number(degrees(report.quality.min_dihedral_radians.min)) +
             " degrees, largest " + number(degrees(report.quality.max_dihedral_radians.max)));
    shape_lines(out, report);
    line(out, "volume",
         "solid " + number(report.solid_volume, 6) + ", shell " + number(report.shell_volume, 6) +
             volume_shares(report));
    if (needles_hold_back(report))
        line(out, "  void", advice_on_needles(report));
    if (report.wanted)
        for (const WantedBound& bound : report.wanted->bounds)
            line(out, "wanted", wanted_text(bound));
}

void core_line(std::ostringstream& out, const ShellReport& report)
{
    if (!report.core_fill)
        return;
    const CoreFillReport& fill = *report.core_fill;
    const std::string& program = name_in_table(fill.program);
    line(out, "core",
         fill.void_triangles == 0
             ? "nothing was left for " + program + " to fill"
             : number(fill.tets, 12) + " tets by " + program + ", " + number(fill.points, 12) +
                   " points, volume " + number(fill.volume, 6) + ", smallest dihedral " +
                   number(degrees(fill.min_dihedral_radians)) +
                   " degrees; with the shell one solid, proven");
}

void proof_lines(std::ostringstream& out, const ShellReport& report)
{
    line(out, "coverage", coverage_text(report.coverage, report.side));
    if (report.certificate)
        line(out, "certified", certificate_text(*report.certificate));
    if (report.overlaps)
        line(out, "overlaps", report.overlaps->summary());
}

} // namespace

std::string faults_of(const ShellReport& report)
{
    std::string wrong;
    const auto add = [&](std::size_t count, const char* what) {
        if (count > 0)
            wrong += (wrong.empty() ? "" : ", ") + number(count, 12) + " " + what;
    };
    add(report.signs.inverted.count, "inverted tets");
    add(report.signs.flat.count, "flat tets");
    if (!report.conformity.conforming())
        wrong += wrong.empty() ? "tets do not conform" : ", tets do not conform";
    if (report.overlaps)
        add(report.overlaps->pairs.count, "pairs of tets that overlap");
    add(report.coverage.in_several, "sample points covered more than once");
    add(report.coverage.outside_covered, "sample points covered outside the solid");
    return wrong;
}

std::string unmet_of(const ShellReport& report)
{
    std::string unmet;
    if (report.wanted)
        for (const WantedBound& bound : report.wanted->bounds)
            if (!bound.met)
                unmet += (unmet.empty() ? "wanted " : "; wanted ") + wanted_text(bound);
    return unmet;
}

/// What a pose cannot change is left out, as it stands in the report of the shell at rest.
std::string posed_report_text(const ShellReport& report)
{
    OutText out;
    out.imbue(std::locale::classic());
    if (report.pose)
        pose_lines(out, *report.pose);
    tets_line(out, report);
    line(out, "volume",
         "solid " + number(report.solid_volume, 6) + ", shell " + number(report.shell_volume, 6));
    if (report.certificate)
        line(out, "certified", certificate_text(*report.certificate));
    if (report.overlaps)
        line(out, "overlaps", report.overlaps->summary());
    if (!report.stages.empty())
        cost_lines(out, report.stages);
    line(out, "verdict", verdict(report));
    return out.str();
}

std::string report_text(const ShellReport& report)
{
    OutText out;
    out.imbue(std::locale::classic());
    surface_lines(out, report);
    field_lines(out, report.field);
    stage_lines(out, report);
    tet_lines(out, report);
    core_line(out, report);
    proof_lines(out, report);
    if (!report.stages.empty())
        cost_lines(out, report.stages);
    line(out, "verdict", verdict(report));
    return out.str();
}

} // namespace vdb_shell

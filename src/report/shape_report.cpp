// SPDX-License-Identifier: Apache-2.0

// Takes: what was measured of the shape of tets. Gives: those parts of the report. Nothing is
// measured here, and only angles change their unit.

#include "report/shape_report.h"

#include "core/degrees.h"
#include "report/text_lines.h"

#include <openvdb/Types.h>

#include <algorithm>

namespace vdb_shell
{

using nlohmann::ordered_json;

ordered_json spread_json(const Spread& spread, double (*convert)(double))
{
    const auto in_unit = [&](double value) { return convert ? convert(value) : value; };
    return {{"min", in_unit(spread.min)},  {"p1", in_unit(spread.p1)},
            {"p5", in_unit(spread.p5)},    {"median", in_unit(spread.median)},
            {"p95", in_unit(spread.p95)},  {"max", in_unit(spread.max)},
            {"mean", in_unit(spread.mean)}};
}

ordered_json quality_json(const QualityReport& quality)
{
    return {{"mean_ratio", spread_json(quality.mean_ratio)},
            {"min_dihedral_degrees", spread_json(quality.min_dihedral_radians, degrees)},
            {"max_dihedral_degrees", spread_json(quality.max_dihedral_radians, degrees)},
            {"aspect", spread_json(quality.aspect)},
            {"amips", spread_json(quality.amips)},
            {"edge_ratio", spread_json(quality.edge_ratio)},
            {"under_5_degrees", quality.slivers},
            {"sofa_bad", quality.sofa_bad}};
}

ordered_json bounds_json(const SurfaceBounds& bounds)
{
    return {{"amips", spread_json(bounds.amips)},
            {"edge_ratio", spread_json(bounds.edge_ratio)},
            {"min_dihedral_degrees", spread_json(bounds.min_dihedral_radians, degrees)},
            {"sofa_bad_triangles", bounds.sofa_bad}};
}

void shape_lines(std::ostringstream& out, const ShellReport& report)
{
    const QualityReport& quality = report.quality;
    // One, so that a shell without tets has shares of 0 and no division by it.
    const double tets = double(std::max<std::size_t>(report.signs.tets, 1));
    line(out, "shape",
         "under 5 degrees " + percent(double(quality.slivers) / tets) + ", SOFA-bad " +
             percent(double(quality.sofa_bad) / tets) + ", AMIPS mean " +
             number(quality.amips.mean) + ", worst " + number(quality.amips.max) +
             ", edge ratio worst " + number(quality.edge_ratio.max));
    const SurfaceBounds& bounds = report.surface_bounds;
    // What any shell of the surface has to bear, so that a bad figure is not laid at the shell's
    // door (docs/theory.md, "What the surface bounds").
    line(out, "  at best",
         "by the surface's own triangles: AMIPS mean from " + number(bounds.amips.mean) +
             ", worst from " + number(bounds.amips.max) + ", edge ratio worst from " +
             number(bounds.edge_ratio.max) + ", smallest dihedral up to " +
             number(degrees(bounds.min_dihedral_radians.min)) + " degrees");
}

namespace
{

/// The unit that reports have.
double shown(const WantedBound& bound, double value)
{
    return bound.kind == BoundKind::dihedral ? degrees(value) : value;
}

} // namespace

ordered_json wanted_json(const BoundsReport& report)
{
    ordered_json bounds = ordered_json::array();
    for (const WantedBound& bound : report.bounds) {
        ordered_json causes, first = ordered_json::array();
        for (std::size_t i = 0; i < kShortCauses; ++i)
            // Every cause has a key, also where no tet falls short by it.
            causes[name_in_table(ShortCause(i))] = bound.causes[i];
        for (const ShortTet& tet : bound.first)
            first.push_back({{"tet", tet.tet},
                             {"prism", tet.prism},
                             {"layer", tet.layer},
                             {"value", shown(bound, tet.value)},
                             {"cause", name_in_table(tet.cause)}});
        bounds.push_back({{"bound", name_in_table(bound.kind)},
                          {"asked", shown(bound, bound.asked)},
                          {"reached", shown(bound, bound.reached)},
                          {"met", bound.met},
                          {"short_tets", bound.short_tets},
                          {"causes", causes},
                          {"first", first}});
    }
    return {{"met", report.met()}, {"bounds", bounds}};
}

std::string wanted_text(const WantedBound& bound)
{
    std::string text = std::string(name_in_table(bound.kind)) + " " +
                       number(shown(bound, bound.asked), 12) + ": " +
                       (bound.met ? "met, " : "NOT MET, ") + number(shown(bound, bound.reached), 8);
    if (bound.short_tets == 0)
        return text;
    text += "; " + number(bound.short_tets, 12) + " tets short";
    for (std::size_t i = 0; i < kShortCauses; ++i)
        if (bound.causes[i] > 0)
            text += ", " + number(bound.causes[i], 12) + " by " + name_in_table(ShortCause(i));
    // One is enough to go and look at; the JSON has more.
    return text + "; the first is tet " + number(bound.first[0].tet, 12) + " of prism " +
           number(bound.first[0].prism, 12);
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes: the struct of all options. Gives: their sections in the order of the data, from which the
// command line, JSON and the help page are made, and the validation that no single stage can make,
// because it compares options of several. Keys are stored in files with the shell, so a key is
// never used for another meaning. Ranges are those of the stages' own descriptions.

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/section.h"
#include "vdb_shell/pipeline.h"

#include "options/option_json.h"

#include <utility>

namespace vdb_shell
{
namespace
{

OptionSection repair_section(ShellOptions& options)
{
    OptionSection section = optional_section(
        "repair", options.repair, "--repair",
        "Weld, orient, part and close the surface first; what is sound stays bit for bit");
    section.enable->group = "Surface";
    for (Option& o : section.options)
        if (o.key == "keep_crossing_fills")
            o.flag.clear(); // follows --allow-self-intersections
    return section;
}

constexpr const char* kOverlaps = "the raw method, whose shells may overlap (--method)";

/// Why the shell will be no certified one inside a surface that touches itself nowhere, in words of
/// the command; null if it will. `raw`: what speaks against the raw method.
const char* why_not_certified_inside(const ShellOptions& options, const char* raw)
{
    if (options.side != Side::inward)
        return "a shell outside the surface (--side)";
    if (options.grow.method == Method::raw)
        return raw;
    if (options.check.allow_self_intersections)
        return "a surface that may cross itself (--allow-self-intersections)";
    return nullptr;
}

/// Tapering goes on from a valid shell inside a surface that touches itself nowhere, and moves its
/// inner points to wherever there is room.
void require_taper_possible(const ShellOptions& options)
{
    if (!options.taper.wanted)
        return;
    const char* hindrance = why_not_certified_inside(options, kOverlaps);
    if (!hindrance && options.scale.factor < 1)
        hindrance = "shells scaled down (--thickness-scale); a bound is --thickness";
    if (hindrance)
        throw InvalidOption(std::string("taper: --taper is not for ") + hindrance);
}

/// What no surface can have. Tets of the raw method may be inverted or lie in each other, so that
/// neither their shape nor their fill says anything.
void require_wishes_possible(const ShellOptions& options)
{
    if (options.wanted.any() && options.grow.method == Method::raw)
        throw InvalidOption("want: bounds (--want-...) are not for the raw method, whose tets may "
                            "be inverted (--method)");
    const char* fill = options.wanted.fill        ? "want: fill (--want-fill)"
                       : options.grow.enough_fill ? "grow: enough_fill (--enough-fill)"
                                                  : nullptr;
    if (fill && options.side == Side::outward)
        throw InvalidOption(std::string(fill) + " is a share of the solid, and a shell outside "
                                                "(--side) has no solid to fill");
}

/// Under the three-tet test a prism keeps the diagonals that have room, so that no rule can hold.
void require_split_counts(const ShellOptions& options)
{
    const bool grown_by_three =
        options.grow.method != Method::raw && prism_test_of(options.grow) == PrismTest::chosen_tets;
    if (grown_by_three && options.split.rule != SplitOptions().rule)
        throw InvalidOption("split: no rule (--split) counts under the three-tet test "
                            "(--prism-test chosen-tets, --method thickest), where growth chooses "
                            "the diagonals");
}

/// What is filled lies inside of a certified shell that itself lies inside of the surface.
void require_core_fill_possible(const ShellOptions& options)
{
    if (!options.core_fill.wanted())
        return;
    const char* hindrance = why_not_certified_inside(options, kOverlaps);
    if (hindrance)
        throw InvalidOption(std::string("core_fill: --core-fill is not for ") + hindrance);
}

} // namespace

OptionSections describe(ShellOptions& o)
{
    return {{"", in_group("Lines", {option("side", o.side, "--side",
                                           "Side of the surface that the shell lies on")})},
            {"", in_group("Surface", {option("mend", o.mend, "--mend",
                                             "Repair a surface that no shell can be made of, or "
                                             "wrap it where that is not enough; a usable one is "
                                             "taken as it is")})},
            repair_section(o),
            {"wrap", describe(o.wrap)},
            {"contour", describe(o.contour)},
            {"check", describe(o.check)},
            {"retriangulate", describe(o.retriangulate)},
            {"decimate", describe(o.decimate)},
            {"remesh", describe(o.remesh)},
            {"subdivide", describe(o.subdivide)},
            {"cores", describe(o.cores)},
            {"level_set", describe(o.level_set)},
            {"", in_group("Level set", {option("field", o.field, "--field",
                                               "Deep voxels only where lines end, or all of them; "
                                               "auto takes what is less work")})},
            {"smooth", describe(o.smooth)},
            {"directions", describe(o.directions)},
            {"line_step", describe(o.line_step)},
            {"limits", describe(o.limits)},
            {"grow", describe(o.grow)},
            {"refine", describe(o.refine)},
            {"scale", describe(o.scale)},
            {"layers", describe(o.layers)},
            {"taper", describe(o.taper)},
            {"want", describe(o.wanted)},
            {"core_fill", describe(o.core_fill)},
            {"split", describe(o.split)},
            {"coverage", describe(o.coverage)}};
}

void require_sensible(const ShellOptions& options, bool thickness_grid)
{
    // A description binds to the fields of a struct and could write them; a copy keeps the caller's
    // const.
    ShellOptions copy = options;
    for (const OptionSection& section : describe(copy))
        require_in_range(section.options, section.key);
    if (options.refine.rounds > 0 && options.side == Side::outward)
        throw InvalidOption("refine: rounds is " + std::to_string(options.refine.rounds) +
                            " (--refine-rounds), but an outward shell has no solid to fill");
    require_sensible(options.remesh);
    if (options.remesh.wanted() && options.decimate.triangles)
        throw InvalidOption("decimate and remesh: one or the other; remeshing makes any number of "
                            "triangles (--remesh-to)");
    if (options.wrap.wanted && options.repair)
        throw InvalidOption("wrap and repair: one or the other; a wrap needs no repaired surface");
    if (options.wrap.wanted && options.mend)
        throw InvalidOption("wrap and mend: one or the other; a wrap needs no mending");
    require_taper_possible(options);
    require_wishes_possible(options);
    require_core_fill_possible(options);
    require_split_counts(options);
    // A line outward always has a thickness: a tenth of the diagonal where the user gives none
    // (shell/sides.h).
    if (options.side != Side::outward && options.line_step.test == StopTest::none &&
        options.limits.limit == Limit::none && !options.line_step.thickness && !thickness_grid)
        throw InvalidOption("the stop test is none, there is no limit and no thickness: nothing "
                            "would end the lines");
}

void require_cores_possible(const ShellOptions& options)
{
    const char* hindrance =
        why_not_certified_inside(options, "the raw method, which looks at no obstacle (--method)");
    if (hindrance)
        throw InvalidOption(std::string("cores: --core FILE is not for ") + hindrance);
}

std::string options_json(const ShellOptions& options)
{
    ShellOptions copy = options;
    return to_json(describe(copy)).dump(2);
}

ShellOptions options_from_json(const std::string& json, ShellOptions base, const std::string& name)
{
    // Described after it is parsed: most files that are wrong are no JSON at all.
    const nlohmann::ordered_json parsed = parse_options(json, name);
    OptionSections sections = describe(base);
    set_from_json(parsed, sections, name);
    return base;
}

} // namespace vdb_shell

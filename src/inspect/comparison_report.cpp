// SPDX-License-Identifier: Apache-2.0

// Takes a comparison of two shells; gives it as columns for people and as JSON. Angles are in
// degrees, as in all reports.

#include "vdb_shell/inspect/compare_shells.h"

#include "core/degrees.h"
#include "core/text_stream.h"
#include "report/text_lines.h"

#include <nlohmann/json.hpp>

#include <iomanip>

namespace vdb_shell
{
namespace
{

using nlohmann::ordered_json;

/// One row: what it is called for people, its key in JSON, and how both are got.
struct Row {
    const char* label;
    const char* key;
    ordered_json (*value)(const ShellFigures&);
    bool share = false; ///< of some whole: printed in per cent
};

/// One table for both forms, so that a figure cannot be in one and not in the other.
const std::vector<Row>& rows()
{
    using Of = const ShellFigures&;
    static const std::vector<Row> table{
        {"vertices", "vertices", [](Of f) -> ordered_json { return f.vertices; }},
        {"triangles", "triangles", [](Of f) -> ordered_json { return f.triangles; }},
        {"layers", "layers", [](Of f) -> ordered_json { return f.layers; }},
        {"tets", "tets", [](Of f) -> ordered_json { return f.tets; }},
        {"tets of a core", "core_tets", [](Of f) -> ordered_json { return f.core_tets; }},
        {"tets a triangle", "tets_per_triangle",
         [](Of f) -> ordered_json { return f.tets_per_triangle; }},
        {"pinned vertices", "pinned_vertices", [](Of f) -> ordered_json { return f.pinned; }},
        {"volume, solid", "solid_volume", [](Of f) -> ordered_json { return f.solid_volume; }},
        {"volume, shell", "shell_volume", [](Of f) -> ordered_json { return f.shell_volume; }},
        {"fill", "fill", [](Of f) -> ordered_json { return f.fill; }, true},
        {"thickness, mean", "mean_thickness",
         [](Of f) -> ordered_json { return f.mean_thickness; }},
        {"thickness, largest", "largest_thickness",
         [](Of f) -> ordered_json { return f.largest_thickness; }},
        {"least dihedral, degrees", "least_dihedral_degrees",
         [](Of f) -> ordered_json { return degrees(f.least_dihedral_radians); }},
        {"below 5 degrees", "sliver_share", [](Of f) -> ordered_json { return f.sliver_share; },
         true},
        {"AMIPS, median", "median_amips", [](Of f) -> ordered_json { return f.median_amips; }},
        {"tapered", "tapered", [](Of f) -> ordered_json { return f.tapered; }},
        {"posed", "posed", [](Of f) -> ordered_json { return f.posed; }},
        {"checksum", "checksum", [](Of f) -> ordered_json { return f.checksum; }},
    };
    return table;
}

std::string cell(const Row& row, const ShellFigures& figures)
{
    const ordered_json value = row.value(figures);
    if (value.is_boolean())
        return value.get<bool>() ? "yes" : "no";
    if (value.is_string())
        return value.get<std::string>();
    if (value.is_number_integer())
        return number(value.get<std::size_t>(), 12);
    return row.share ? percent(value.get<double>()) : number(value.get<double>(), 6);
}

/// What can be said in one sentence.
std::string verdict(const ShellComparison& c)
{
    if (c.same_bits)
        return "the same shell, bit for bit";
    if (!c.same_triangles)
        return "shells of different surfaces: other triangles";
    const bool same_skin = c.outer->largest == 0;
    return std::string("the same triangles, ") +
           (same_skin ? "outer points in the same places" : "outer points in other places") +
           (c.same_tets ? ", the same tets" : ", other tets");
}

ordered_json change_json(const std::optional<PointChange>& change)
{
    if (!change)
        return nullptr;
    return {{"mean", change->mean}, {"largest", change->largest}, {"vertex", change->at}};
}

ordered_json figures_json(const ShellFigures& figures, const std::string& name)
{
    ordered_json object{{"file", name}};
    for (const Row& row : rows())
        object[row.key] = row.value(figures);
    return object;
}

} // namespace

std::string comparison_text(const ShellComparison& c, const std::string& first,
                            const std::string& second)
{
    constexpr int kLabel = 25;
    OutText out;
    out.imbue(std::locale::classic());
    out << "A  " << first << "\nB  " << second << '\n' << verdict(c) << "\n\n";
    // As wide as the longest figure of A; those of B come last and need no width.
    std::size_t width = 4;
    for (const Row& row : rows())
        width = std::max(width, cell(row, c.first).size() + 2);
    const auto columns = [&](const std::string& label, const std::string& a, const std::string& b) {
        out << std::left << std::setw(kLabel) << label << std::setw(int(width)) << a << b << '\n';
    };
    columns("", "A", "B");
    for (const Row& row : rows())
        columns(row.label, cell(row, c.first), cell(row, c.second));
    const auto change = [&](const char* what, const std::optional<PointChange>& moved) {
        if (moved)
            out << what << " apart: mean " << number(moved->mean) << ", largest "
                << number(moved->largest) << " (vertex " << moved->at << ")\n";
    };
    out << '\n';
    change("outer points", c.outer);
    change("inner points", c.inner);
    if (!c.options.empty())
        out << "options that differ:\n";
    for (const auto& [key, a, b] : c.options)
        out << "  " << key << ": " << (a.empty() ? "none" : a) << ", " << (b.empty() ? "none" : b)
            << '\n';
    return out.str();
}

std::string comparison_json(const ShellComparison& c, const std::string& first,
                            const std::string& second)
{
    ordered_json object{{"verdict", verdict(c)},
                        {"same_bits", c.same_bits},
                        {"same_triangles", c.same_triangles},
                        {"same_tets", c.same_tets},
                        {"first", figures_json(c.first, first)},
                        {"second", figures_json(c.second, second)},
                        {"outer_points", change_json(c.outer)},
                        {"inner_points", change_json(c.inner)}};
    ordered_json options = ordered_json::object();
    for (const auto& [key, a, b] : c.options)
        options[key] = {a.empty() ? ordered_json() : ordered_json::parse(a),
                        b.empty() ? ordered_json() : ordered_json::parse(b)};
    object["options"] = std::move(options);
    return object.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

} // namespace vdb_shell

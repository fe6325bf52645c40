// SPDX-License-Identifier: Apache-2.0

// Takes the report of a repair and says it for people and as JSON. It computes nothing. Numbers are
// written in the classic locale, so that a program in another locale gets no commas in them. Of
// each kind of change there is the exact count, but only the first indices are kept, and the text
// says by dots that there are more.

#include "vdb_shell/repair/repair_mesh.h"

#include "core/text_stream.h"
#include "mesh/defect_json.h"
#include "mesh/mesh_check_json.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{
namespace
{

using nlohmann::ordered_json;

ordered_json after_json(const MeshCheck& check)
{
    ordered_json json = mesh_check_json(check);
    json["inside_out_components"] = check.inside_out_components();
    return json;
}

std::string shown(const Defect<std::uint32_t>& defect)
{
    std::string text;
    for (const std::uint32_t index : defect.first)
        text += (text.empty() ? ": " : ", ") + std::to_string(index);
    return text + (defect.first.size() < defect.count ? ", ..." : "");
}

std::string hole_text(const HoleFill& hole)
{
    OutText out;
    out.imbue(std::locale::classic());
    if (hole.first_point == kNoSource)
        out << "hole, cut out later, of ";
    else
        out << "hole at point " << hole.first_point << " of ";
    out << hole.edges << " edges, length " << hole.length << ": ";
    if (hole.method == FillMethod::none)
        out << "LEFT OPEN";
    else
        out << name_of(hole.method) << " fill of " << hole.new_triangles << " triangles, "
            << hole.new_points << " new points";
    if (hole.crossings > 0)
        out << ", every fill tried crosses the surface, the best in " << hole.crossings
            << (hole.crossings_at_least ? " or more" : "") << " pairs of triangles";
    return out.str();
}

} // namespace

std::string repair_text(const RepairReport& report)
{
    OutText out;
    out.imbue(std::locale::classic());
    const auto add = [&](const Defect<std::uint32_t>& defect, const char* what) {
        if (defect.count > 0)
            out << "  " << defect.count << ' ' << what << shown(defect) << '\n';
    };
    add(report.welded_points, "points welded to an earlier one");
    add(report.collapsed, "triangles dropped that welding left with fewer than 3 points");
    add(report.degenerate, "triangles of zero area removed");
    add(report.slivers, "slivers removed");
    add(report.recut, "triangles recut beside those");
    add(report.duplicates, "repeated triangles dropped");
    add(report.sheets, "triangles dropped of sheets that bound no solid");
    add(report.turned, "triangles turned");
    add(report.split_points, "points parted");
    if (report.copies > 0)
        out << "  " << report.split_edges << " edges parted; " << report.copies
            << " copies of points, " << report.moved_points << " moved apart by at most "
            << report.largest_move << '\n';
    add(report.loose, report.loose_dropped
                          ? "triangles of small open pieces dropped"
                          : "triangles of small open pieces left, which --drop-loose drops");
    add(report.cut, "triangles cut out that cross others, or stand near");
    for (const HoleFill& hole : report.holes)
        out << "  " << hole_text(hole) << '\n';
    if (!report.changed())
        out << "  nothing to repair\n";
    out << "  " << report.kept_triangles << " of " << report.after.triangles
        << " triangles are the input's, bit for bit\n";
    return out.str();
}

std::string repair_json(const RepairReport& report)
{
    ordered_json holes = ordered_json::array();
    for (const HoleFill& hole : report.holes) {
        holes.push_back({{"first_point", hole.first_point},
                         {"edges", hole.edges},
                         {"length", hole.length},
                         {"method", name_of(hole.method)},
                         {"new_points", hole.new_points},
                         {"new_triangles", hole.new_triangles},
                         {"crossings", hole.crossings}});
        if (hole.crossings_at_least)
            holes.back()["crossings_at_least"] = true;
    }
    const ordered_json json{{"welded_points", defect_json(report.welded_points)},
                            {"collapsed", defect_json(report.collapsed)},
                            {"degenerate", defect_json(report.degenerate)},
                            {"slivers", defect_json(report.slivers)},
                            {"recut", defect_json(report.recut)},
                            {"duplicates", defect_json(report.duplicates)},
                            {"sheets", defect_json(report.sheets)},
                            {"turned", defect_json(report.turned)},
                            {"split_points", defect_json(report.split_points)},
                            {"split_edges", report.split_edges},
                            {"copies", report.copies},
                            {"moved_points", report.moved_points},
                            {"largest_move", report.largest_move},
                            {"loose", defect_json(report.loose)},
                            {"loose_dropped", report.loose_dropped},
                            {"cut", defect_json(report.cut)},
                            {"holes", holes},
                            {"kept_triangles", report.kept_triangles},
                            {"after", after_json(report.after)}};
    return json.dump(2);
}

} // namespace vdb_shell

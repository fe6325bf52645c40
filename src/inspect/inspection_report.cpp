// SPDX-License-Identifier: Apache-2.0

// Takes an inspection and says it for people and as JSON. It computes nothing; the verdict in both
// comes from the same usable(). The text names the first few of each kind, the JSON lists every
// loop, patch and component. Numbers are in the classic locale, whatever that of the program is.

#include "vdb_shell/inspect/inspect_mesh.h"

#include "core/text_stream.h"
#include "mesh/components_json.h"
#include "mesh/placement_json.h"

namespace vdb_shell
{
namespace
{

using nlohmann::ordered_json;

/// `kind` is for programs and does not change; `text` and `mend` are for people.
ordered_json findings_json(const std::vector<Finding>& findings)
{
    ordered_json list = ordered_json::array();
    for (const Finding& finding : findings)
        list.push_back({{"kind", finding.kind},
                        {"text", finding.text},
                        {"count", finding.count},
                        {"first", finding.first},
                        {"blocks", finding.blocks},
                        {"mend", finding.mend}});
    return list;
}

ordered_json loops_json(const MeshInspection& inspection)
{
    ordered_json list = ordered_json::array();
    for (const BoundaryLoop& loop : inspection.boundary_loops)
        list.push_back({{"first_point", loop.first_point},
                        {"edges", loop.edges},
                        {"length", loop.length},
                        {"closed", loop.closed}});
    return list;
}

ordered_json patches_json(const MeshInspection& inspection)
{
    ordered_json list = ordered_json::array();
    for (const FlippedPatch& patch : inspection.flipped_patches)
        list.push_back({{"first_triangle", patch.first_triangle}, {"triangles", patch.triangles}});
    return list;
}

/// A finding without elements is a statement about the whole mesh, and its count of 1 would say
/// nothing.
void put(std::ostream& out, const Finding& finding)
{
    out << (finding.blocks ? "  in the way  " : "  take note   ");
    if (!finding.first.empty())
        out << finding.count << ' ';
    out << finding.text;
    const char* before = ": ";
    for (const std::string& element : finding.first) {
        out << before << element;
        before = "; ";
    }
    if (finding.first.size() < finding.count && !finding.first.empty())
        out << "; ...";
    if (!finding.mend.empty())
        out << "\n                -> " << finding.mend;
    out << '\n';
}

} // namespace

std::string inspection_text(const std::string& name, const ReadReport& read,
                            const MeshInspection& inspection)
{
    const MeshCheck& check = inspection.check;
    const std::vector<Finding> findings = findings_of(inspection);
    OutText out;
    out.imbue(std::locale::classic());
    out << name << ": " << read.format << ", " << check.points << " points ("
        << read.welded_vertices << " welded, " << read.unused_vertices << " unused), "
        << check.triangles << " triangles (" << read.skipped_faces.size()
        << " faces skipped), components: " << check.components.size() << '\n';
    if (read.placement.moves())
        out << "  " << placement_text(read.placement) << '\n';
    out << "  volume " << check.volume << ", voxel " << inspection.voxel_size << ", shortest edge "
        << inspection.floats.shortest_edge << ", coordinates up to " << inspection.floats.farthest
        << " in steps of " << inspection.floats.spacing << '\n';
    for (const Finding& finding : findings)
        put(out, finding);
    out << (usable(inspection) ? "  usable as it is\n" : "  NOT usable as it is\n");
    // Faults of coordinates and voxels no mending removes.
    if (!why_not_usable(check, {}).empty())
        out << "              -> build --mend repairs or wraps it, with as little change as will "
               "do\n";
    return out.str();
}

std::string inspection_json(const std::string& name, const ReadReport& read,
                            const MeshInspection& inspection)
{
    const MeshCheck& check = inspection.check;
    const FloatLimits& floats = inspection.floats;
    ordered_json json;
    json["source"] = name;
    json["usable"] = usable(inspection);
    json["format"] = read.format;
    json["points"] = check.points;
    json["triangles"] = check.triangles;
    json["welded_vertices"] = read.welded_vertices;
    json["unused_vertices"] = read.unused_vertices;
    json["skipped_faces"] = read.skipped_faces;
    json["placement"] = placement_json(read.placement);
    json["volume"] = check.volume;
    json["voxel_size"] = inspection.voxel_size;
    json["findings"] = findings_json(findings_of(inspection));
    json["boundary_loops"] = loops_json(inspection);
    json["flipped_patches"] = patches_json(inspection);
    json["components"] = components_json(check.components);
    json["floats"] = {{"farthest", floats.farthest},
                      {"spacing", floats.spacing},
                      {"digits", floats.digits},
                      {"shortest_edge", floats.shortest_edge},
                      {"longest_side", floats.longest_side},
                      {"largest_rounding", floats.largest_rounding}};
    // A file name may hold bytes that are no UTF-8.
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// What posing found and did, for programs and for people.

#include "report/pose_report.h"

#include "options/parse_json.h"
#include "report/text_lines.h"
#include "vdb_shell/core/error.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace vdb_shell
{

using nlohmann::ordered_json;

ordered_json pose_json(const PoseReport& pose)
{
    return {{"tets", pose.tets},
            {"free_points", pose.free_points},
            {"inverted_carried", pose.inverted_carried},
            {"moved_points", pose.moved_points},
            {"rounds", pose.rounds},
            {"inverted", pose.inverted},
            {"inverted_by_skin", pose.inverted_by_skin},
            {"lost_pillars", pose.lost_pillars},
            {"lost_demanded", pose.lost_demanded},
            {"faces_not_apart", pose.faces_not_apart},
            {"skin_crossings", pose.skin_crossings},
            {"excused_triangles", pose.excused_triangles},
            {"distorted", pose.distorted},
            {"mean_distortion", pose.mean_distortion},
            {"most_distortion", pose.most_distortion}};
}

void pose_lines(std::ostringstream& out, const PoseReport& pose)
{
    line(out, "carried",
         number(double(pose.free_points), 12) + " points; " +
             number(double(pose.inverted_carried), 12) + " tets inverted, " +
             number(double(pose.moved_points), 12) + " points moved to mend that and what touched");
    line(out, "distortion",
         "mean " + number(pose.mean_distortion) + ", " + number(double(pose.distorted), 12) +
             " tets beyond the bound, worst " + number(pose.most_distortion));
    // Said only where it happened, as both are about parts of the shell that are not as tested as
    // the rest (docs/theory.md, "Posed shells").
    if (pose.skin_crossings > 0)
        line(out, "",
             "the skin crosses itself: " + number(double(pose.skin_crossings), 12) +
                 " pairs of triangles; contacts of " + number(double(pose.excused_triangles), 12) +
                 " prisms are let be");
    if (pose.lost_pillars > 0)
        line(out, "",
             number(double(pose.lost_pillars), 12) + " inner points without a valid place; to " +
                 number(double(pose.lost_demanded), 12) + " of them the skin leaves none");
    if (pose.faces_not_apart > 0)
        line(out, "",
             number(double(pose.faces_not_apart), 12) + " pairs of inner triangles still touch");
}

std::string posed_report_json(const ShellReport& posed, const std::string& at_rest, bool with_costs)
{
    // The report of the shell at rest, with what a pose changes put over it. It was read from a
    // file and may be anything. The name of that file is not known here, and the source of the pose
    // is another one.
    const std::string name = "the shell at rest";
    ordered_json json = parse_json(at_rest, name, "its report is no JSON object");
    if (!json.is_object())
        throw ReadError(name + ": its report is no JSON object");
    // Through its text, so that a key means the same in both reports.
    const ordered_json now = ordered_json::parse(report_json(posed, with_costs));
    for (const char* key : {"mesh", "prisms", "tets", "conformity", "quality", "volume",
                            "certificate", "overlaps", "pose"})
        json[key] = now[key];
    // Of the shell at rest they would be taken for this one's.
    for (const char* key : {"coverage", "wanted", "surface_bounds", "layers"})
        json[key] = nullptr;
    if (with_costs)
        json["stages"] = now["stages"];
    return json.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

} // namespace vdb_shell

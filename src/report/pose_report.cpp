// SPDX-License-Identifier: Apache-2.0

// What posing found and did, for programs and for people.

#include "report/pose_report.h"

#include "report/text_lines.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace vdb_shell
{

nlohmann::ordered_json pose_json(const PoseReport& pose)
{
    return {{"tets", pose.tets},
            {"free_points", pose.free_points},
            {"inverted_carried", pose.inverted_carried},
            {"moved_points", pose.moved_points},
            {"rounds", pose.rounds},
            {"inverted", pose.inverted},
            {"inverted_by_skin", pose.inverted_by_skin},
            {"lost_pillars", pose.lost_pillars},
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
    if (pose.skin_crossings > 0)
        line(out, "",
             "the skin crosses itself: " + number(double(pose.skin_crossings), 12) +
                 " pairs of triangles; contacts of " + number(double(pose.excused_triangles), 12) +
                 " prisms are let be");
    if (pose.lost_pillars > 0)
        line(out, "",
             number(double(pose.lost_pillars), 12) +
                 " pillars for which the skin leaves no valid place");
}

} // namespace vdb_shell

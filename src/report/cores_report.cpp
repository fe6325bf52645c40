// SPDX-License-Identifier: Apache-2.0

// Takes: the figures of the cores. Gives: their part of the report, as JSON and in a line for a
// person.

#include "report/cores_report.h"

#include "report/text_lines.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{

using nlohmann::ordered_json;

ordered_json cores_json(const CoreReport& cores)
{
    ordered_json files = ordered_json::array();
    for (const CoreFigures& core : cores.cores)
        files.push_back({{"name", core.name},
                         {"triangles", core.triangles},
                         {"parts", core.parts},
                         {"volume", core.volume},
                         {"ended", core.ended}});
    return {{"distance", cores.distance},
            {"least_distance", cores.least_distance},
            {"volume", cores.volume},
            {"ended", cores.ended},
            {"kept_out_triangles", cores.kept_out_triangles},
            {"files", files}};
}

void cores_line(std::ostringstream& out, const CoreReport& cores)
{
    line(out, "cores",
         number(cores.cores.size(), 12) + ", " + number(cores.ended, 12) +
             " pillars ended there; no tet nearer than " + number(cores.least_distance));
}

} // namespace vdb_shell

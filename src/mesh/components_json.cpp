// SPDX-License-Identifier: Apache-2.0

// The components of a surface as JSON, the same in every report. Programs read the reports by these
// keys, so a key must not be renamed.

#include "mesh/components_json.h"

namespace vdb_shell
{

nlohmann::ordered_json components_json(const std::vector<Component>& components)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const Component& part : components)
        list.push_back({{"triangles", part.triangles},
                        {"first_triangle", part.first_triangle},
                        {"volume", part.volume},
                        {"closed", part.closed},
                        {"euler", part.euler},
                        {"nesting_depth", part.nesting_depth},
                        {"inside_out", part.inside_out}});
    return list;
}

} // namespace vdb_shell

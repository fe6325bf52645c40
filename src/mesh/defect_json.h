// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/check_mesh.h"

#include <nlohmann/json.hpp>

namespace vdb_shell
{

/// All are counted but only the first few by index are named (Defect::kFirstShown), so that a
/// report stays short however bad the surface is. A pair becomes a list of two.
template <typename Element> nlohmann::ordered_json defect_json(const Defect<Element>& defect)
{
    return {{"count", defect.count}, {"first", defect.first}};
}

} // namespace vdb_shell

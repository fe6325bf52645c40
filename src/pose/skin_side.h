// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pose/rest_parts.h"

#include <cstddef>
#include <cstdint>

namespace vdb_shell
{

/// The layers on one side of the skin: from it to `end`.
struct SkinSide {
    std::size_t end; ///< surface
    bool outside;
};

/// The point of the tets in which a pillar is on that surface; kFree where no tet has it.
inline std::uint32_t point_at(const RestShell::Parts& parts, std::size_t surface, std::size_t v)
{
    return parts.point_of_place[parts.first_place[surface * parts.stack.surface(0).size() + v]];
}

} // namespace vdb_shell

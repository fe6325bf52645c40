// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the surfaces of a component enclose, and whether the components keep clear of each other.

#include "vdb_shell/certify/certificate.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// inside_out_components and nested_wrongly, for components without an open triangle. `contacts`:
/// pairs of triangles that touch.
void check_regions(const PrismShell& shell, const std::vector<std::uint32_t>& component_of,
                   const std::vector<char>& open_triangle,
                   const std::vector<std::array<std::uint32_t, 2>>& contacts,
                   Certificate& certificate);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/certificate.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Finds all touching triangles of the two surfaces: outer_contacts, inner_folds, inner_contacts
/// and inner_through_outer. Gives back the touching pairs of triangles, whichever surface they
/// belong to.
std::vector<std::array<std::uint32_t, 2>>
check_surfaces(const PrismShell& shell, const std::vector<char>& pinned, Certificate& certificate);

} // namespace vdb_shell

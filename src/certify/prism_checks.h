// SPDX-License-Identifier: Apache-2.0
#pragma once

// What can be said prism by prism and edge by edge.

#include "mesh/topology.h"
#include "vdb_shell/certify/certificate.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

std::vector<char> pinned_flags(const PrismShell& shell);

/// bad_prisms and cyclic_prisms.
void check_prisms(const PrismShell& shell, const PrismSplit& split, const std::vector<char>& pinned,
                  Certificate& certificate);

/// open_edges and non_conforming_edges. Raises `open_triangle` beside each open edge.
void check_edges(const PrismSplit& split, const std::vector<char>& pinned, const EdgeUses& uses,
                 Certificate& certificate, std::vector<char>& open_triangle);

/// split_vertices.
void check_vertices(const PrismShell& shell, const EdgeUses& uses, Certificate& certificate);

} // namespace vdb_shell

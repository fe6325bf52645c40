// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/prism_shell.h"

#include <limits>

namespace vdb_shell::test
{

/// The cap of pillars that have none.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double fill_of(const PrismShell& shell)
{
    return 1 - signed_volume(shell.inner, shell.triangles) /
                   signed_volume(shell.outer, shell.triangles);
}

} // namespace vdb_shell::test

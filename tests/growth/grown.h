// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/growth/grow.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/prism_shell.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace vdb_shell::test
{

/// The cap of pillars that have none.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double fill_of(const PrismShell& shell)
{
    return 1 - signed_volume(shell.inner, shell.triangles) /
                   signed_volume(shell.outer, shell.triangles);
}

/// What growth takes.
struct Case {
    TriangleMesh mesh;
    Directions directions;
    LineLengths start; ///< none: growth finds its own start
    std::vector<double> cap;
};

inline Case case_of(const TriangleMesh& mesh, double cap = kInfinity)
{
    Case c;
    c.mesh = mesh;
    c.directions = directions_along(mesh, pseudo_normals(mesh));
    const std::size_t count = mesh.points.size();
    c.start = {std::vector<double>(count, 0.0), std::vector<std::uint32_t>(count, 0),
               std::vector<StopReason>(count, StopReason::none)};
    c.cap.assign(count, cap);
    return c;
}

inline GrowResult grown(const Case& c, const GrowOptions& options = {},
                        Interrupter* interrupter = nullptr)
{
    return grow_shell(c.mesh, c.directions, c.start, c.cap, options, {}, interrupter);
}

} // namespace vdb_shell::test

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/topology.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// The component of each triangle: triangles that share an edge share a component. Components are
/// numbered by their first triangle.
std::vector<std::uint32_t> component_of_triangles(const EdgeUses& sorted_uses,
                                                  std::size_t triangle_count);

/// The pairs of different components to which the pairs of triangles belong, smaller first, sorted.
std::vector<std::array<std::uint32_t, 2>>
crossing_components(const std::vector<TrianglePair>& pairs,
                    const std::vector<std::uint32_t>& component_of);

/// Everything that check_mesh says about the components. `crossing`: pairs of components that cross
/// or touch, smaller first, sorted.
std::vector<Component>
describe_components(const TriangleMesh& mesh, const EdgeUses& sorted_uses,
                    const std::vector<std::uint32_t>& component_of,
                    const std::vector<std::array<std::uint32_t, 2>>& crossing);

} // namespace vdb_shell

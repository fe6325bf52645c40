// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/tessellate.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace vdb_shell
{

/// Tets that fill what a shell leaves empty. A corner below the number of the shell's
/// TetMesh::points is that point; the others are `points` in their order.
struct CoreTets {
    static constexpr std::uint32_t kNoVertex = ~std::uint32_t(0);

    std::vector<openvdb::Vec3s> points;
    /// Per own point: the vertex of the outermost surface that it is, where no tet of the shell has
    /// that vertex; kNoVertex for points of the core's inside. The former come first, in the order
    /// of VoidSurface (certify/core_certificate.h).
    std::vector<std::uint32_t> source_vertex;
    std::vector<openvdb::Vec4I> tets; ///< det(b-a, c-a, d-a) > 0

    bool empty() const { return tets.empty(); }
};

/// What TetMesh::prism and TetMesh::prism_layer say of a tet of the core, and TetMesh::layer of a
/// point inside of it.
inline constexpr std::uint32_t kCorePrism = ~std::uint32_t(0);
inline constexpr std::uint8_t kCoreLayer = 255;

/// Shell and core as one: the shell's points and tets, then the core's.
TetMesh joined_tets(const TetMesh& shell, const CoreTets& core);

/// Whether the mesh has tets of a core.
bool has_core(const TetMesh& tets);

/// Numbers as files have them, which is -1 for what belongs to no surface and to no prism: the
/// tets and points of a core (kCorePrism, kCoreLayer, CoreTets::kNoVertex).
template <typename Number> std::vector<std::int32_t> signed_numbers(const std::vector<Number>& list)
{
    std::vector<std::int32_t> made;
    made.reserve(list.size());
    for (const Number number : list)
        made.push_back(number == std::numeric_limits<Number>::max() ? -1
                                                                    : static_cast<int>(number));
    return made;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

struct RefinedMesh {
    TriangleMesh mesh;                 ///< points of before keep their indices
    std::vector<std::uint32_t> source; ///< per triangle: the one of before that it is a piece of
    std::vector<std::array<std::uint32_t, 2>> halved; ///< per new point: the ends of its edge
    std::size_t cut = 0;                              ///< how many of the wanted triangles were cut
    bool out_of_room = false;                         ///< most_triangles left some of them whole
    std::size_t barred_edges = 0; ///< left whole, for halved they made triangles touch or flatten
};

/// Cuts the triangles `wanted`, most wanted first, as many of them as `most_triangles` leaves room
/// for, by halving their longest edges, and the triangles around them so that the surface conforms:
/// no triangle is cut before its longest edge is (Rivara), which keeps angles from shrinking round
/// by round. The shape stays, but for the rounding of the middles to float32; where
/// halving an edge would make triangles touch or lose their area by that, it stays whole.
/// A surface that is embedded stays so. Deterministic. Precondition: closed, manifold.
RefinedMesh refine_triangles(const TriangleMesh& mesh, const std::vector<std::uint32_t>& wanted,
                             std::size_t most_triangles, Interrupter* interrupter = nullptr);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::repair
{

/// The pairs of triangles' sides that count as one edge each: by 3 * triangle + side the partner,
/// or kUnpaired. Edges of two opposite sides pair them; around edges of more, sides pair that have
/// a wedge of solid between them and nothing else.
constexpr std::uint32_t kUnpaired = UINT32_MAX;
std::vector<std::uint32_t> pair_sides(const TriangleMesh& mesh);

/// The fan of each corner (3 * triangle + corner): corners that are neighbours across paired sides
/// share one. Fans are numbered by their first corner.
struct Fans {
    std::vector<std::uint32_t> of_corner;
    std::vector<std::uint32_t> point; ///< by fan
    std::vector<char> open;           ///< by fan: it has unpaired sides
};
Fans find_fans(const TriangleMesh& mesh, const std::vector<std::uint32_t>& partner);

/// A hole's rim, in the direction in which its fill runs through it.
struct Hole {
    std::vector<std::uint32_t> points;
    std::vector<std::uint32_t> beyond; ///< by edge point[i] -> point[i+1]: the third corner of the
                                       ///< triangle outside
    std::vector<std::uint32_t> triangles; ///< by edge: that triangle
};

/// Where a rim that comes to an open fan goes on: by fan the one whose side it leaves the point by.
/// Itself where the fan stands alone or no order around the point is certain; else the fan on the
/// other side of the hole, so that filling all holes makes one fan of them.
std::vector<std::uint32_t> link_fans(const TriangleMesh& mesh,
                                     const std::vector<std::uint32_t>& partner, const Fans& fans);

/// All holes but those at `skipped` triangles (which are of pieces without an orientation). A rim
/// may pass a point more than once.
std::vector<Hole> walk_holes(const TriangleMesh& mesh, const std::vector<std::uint32_t>& partner,
                             const Fans& fans, const std::vector<std::uint32_t>& next_fan,
                             const std::vector<char>& skipped);

/// By triangle: whether its piece is one-sided.
std::vector<char> one_sided_triangles(const TriangleMesh& mesh);

} // namespace vdb_shell::repair

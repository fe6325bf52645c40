// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/obstacles/core_feet.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/shell_stack.h"

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

// What every format that holds a whole shell writes of it, besides the arrays themselves: the
// points numbered once for all formats, and what is derived from the pillars. docs/file_format.md
// says what the numbers mean. Lengths are world units.

/// Numbers of elements of a shell; OpenVDB and Houdini index with int32.
struct ShellCounts {
    std::int64_t vertices = 0, points = 0, tet_points = 0, prisms = 0, tets = 0;
    std::int64_t layers = 1, skin = 0;
    bool tapered = false;
    std::int64_t core_points = 0, core_tets = 0;
    bool posed = false; ///< not set by counts_of
};
ShellCounts counts_of(const ShellStack& stack, const TetMesh& tets, const CoreTets& core = {});

/// The points of the file by id: all vertices of the outermost surface, then surface by surface
/// those whose pillar in the layer above is not pinned. The tets number their points otherwise:
/// they leave out what no tet uses. In a tapered stack each pillar keeps its points here, and the
/// tets have one where several pillars share it: that of smallest id.
struct ShellPoints {
    static constexpr std::int32_t kUnused = -1;
    std::vector<openvdb::Vec3s> position;
    std::vector<std::uint32_t> vertex;
    std::vector<std::uint8_t> layer;
    /// By surface and vertex; that of the surface above where the pillar between them is pinned.
    std::vector<std::vector<std::uint32_t>> id;
    /// Per id: index into TetMesh::points, or kUnused. Ids of a tapered stack that share a point
    /// have the same.
    std::vector<std::int32_t> tet_point;
    std::vector<std::uint32_t> id_of_tet_point;
};
/// Precondition: require_consistent.
ShellPoints number_points(const ShellStack& stack, const TetMesh& tets);

/// A vector for each point of a shell.
struct PointVectors {
    std::vector<std::vector<openvdb::Vec3s>> surface; ///< by surface and vertex; may be empty
    std::vector<openvdb::Vec3s> core;                 ///< of CoreTets::points

    bool empty() const { return surface.empty(); }
};
/// What a posed shell's points have besides their places.
struct RestPoints : PointVectors { ///< where they were at rest
    PointVectors velocity;         ///< a second; empty where it is not known

    bool posed() const { return !empty(); }
};
std::vector<openvdb::Vec3s> vectors_by_id(const ShellPoints& points, const PointVectors& vectors);
std::vector<std::vector<openvdb::Vec3s>>
vectors_by_surface(const ShellPoints& points, const std::vector<openvdb::Vec3s>& by_id);
/// By point of joined_tets(tets, core); empty where there are none.
std::vector<openvdb::Vec3s> vectors_of_tet_points(const TetMesh& tets, const PointVectors& vectors);

/// Of the pillar that a point of the tets belongs to.
struct PillarValues {
    std::vector<float> thickness;          ///< thickness_of
    std::vector<std::int32_t> stop_reason; ///< stop_reason_of
};
/// By point of joined_tets(tets, core) of `points` points; a core's own points have 0 of both.
PillarValues pillar_values(const ShellStack& stack, const TetMesh& tets, std::size_t points);

/// By id: the foot of the pillar whose innermost point it is; other points have none.
std::vector<CoreFoot> feet_by_id(const ShellPoints& points, const std::vector<CoreFoot>& feet);
/// The way back. Throws ReadError, its message opened by `name`, for values that no foot has.
std::vector<CoreFoot> feet_by_vertex(const ShellPoints& points, const std::vector<CoreFoot>& by_id,
                                     const std::string& name);

/// The next point of the pillar: below, or above where there is nothing below.
const openvdb::Vec3s& opposite_of(const ShellStack& stack, std::size_t surface, std::size_t vertex);
/// Of the whole pillar, from the outermost surface to the innermost.
float thickness_of(const ShellStack& stack, std::size_t vertex);
/// Why the pillar ends below the skin; above it where no layer lies below.
StopReason stop_reason_of(const ShellStack& stack, std::size_t vertex);
/// Whether the pillar has no length in any layer.
bool pinned_throughout(const ShellStack& stack, std::size_t vertex);
/// Whether there are layers above the skin and below it.
inline bool on_both_sides(const ShellStack& stack)
{
    return stack.skin > 0 && stack.skin < stack.layers.size();
}

/// Unit normals of a layer, each the sum of its triangles' area vectors; zero where they cancel.
std::vector<openvdb::Vec3s> layer_normals(const std::vector<openvdb::Vec3s>& points,
                                          const std::vector<openvdb::Vec3I>& triangles);

/// Throws InvalidOption unless the arrays fit together as make_tets leaves them and every
/// coordinate is finite: what is refused here could not be read back.
void require_consistent(const ShellStack& stack, const TetMesh& tets);
/// The same of a core: corners in range, as many points as source vertices, and the shell inside of
/// its surface where there is one. Precondition: that of the shell.
void require_consistent_core(const ShellStack& stack, const TetMesh& tets, const CoreTets& core);

/// FNV-1a over all arrays of the shell, as 16 hexadecimal digits: tells a damaged file, and points
/// that belong to another file. Zeros of either sign differ.
std::string checksum_of(const ShellStack& stack, const TetMesh& tets, const CoreTets& core = {});

} // namespace vdb_shell

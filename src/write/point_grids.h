// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/shell/shell_stack.h"

#include <openvdb/points/PointDataGrid.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

inline constexpr const char* kPointsGrid = "shell_points";
inline constexpr const char* kPrismsGrid = "shell_prisms";
inline constexpr const char* kTetsGrid = "shell_tets";

/// Only where there are layers above and below the skin: why the pillars above it end.
inline constexpr const char* kOuterStop = "stop_reason_outer";
inline bool on_both_sides(const ShellStack& stack)
{
    return stack.skin > 0 && stack.skin < stack.layers.size();
}

/// Numbers of elements of a shell; OpenVDB and Houdini index with int32.
struct ShellCounts {
    std::int64_t vertices = 0, points = 0, tet_points = 0, prisms = 0, tets = 0;
    std::int64_t layers = 1, skin = 0;
};
ShellCounts counts_of(const ShellStack& stack, const TetMesh& tets);

/// The points of the file by id: all vertices of the outermost surface, then surface by surface
/// those whose pillar in the layer above is not pinned. The tets number their points otherwise:
/// they leave out what no tet uses.
struct ShellPoints {
    static constexpr std::int32_t kUnused = -1;
    std::vector<openvdb::Vec3s> position;
    std::vector<std::uint32_t> vertex;
    std::vector<std::uint8_t> layer;
    /// By surface and vertex; that of the surface above where the pillar between them is pinned.
    std::vector<std::vector<std::uint32_t>> id;
    std::vector<std::int32_t> tet_point; ///< per id: index into TetMesh::points, or kUnused
    std::vector<std::uint32_t> id_of_tet_point;
};
/// Precondition: require_consistent.
ShellPoints number_points(const ShellStack& stack, const TetMesh& tets);

/// The next point of the pillar: below, or above where there is nothing below.
const openvdb::Vec3s& opposite_of(const ShellStack& stack, std::size_t surface, std::size_t vertex);
/// Of the whole pillar, from the outermost surface to the innermost.
float thickness_of(const ShellStack& stack, std::size_t vertex);
bool pinned_throughout(const ShellStack& stack, std::size_t vertex);

/// Unit normals of a layer, each the sum of its triangles' area vectors; zero where they cancel.
std::vector<openvdb::Vec3s> layer_normals(const std::vector<openvdb::Vec3s>& points,
                                          const std::vector<openvdb::Vec3I>& triangles);

/// The shell as three grids of points; the order of points inside a grid means nothing, ids are
/// explicit. Precondition: require_consistent.
struct PointGrids {
    openvdb::points::PointDataGrid::Ptr points, prisms, tets;
};
PointGrids make_point_grids(const ShellStack& stack, const TetMesh& tets);

/// Fills everything but the splits' ripples. Throws ReadError, its message opened by `name`, unless
/// every id is there once, in range, and the redundant parts agree.
void read_point_grids(const PointGrids& grids, const ShellCounts& counts, const std::string& name,
                      ShellStack& stack, TetMesh& tets);

/// Throws InvalidOption unless the arrays fit together as make_tets leaves them and every
/// coordinate is finite: what is refused here could not be read back.
void require_consistent(const ShellStack& stack, const TetMesh& tets);

/// Not equality of values: zeros of either sign differ, as they do for the checksum.
bool same_bits(const openvdb::Vec3s& a, const openvdb::Vec3s& b);

/// FNV-1a over all arrays of the shell, as 16 hexadecimal digits: tells a damaged file, and points
/// that belong to another file.
std::string checksum_of(const ShellStack& stack, const TetMesh& tets);

} // namespace vdb_shell

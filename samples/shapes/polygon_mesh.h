// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <cstdint>
#include <filesystem>
#include <vector>

// Surfaces as modellers keep them: triangles and quads side by side, counter-clockwise seen from
// outside.

namespace vdb_shell::samples
{

constexpr double kPi = 3.14159265358979323846;

using Polygon = std::vector<std::uint32_t>; ///< 0-based corners, three or four

struct PolygonMesh {
    std::vector<openvdb::Vec3d> points;
    std::vector<Polygon> faces;
};

/// Joins pairs of triangles into quads, best shaped pairs first, where the quad is close enough to
/// a flat rectangle. The first and third corner of each quad are the ends of the joined edge, so
/// that a fan from the first corner gives the triangles back.
PolygonMesh join_into_quads(const PolygonMesh& triangles);

/// Text with six decimals: the same bytes on every run.
void write_obj(const std::filesystem::path& path, const PolygonMesh& mesh);

} // namespace vdb_shell::samples

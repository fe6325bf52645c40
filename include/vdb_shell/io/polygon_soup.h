// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/read_mesh.h"

#include <openvdb/Types.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// A surface as a file holds it, before anything is merged, split or moved: what a reader of
/// another format has to deliver.
struct PolygonSoup {
    std::string format; ///< for ReadReport::format
    /// In the file's own coordinates. Doubles, because ReadOptions::recentre subtracts the origin
    /// before coordinates are rounded to float32.
    std::vector<openvdb::Vec3d> points;
    /// Indices of points, polygon after polygon, each counter-clockwise seen from outside.
    std::vector<std::uint32_t> corners;
    std::vector<std::uint32_t> polygon_sizes; ///< how many of `corners` each polygon takes
    std::vector<std::int64_t> ids;            ///< by point (ReadResult::ids); may be empty
};

/// The steps that read_mesh takes after it has parsed a file, with the same guarantees: moves the
/// points as the options ask, rounds each coordinate once to float32, welds equal positions,
/// triangulates polygons, and drops points that no triangle uses. Faces that cannot be kept are
/// listed in the report, with the polygons' indices in `soup`. `name` (the file's) opens all
/// messages. Throws ReadError for a coordinate that is not finite in float32 or over
/// kLargestCoordinate, a corner out of range, and when no triangle remains; InvalidOption when the
/// polygon sizes do not add up to the number of corners, or there are ids but not one a point.
ReadResult mesh_of_polygons(const PolygonSoup& soup, const std::string& name,
                            const ReadOptions& options = {});

} // namespace vdb_shell

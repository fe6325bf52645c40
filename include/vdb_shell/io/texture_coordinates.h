// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/io/polygon_soup.h"
#include "vdb_shell/mesh/placement.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <openvdb/math/Vec2.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace vdb_shell
{

/// A surface with texture coordinates (u, v) for each corner of each triangle. Corners at the same
/// point have different ones along seams.
struct TextureCoordinates {
    TriangleMesh mesh; ///< as read_mesh gives it, welded
    std::vector<std::array<openvdb::Vec2d, 3>> corner;
};

/// Of OBJ (`vt`, by corners of faces) and PLY (by vertex: u and v, s and t, texture_u and
/// texture_v, texture_s and texture_t; by face: a list texcoord). `placement`: that of the mesh of
/// which they are wanted, so that points come out with the bits that it has. Where a polygon has a
/// point twice, its first corner there counts for both. Throws ReadError as read_mesh does; for a
/// file or a format without texture coordinates; for the first face that has none at a corner.
TextureCoordinates read_texture_coordinates(const std::filesystem::path& path,
                                            const Placement& placement = {});

/// The same of a surface from elsewhere, with a value for each of its corners; `name` opens the
/// messages. Throws also InvalidOption when there are not as many values as corners.
TextureCoordinates texture_of_polygons(const PolygonSoup& soup,
                                       const std::vector<openvdb::Vec2d>& by_corner,
                                       const std::string& name, const Placement& placement = {});

} // namespace vdb_shell

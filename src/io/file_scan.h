// SPDX-License-Identifier: Apache-2.0
#pragma once

// One strict pass over the bytes of a mesh file for each format. A scan believes no count of a
// header before it has seen the data, parses numbers without the process's locale, and refuses with
// the element and its line whatever it does not understand: no face is lost without a word.

#include "io/coordinates.h"
#include "io/scan_text.h"
#include "vdb_shell/io/read_mesh.h"

#include <openvdb/Types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vdb_shell
{

using Polygon = std::vector<std::uint32_t>;

/// What a file holds: points as the mesh will have them, and polygons that tidy_polygon left.
struct FileScan {
    std::string format; ///< for the report
    std::size_t file_vertices = 0;
    std::size_t file_faces = 0;
    std::vector<openvdb::Vec3s> points;
    std::vector<std::uint32_t> corners;       ///< of all polygons, one polygon after the other
    std::vector<std::uint32_t> polygon_sizes; ///< how many of `corners` each takes
    std::vector<std::int64_t> ids;            ///< by point, or empty (ReadResult::ids)
    std::vector<std::size_t> skipped_faces;   ///< faces of the file that are no polygon, ascending
};

/// Texture coordinates as a file has them.
struct TextureScan {
    static constexpr std::uint32_t kNone = ~std::uint32_t(0);

    std::vector<openvdb::Vec2d> values;
    // Of all faces of the file, those that are no polygon too, one face after the other.
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> texture; ///< by corner: one of `values`, or kNone
    std::vector<std::uint32_t> face_sizes;
};

// `coordinates` is given every coordinate of the file. Each throws ReadError as read_mesh documents
// it; `name` is the file's, for messages.
FileScan scan_obj(const std::string& name, std::string_view bytes, Coordinates& coordinates);
FileScan scan_ply(const std::string& name, std::string_view bytes, Coordinates& coordinates);
FileScan scan_off(const std::string& name, std::string_view bytes, Coordinates& coordinates);
FileScan scan_stl(const std::string& name, std::string_view bytes, Coordinates& coordinates);
// The same, with texture coordinates where the file has them; by corner none where it has none.
FileScan scan_obj(const std::string& name, std::string_view bytes, Coordinates& coordinates,
                  TextureScan* texture);
FileScan scan_ply(const std::string& name, std::string_view bytes, Coordinates& coordinates,
                  TextureScan* texture);
using Scan = FileScan (*)(const std::string& name, std::string_view bytes, Coordinates&);

/// What read_mesh makes of the bytes of a file.
ReadResult mesh_of_bytes(const std::string& name, Scan scan, std::string bytes,
                         const ReadOptions& options);

struct PolygonSoup;
/// A soup as the scan of a file, with the tests of one.
FileScan scan_of_polygons(const PolygonSoup& soup, const std::string& name,
                          Coordinates& coordinates);

/// Removes corners that repeat the corner before them. False when what is left is no polygon: fewer
/// than three corners, or none that comes only once.
bool tidy_polygon(Polygon& polygon);

/// The position of the first corner that comes only once; polygon.size() when there is none.
std::size_t first_unique_corner(const Polygon& polygon);

/// Throws ReadError for more than indices of 32 bits number: OpenVDB's and Houdini's have a sign.
void require_numbered(const std::string& name, std::size_t count, const char* what);

/// Counts one more face of the file and keeps it, tidied; a face that is no polygon is recorded as
/// skipped.
void add_face(FileScan& scan, Polygon& polygon);

/// Throws unless `index` is one of `vertices` vertices; `shown` is the index as the file has it.
void require_corner(const std::string& name, const Place& face, std::int64_t index,
                    std::size_t vertices, const std::string& shown);

/// The steps after the scan, of all formats: welds, triangulates, drops points without triangles.
/// Throws ReadError, opened by `name`, when the file has no faces or no triangle comes of them.
ReadResult mesh_of_scan(const std::string& name, FileScan scan, const Coordinates& coordinates,
                        const ReadOptions& options);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// The last steps of all readers: merge vertices of equal position, cut polygons into triangles, and
// drop points that nothing uses. It takes a scan whose corners are all in range. It leaves
// triangles of three different points each, points in the order of the file, and a report in which
// polygons kept and faces skipped add up to the faces of the file. The order matters: merging can
// make corners of a polygon equal, so triangles are cut after it, and only then is it known which
// points are used.

#include "io/file_scan.h"
#include "io/triangulate.h"
#include "mesh/equal_points.h"

#include <utility>

namespace vdb_shell
{
namespace
{

/// Rewrites the corners to the first vertex of the same position; returns how many positions there
/// are.
std::size_t weld(FileScan& scan)
{
    // Corners go to the first of equal points, so the order of the points stays that of the file.
    const std::vector<std::uint32_t> first = first_equal_point(scan.points);
    for (std::uint32_t& corner : scan.corners)
        corner = first[corner];
    std::size_t different = 0;
    for (std::size_t v = 0; v < first.size(); ++v)
        different += first[v] == v;
    return different;
}

/// Triangulates the polygons; those that welding left without a triangle join the faces that the
/// scan skipped already, in the order of the file.
void append_faces(const FileScan& scan, ReadResult& result)
{
    std::vector<std::size_t>& skipped = result.report.skipped_faces;
    auto skipped_before = scan.skipped_faces.begin();
    auto corner = scan.corners.begin();
    std::size_t file_face = 0;
    Polygon polygon;
    // A polygon of n corners makes n - 2 triangles.
    const std::size_t most = scan.corners.size() - 2 * scan.polygon_sizes.size();
    result.mesh.triangles.reserve(most);
    const bool only_triangles = most == scan.polygon_sizes.size();
    for (const std::uint32_t size : scan.polygon_sizes) {
        // Both lists are ascending and together hold every face once. Faces that the scan left out
        // are passed before the next polygon, so `file_face` is the number that the file gives it.
        for (; skipped_before != scan.skipped_faces.end() && *skipped_before == file_face;
             ++skipped_before)
            skipped.push_back(file_face++);
        polygon.assign(corner, corner + size);
        corner += size;
        // Welding may have made two corners of a polygon the same.
        if (tidy_polygon(polygon)) {
            result.report.polygons_triangulated += polygon.size() > 3;
            if (!only_triangles)
                result.first_triangles.push_back(
                    static_cast<std::uint32_t>(result.mesh.triangles.size()));
            append_triangles(scan.points, polygon, result.mesh.triangles);
        } else {
            skipped.push_back(file_face);
        }
        ++file_face;
    }
    skipped.insert(skipped.end(), skipped_before, scan.skipped_faces.end());
}

/// Copies the points that triangles use to the mesh, in order, with their ids; returns how many
/// those are.
std::size_t keep_used_points(const FileScan& scan, ReadResult& result)
{
    const std::vector<openvdb::Vec3s>& points = scan.points;
    TriangleMesh& mesh = result.mesh;
    // An index would have to be near 2^32 to be taken for one of these marks.
    constexpr std::uint32_t kUnused = UINT32_MAX, kUsed = UINT32_MAX - 1;
    std::vector<std::uint32_t> new_index(points.size(), kUnused);
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            new_index[t[corner]] = kUsed;
    mesh.points.reserve(points.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
        if (new_index[v] == kUnused)
            continue;
        new_index[v] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(points[v]);
        if (!scan.ids.empty())
            result.ids.push_back(scan.ids[v]);
    }
    for (openvdb::Vec3I& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            t[corner] = new_index[t[corner]];
    return mesh.points.size();
}

} // namespace

ReadResult mesh_of_scan(const std::string& name, FileScan scan, const Coordinates& coordinates,
                        const ReadOptions& options)
{
    if (scan.file_faces == 0)
        refuse(name, "it has no faces (and " + std::to_string(scan.file_vertices) + " vertices)");
    require_numbered(name, scan.points.size(), "points");
    ReadResult result;
    result.report.format = std::move(scan.format);
    result.report.file_vertices = scan.file_vertices;
    result.report.file_faces = scan.file_faces;
    result.report.placement = coordinates.placement();
    result.report.largest_rounding = coordinates.largest_rounding();
    const std::size_t vertices = options.weld ? weld(scan) : scan.points.size();
    result.report.welded_vertices = scan.file_vertices - vertices;
    append_faces(scan, result);
    require_numbered(name, result.mesh.triangles.size(), "triangles");
    const std::size_t used = keep_used_points(scan, result);
    result.report.unused_vertices = vertices - used;
    // In float32 a small object far from the origin falls together into a few points.
    if (result.mesh.triangles.empty())
        refuse(name, "none of its " + std::to_string(scan.file_faces) +
                         " faces has three different corners (in float32; --recentre where the "
                         "object lies far from the origin)");
    return result;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "io/polygon_soup.h"

#include "io/triangulate.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace vdb_shell
{

namespace fs = std::filesystem;

namespace
{

/// Rewrites the corners to the first vertex of the same position; returns how many positions there
/// are.
std::size_t weld(PolygonSoup& soup)
{
    const std::vector<std::uint32_t> first = first_equal_point(soup.points);
    for (Corners& face : soup.faces)
        for (std::uint32_t& corner : face)
            corner = first[corner];
    std::size_t different = 0;
    for (std::size_t v = 0; v < first.size(); ++v)
        different += first[v] == v;
    return different;
}

/// Triangulates the faces; those that cannot be are added to report.skipped_faces.
void append_faces(PolygonSoup& soup, const FileScan& scan, ReadResult& result)
{
    std::vector<std::size_t>& skipped = result.report.skipped_faces;
    std::size_t next_not_passed_on = 0, file_face = 0;
    for (Corners& face : soup.faces) {
        for (; next_not_passed_on < scan.skipped_faces.size() &&
               scan.skipped_faces[next_not_passed_on] == file_face;
             ++next_not_passed_on, ++file_face)
            skipped.push_back(file_face);
        if (tidy_polygon(face)) {
            result.report.polygons_triangulated += face.size() > 3;
            append_triangles(soup.points, face, result.mesh.triangles);
        } else {
            skipped.push_back(file_face);
        }
        ++file_face;
    }
    skipped.insert(skipped.end(),
                   scan.skipped_faces.begin() + static_cast<std::ptrdiff_t>(next_not_passed_on),
                   scan.skipped_faces.end());
}

/// Moves the points that triangles use to the mesh, in order; returns how many those are.
std::size_t keep_used_points(const std::vector<openvdb::Vec3s>& points, TriangleMesh& mesh)
{
    constexpr std::uint32_t kUnused = UINT32_MAX, kUsed = UINT32_MAX - 1;
    std::vector<std::uint32_t> new_index(points.size(), kUnused);
    for (const openvdb::Vec3I& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            new_index[t[corner]] = kUsed;
    for (std::size_t v = 0; v < points.size(); ++v) {
        if (new_index[v] == kUnused)
            continue;
        new_index[v] = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(points[v]);
    }
    for (openvdb::Vec3I& t : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            t[corner] = new_index[t[corner]];
    return mesh.points.size();
}

} // namespace

ReadResult mesh_of_soup(const std::string& name, const FileScan& scan, PolygonSoup soup,
                        const ReadOptions& options)
{
    ReadResult result;
    result.report.format = scan.format;
    result.report.file_vertices = scan.file_vertices;
    result.report.file_faces = scan.file_faces;
    const std::size_t vertices = options.weld ? weld(soup) : soup.points.size();
    result.report.welded_vertices = scan.file_vertices - vertices;
    append_faces(soup, scan, result);
    const std::size_t used = keep_used_points(soup.points, result.mesh);
    result.report.unused_vertices = vertices - used;
    if (result.mesh.triangles.empty())
        refuse(name, "none of its " + std::to_string(scan.file_faces) +
                         " faces has three different corners (in float32; --recentre where the "
                         "object lies far from the origin)");
    return result;
}

std::string read_whole_file(const fs::path& path)
{
    const std::string name = path.string();
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status))
        refuse(name, "there is no such file");
    if (fs::is_directory(status))
        refuse(name, "it is a folder, not a file");
    if (!fs::is_regular_file(status))
        refuse(name, "it is not a regular file");
    std::ifstream in(path, std::ios::binary);
    const std::uintmax_t size = fs::file_size(path, error);
    if (!in || error)
        refuse(name, std::string("it cannot be opened: ") + std::strerror(errno));
    std::string bytes(size, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(in.gcount()) != size)
        refuse(name, "only " + std::to_string(in.gcount()) + " of its " + std::to_string(size) +
                         " bytes can be read");
    if (bytes.empty())
        refuse(name, "the file is empty");
    return bytes;
}

} // namespace vdb_shell

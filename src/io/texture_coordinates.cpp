// SPDX-License-Identifier: Apache-2.0

// Takes a mesh file, gives its triangles with texture coordinates at their corners. The mesh comes
// about as read_mesh makes it, and each triangle then looks for its corners among those of the
// polygon that it was cut from. Invariant: polygons are gone through in the order in which
// mesh_of_scan goes through them, and a polygon of n corners, tidied, makes n - 2 triangles.

#include "vdb_shell/io/texture_coordinates.h"

#include "io/file_scan.h"
#include "io/texture_of_bytes.h"
#include "mesh/equal_points.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/core/words.h"
#include "vdb_shell/io/read_file.h"

#include <cassert>
#include <cstddef>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;

void require_texture_format(const std::string& name, const std::string& extension)
{
    if (extension != ".obj" && extension != ".ply")
        refuse(name,
               "texture coordinates are read from .obj and .ply, not from \"" + extension + "\"");
}

void require_all(const std::string& name, const TextureScan& texture)
{
    std::size_t corner = 0, without = 0;
    for (const std::uint32_t index : texture.texture)
        // A surface that has none at all is told so as a whole; one that lacks some is told which
        // face.
        without += index == TextureScan::kNone;
    if (texture.values.empty() || without == texture.texture.size())
        refuse(name, "it has no texture coordinates");
    for (std::size_t face = 0; face < texture.face_sizes.size(); ++face)
        for (std::uint32_t k = 0; k < texture.face_sizes[face]; ++k)
            if (texture.texture[corner++] == TextureScan::kNone)
                refuse(name, "face " + std::to_string(face) +
                                 " has no texture coordinates, though others have");
}

/// The value of the corner that is at `point`. There is one: triangles are cut from polygons.
Vec2d value_at(const TextureScan& texture, const std::vector<openvdb::Vec3s>& points,
               std::size_t first, std::size_t last, const openvdb::Vec3s& point)
{
    for (std::size_t k = first; k < last; ++k)
        if (points[texture.vertices[k]] == point)
            return texture.values[texture.texture[k]];
    assert(false);
    return Vec2d(0.0);
}

TextureCoordinates texture_of_scan(const std::string& name, FileScan scan,
                                   const Coordinates& coordinates, const TextureScan& texture)
{
    require_all(name, texture);
    // Kept from the scan, which gives its own points to the mesh.
    const std::vector<openvdb::Vec3s> points = scan.points;
    const std::vector<std::uint32_t> first_equal = first_equal_point(points);
    TextureCoordinates made;
    made.mesh = mesh_of_scan(name, std::move(scan), coordinates, {}).mesh;
    made.corner.reserve(made.mesh.triangles.size());
    std::size_t first = 0;
    Polygon polygon;
    for (const std::uint32_t size : texture.face_sizes) {
        // Tidied, welded and tidied again, as the scan and mesh_of_scan do: welded before, some
        // polygon would have a triangle that the mesh has not.
        polygon.assign(texture.vertices.begin() + std::ptrdiff_t(first),
                       texture.vertices.begin() + std::ptrdiff_t(first + size));
        bool kept = tidy_polygon(polygon);
        for (std::uint32_t& corner : polygon)
            corner = first_equal[corner];
        kept = kept && tidy_polygon(polygon);
        const std::size_t triangles = kept ? polygon.size() - 2 : 0;
        for (std::size_t n = 0; n < triangles; ++n) {
            const openvdb::Vec3I& t = made.mesh.triangles[made.corner.size()];
            std::array<Vec2d, 3>& corner = made.corner.emplace_back();
            for (int k = 0; k < 3; ++k)
                corner[std::size_t(k)] =
                    value_at(texture, points, first, first + size, made.mesh.points[t[k]]);
        }
        first += size;
    }
    assert(made.corner.size() == made.mesh.triangles.size());
    return made;
}

} // namespace

TextureCoordinates texture_of_bytes(const std::string& name, const std::string& extension,
                                    std::string_view bytes, const Placement& placement)
{
    require_texture_format(name, extension);
    Coordinates coordinates(placement);
    TextureScan texture;
    FileScan scan = (extension == ".obj" ? scan_obj(name, bytes, coordinates, &texture)
                                         : scan_ply(name, bytes, coordinates, &texture));
    return texture_of_scan(name, std::move(scan), coordinates, texture);
}

TextureCoordinates read_texture_coordinates(const std::filesystem::path& path,
                                            const Placement& placement)
{
    const std::string extension = lower_case_extension(path);
    require_texture_format(path.string(), extension);
    return texture_of_bytes(path.string(), extension, read_whole_file(path), placement);
}

TextureCoordinates texture_of_polygons(const PolygonSoup& soup, const std::vector<Vec2d>& by_corner,
                                       const std::string& name, const Placement& placement)
{
    if (by_corner.size() != soup.corners.size())
        throw InvalidOption(name + ": there are " + std::to_string(by_corner.size()) +
                            " texture coordinates for " + std::to_string(soup.corners.size()) +
                            " corners");
    Coordinates coordinates(placement);
    FileScan scan = scan_of_polygons(soup, name, coordinates);
    TextureScan texture{by_corner, soup.corners, {}, soup.polygon_sizes};
    for (std::uint32_t corner = 0; corner < by_corner.size(); ++corner)
        texture.texture.push_back(corner);
    return texture_of_scan(name, std::move(scan), coordinates, texture);
}

} // namespace vdb_shell

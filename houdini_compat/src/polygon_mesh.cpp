// SPDX-License-Identifier: Apache-2.0

// Houdini's polygons run clockwise, so the order is turned round, of texture coordinates too. The
// vertices of a primitive follow those of the primitive before it; the reader has made sure that
// their sum is right. The first corner stays the first: polygons are cut into triangles as fans
// around it, and so the fans keep their apex.

#include "vdb_shell/houdini/polygon_mesh.h"

#include "vdb_shell/io/polygon_soup.h"
#include "vdb_shell/io/read_file.h"

#include <cmath>
#include <cstddef>

namespace vdb_shell::houdini
{
namespace
{

/// Points are kept in double until mesh_of_polygons rounds them, so that --recentre can use all
/// digits of files with doubles.
template <typename T>
std::vector<openvdb::Vec3d> points_from(const std::vector<T>& values, std::size_t size,
                                        const std::string& name)
{
    std::vector<openvdb::Vec3d> points;
    points.reserve(values.size() / size);
    for (std::size_t i = 0; i + size <= values.size(); i += size) {
        points.emplace_back(values[i], values[i + 1], values[i + 2]);
        // A weight other than 1 belongs to rational curves and surfaces; dividing by it would be a
        // guess at what a polygon means by it.
        if (size == 4 && values[i + 3] != T(1))
            refuse(name, "point " + std::to_string(i / size) + ": P has the weight " +
                             std::to_string(values[i + 3]) + ", only 1 can be read");
    }
    return points;
}

/// The positions. Up to Houdini 14, P has a fourth component, a weight.
std::vector<openvdb::Vec3d> positions_of(const HoudiniGeometry& geometry, const std::string& name)
{
    const Attribute* p = find(geometry.point_attributes, "P");
    if (!p)
        refuse(name, "it has no point attribute P");
    const auto size = static_cast<std::size_t>(p->size);
    const bool sized = size == 3 || size == 4;
    if (const auto* singles = std::get_if<std::vector<float>>(&p->values); singles && sized)
        return points_from(*singles, size, name);
    if (const auto* doubles = std::get_if<std::vector<double>>(&p->values); doubles && sized)
        return points_from(*doubles, size, name);
    refuse(name, "P has " + std::to_string(p->size) +
                     " components, or is not of floats; 3 or 4 floats are needed");
}

std::vector<std::int64_t> ids_of(const HoudiniGeometry& geometry)
{
    const Attribute* id = find(geometry.point_attributes, "id");
    if (!id || id->size != 1)
        return {};
    if (const auto* small = std::get_if<std::vector<std::int32_t>>(&id->values))
        return {small->begin(), small->end()};
    if (const auto* large = std::get_if<std::vector<std::int64_t>>(&id->values))
        return *large;
    return {};
}

/// Tetrahedra are refused and not left out: what remained would be a surface that nobody has drawn.
void require_polygons(const HoudiniGeometry& geometry, const std::string& name)
{
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i)
        if (geometry.primitives[i].type != PrimitiveType::polygon)
            refuse(name, "primitive " + std::to_string(i) +
                             " is a tetrahedron; a surface is of polygons only");
}

/// For each corner of the soup the vertex of the geometry.
std::vector<std::size_t> vertex_of_corner(const HoudiniGeometry& geometry)
{
    std::vector<std::size_t> vertices;
    vertices.reserve(geometry.vertex_point.size());
    std::size_t first = 0;
    for (const Primitive& primitive : geometry.primitives) {
        for (std::size_t k = 0; k < primitive.vertices; ++k)
            vertices.push_back(first + (k == 0 ? 0 : primitive.vertices - k));
        first += primitive.vertices;
    }
    return vertices;
}

PolygonSoup soup_of(const ReadGeometry& read, const std::string& name)
{
    const HoudiniGeometry& geometry = read.geometry;
    require_polygons(geometry, name);
    PolygonSoup soup;
    soup.format = name_of(read.format);
    soup.points = positions_of(geometry, name);
    soup.ids = ids_of(geometry);
    soup.corners.reserve(geometry.vertex_point.size());
    for (const std::size_t vertex : vertex_of_corner(geometry))
        soup.corners.push_back(geometry.vertex_point[vertex]);
    for (const Primitive& primitive : geometry.primitives)
        soup.polygon_sizes.push_back(static_cast<std::uint32_t>(primitive.vertices));
    return soup;
}

/// Two numbers for each element that has the attribute.
std::vector<openvdb::Vec2d> pairs_of(const Attribute& uv, const std::string& name)
{
    std::vector<openvdb::Vec2d> pairs;
    const auto take = [&](const auto& values) {
        const auto size = static_cast<std::size_t>(uv.size);
        for (std::size_t i = 0; i + size <= values.size(); i += size)
            pairs.emplace_back(double(values[i]), double(values[i + 1]));
    };
    const auto* singles = std::get_if<std::vector<float>>(&uv.values);
    const auto* doubles = std::get_if<std::vector<double>>(&uv.values);
    if (uv.size < 2 || (!singles && !doubles))
        refuse(name, "uv has " + std::to_string(uv.size) +
                         " components, or is not of floats; 2 or 3 floats are needed");
    if (singles)
        take(*singles);
    else
        take(*doubles);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        if (!std::isfinite(pairs[i][0]) || !std::isfinite(pairs[i][1]))
            refuse(name, "uv of element " + std::to_string(i) + " is not finite");
    return pairs;
}

} // namespace

ReadResult polygon_mesh(const ReadGeometry& read, const std::string& name,
                        const ReadOptions& options)
{
    return mesh_of_polygons(soup_of(read, name), name, options);
}

TextureCoordinates polygon_texture(const ReadGeometry& read, const std::string& name,
                                   const Placement& placement)
{
    const HoudiniGeometry& geometry = read.geometry;
    const Attribute* of_vertex = find(geometry.vertex_attributes, "uv");
    const Attribute* uv = of_vertex ? of_vertex : find(geometry.point_attributes, "uv");
    if (!uv)
        refuse(name, "it has no texture coordinates (no vertex or point attribute uv)");
    const PolygonSoup soup = soup_of(read, name);
    const std::vector<openvdb::Vec2d> pairs = pairs_of(*uv, name);
    std::vector<openvdb::Vec2d> by_corner;
    by_corner.reserve(soup.corners.size());
    for (const std::size_t vertex : vertex_of_corner(geometry))
        by_corner.push_back(pairs[of_vertex ? vertex : geometry.vertex_point[vertex]]);
    return texture_of_polygons(soup, by_corner, name, placement);
}

TextureCoordinates read_polygon_texture(const std::filesystem::path& path,
                                        const Placement& placement)
{
    return polygon_texture(read_geometry(path), path.string(), placement);
}

ReadResult read_polygon_mesh(const std::filesystem::path& path, const ReadOptions& options)
{
    return polygon_mesh(read_geometry(path), path.string(), options);
}

} // namespace vdb_shell::houdini

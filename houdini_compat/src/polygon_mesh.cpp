// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/houdini/polygon_mesh.h"

#include "io/coordinates.h"
#include "io/polygon_soup.h"
#include "io/scan_text.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::houdini
{
namespace
{

template <typename T>
std::vector<openvdb::Vec3s> points_from(const std::vector<T>& values, std::size_t size,
                                        const std::string& name, Coordinates& coordinates)
{
    std::vector<openvdb::Vec3s> points(values.size() / size);
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            points[i][static_cast<int>(axis)] = coordinates.from_number(
                name, {"point", i}, static_cast<double>(values[i * size + axis]),
                static_cast<int>(axis));
        if (size == 4 && values[i * size + 3] != T(1))
            refuse(name, "point " + std::to_string(i) + ": P has the weight " +
                             std::to_string(values[i * size + 3]) + ", only 1 can be read");
    }
    return points;
}

/// P as float32; up to Houdini 14 it has a fourth component, a weight.
std::vector<openvdb::Vec3s> positions_of(const HoudiniGeometry& geometry, const std::string& name,
                                         Coordinates& coordinates)
{
    const Attribute* p = find(geometry.point_attributes, "P");
    if (!p)
        refuse(name, "it has no point attribute P");
    const auto size = static_cast<std::size_t>(p->size);
    const bool sized = size == 3 || size == 4;
    if (const auto* singles = std::get_if<std::vector<float>>(&p->values); singles && sized)
        return points_from(*singles, size, name, coordinates);
    if (const auto* doubles = std::get_if<std::vector<double>>(&p->values); doubles && sized)
        return points_from(*doubles, size, name, coordinates);
    refuse(name, "P has " + std::to_string(p->size) +
                     " components, or is not of floats; 3 or 4 floats are needed");
}

void require_polygons(const HoudiniGeometry& geometry, const std::string& name)
{
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i)
        if (geometry.primitives[i].type != PrimitiveType::polygon)
            refuse(name, "primitive " + std::to_string(i) +
                             " is a tetrahedron; a surface is of polygons only");
}

} // namespace

ReadResult polygon_mesh(const ReadGeometry& read, const std::string& name,
                        const ReadOptions& options)
{
    const HoudiniGeometry& geometry = read.geometry;
    require_polygons(geometry, name);
    FileScan scan;
    scan.format = name_of(read.format);
    scan.file_vertices = geometry.points;
    PolygonSoup soup;
    Coordinates coordinates;
    if (options.recentre || options.rescale) {
        Coordinates looked = Coordinates::first_look();
        positions_of(geometry, name, looked);
        coordinates = Coordinates(placement_for(looked.box(), options.recentre, options.rescale));
    }
    soup.points = positions_of(geometry, name, coordinates);
    std::size_t vertex = 0;
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i) {
        const Primitive& primitive = geometry.primitives[i];
        const auto first = geometry.vertex_point.begin() + static_cast<std::ptrdiff_t>(vertex);
        Corners corners(first, first + static_cast<std::ptrdiff_t>(primitive.vertices));
        // The first corner stays the first, so that fans keep their apex.
        std::reverse(corners.begin() + 1, corners.end());
        if (count_face(scan, corners))
            soup.faces.push_back(std::move(corners));
        vertex += primitive.vertices;
    }
    if (scan.file_faces == 0)
        refuse(name, "it has no faces (and " + std::to_string(scan.file_vertices) + " vertices)");
    ReadResult result = mesh_of_soup(name, scan, std::move(soup), options);
    result.report.placement = coordinates.placement();
    result.report.largest_rounding = coordinates.largest_rounding();
    return result;
}

ReadResult read_polygon_mesh(const std::filesystem::path& path, const ReadOptions& options)
{
    return polygon_mesh(read_geometry(path), path.string(), options);
}

} // namespace vdb_shell::houdini

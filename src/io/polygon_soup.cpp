// SPDX-License-Identifier: Apache-2.0

// The way into a mesh for readers outside this library, which parse a format by themselves.
// Polygons take the steps of the built-in formats, with the same tests, the same single rounding
// and the same report. Points come in doubles, because an origin has to be subtracted before
// rounding. Where an origin is wanted the points are gone through twice, and what the first time
// makes is thrown away: only the box of it counts.

#include "vdb_shell/io/polygon_soup.h"

#include "io/file_scan.h"
#include "vdb_shell/core/error.h"

#include <cstddef>
#include <numeric>

namespace vdb_shell
{
namespace
{

std::vector<openvdb::Vec3s> rounded_points(const PolygonSoup& soup, const std::string& name,
                                           Coordinates& coordinates)
{
    std::vector<openvdb::Vec3s> points(soup.points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            points[i][axis] =
                coordinates.from_number(name, {"point", i}, soup.points[i][axis], axis);
    return points;
}

/// An origin or a unit is chosen by the box of all points, so the points are gone through once
/// before any of them is rounded for the mesh.
Coordinates placed_coordinates(const PolygonSoup& soup, const std::string& name,
                               const ReadOptions& options)
{
    if (!options.recentre && !options.rescale)
        return Coordinates();
    Coordinates looked = Coordinates::first_look();
    rounded_points(soup, name, looked);
    return Coordinates(placement_for(looked.box(), options.recentre, options.rescale));
}

/// Checks the corners as the scans of files do, so that nothing after this need look again.
void add_polygons(const PolygonSoup& soup, const std::string& name, FileScan& scan)
{
    auto corner = soup.corners.begin();
    Polygon polygon;
    for (std::size_t face = 0; face < soup.polygon_sizes.size(); ++face) {
        polygon.assign(corner, corner + soup.polygon_sizes[face]);
        corner += soup.polygon_sizes[face];
        for (const std::uint32_t index : polygon)
            require_corner(name, {"face", face}, index, soup.points.size(), std::to_string(index));
        add_face(scan, polygon);
    }
}

} // namespace

FileScan scan_of_polygons(const PolygonSoup& soup, const std::string& name,
                          Coordinates& coordinates)
{
    const std::size_t corners =
        std::accumulate(soup.polygon_sizes.begin(), soup.polygon_sizes.end(), std::size_t(0));
    if (corners != soup.corners.size())
        throw InvalidOption(name + ": the polygons' sizes add up to " + std::to_string(corners) +
                            ", but there are " + std::to_string(soup.corners.size()) + " corners");
    if (!soup.ids.empty() && soup.ids.size() != soup.points.size())
        throw InvalidOption(name + ": there are " + std::to_string(soup.ids.size()) + " ids of " +
                            std::to_string(soup.points.size()) + " points");
    FileScan scan;
    scan.format = soup.format;
    scan.file_vertices = soup.points.size();
    scan.points = rounded_points(soup, name, coordinates);
    scan.ids = soup.ids;
    add_polygons(soup, name, scan);
    return scan;
}

ReadResult mesh_of_polygons(const PolygonSoup& soup, const std::string& name,
                            const ReadOptions& options)
{
    Coordinates coordinates = placed_coordinates(soup, name, options);
    FileScan scan = scan_of_polygons(soup, name, coordinates);
    return mesh_of_scan(name, std::move(scan), coordinates, options);
}

} // namespace vdb_shell

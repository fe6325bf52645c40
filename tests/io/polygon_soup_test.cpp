// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/io/polygon_soup.h"

#include "support/mesh_files.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <gtest/gtest.h>

#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

PolygonSoup cube_soup(const Vec3d& corner, double size)
{
    PolygonSoup soup;
    soup.format = "a format of one's own";
    for (int i = 0; i < 8; ++i)
        soup.points.push_back(corner + size * Vec3d(i & 1, i >> 1 & 1, i >> 2));
    soup.corners = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    soup.polygon_sizes.assign(6, 4);
    return soup;
}

TEST(PolygonSoup, becomes_a_mesh_as_files_do)
{
    const ReadResult result = mesh_of_polygons(cube_soup({0, 0, 0}, 2), "cube");
    EXPECT_EQ(result.report.format, "a format of one's own");
    EXPECT_EQ(result.report.file_vertices, 8U);
    EXPECT_EQ(result.report.file_faces, 6U);
    EXPECT_EQ(result.report.polygons_triangulated, 6U);
    EXPECT_EQ(result.mesh.triangles.size(), 12U);
    EXPECT_DOUBLE_EQ(check_mesh(result.mesh).volume, 8.0);

    // Far away the cube would be flat in float32; about an origin of its own it is not.
    ReadOptions options;
    options.recentre = true;
    const ReadResult far = mesh_of_polygons(cube_soup({1e9, 0, 0}, 0.5), "cube", options);
    EXPECT_DOUBLE_EQ(check_mesh(far.mesh).volume, 0.125);
    EXPECT_NE(far.report.placement.origin[0], 0.0);
}

TEST(PolygonSoup, that_is_no_surface_is_refused)
{
    const auto complaint = [](const PolygonSoup& soup) -> std::string {
        try {
            mesh_of_polygons(soup, "cube");
        } catch (const ReadError& error) {
            return error.what();
        }
        return "nothing was thrown";
    };
    PolygonSoup soup = cube_soup({0, 0, 0}, 1);
    soup.corners[9] = 8;
    EXPECT_SAYS(complaint(soup),
                "cube: face 2: the vertex index 8 is out of range, the file has 8");
    soup = cube_soup({0, 0, 0}, 1);
    soup.points[3][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_SAYS(complaint(soup), "cube: point 3: the coordinate");
    EXPECT_SAYS(complaint(cube_soup({0, 0, 0}, 0)), "none of its 6 faces");
    EXPECT_SAYS(complaint({}), "no faces");
    soup = cube_soup({0, 0, 0}, 1);
    soup.corners.pop_back();
    EXPECT_THROW(mesh_of_polygons(soup, "cube"), InvalidOption);
    soup = cube_soup({0, 0, 0}, 1);
    soup.ids.assign(7, 1);
    EXPECT_THROW(mesh_of_polygons(soup, "cube"), InvalidOption);
}

} // namespace
} // namespace vdb_shell

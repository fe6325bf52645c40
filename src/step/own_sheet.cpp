// SPDX-License-Identifier: Apache-2.0
// For each vertex, the slope that the distance to the surface has along its line as long as nothing
// is nearer than the vertex's own triangles. The triangles are taken as infinite sectors from the
// vertex. They form a cone, and distances in a cone grow in proportion to the length of the line;
// so the slope is the distance of the unit vector from the cone. It comes from the mesh alone and
// is free of the field's interpolation. docs/measurements/symmetry_lines.md has the reasons and the
// limits of the stop test that uses it.

#include "core/parallel.h"
#include "mesh/topology.h"
#include "vdb_shell/step/line_step.h"

#include <algorithm>
#include <cassert>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

/// Distance from a unit vector to the half line along `edge`. Where the two are at a right angle or
/// more, the nearest point is the apex, at distance 1.
double distance_to_ray(const Vec3d& d, const Vec3d& edge)
{
    return d.dot(edge) > 0 ? d.cross(edge.unit()).length() : 1.0;
}

/// Signed distance from d to the infinite sector between two edges of a triangle at the origin,
/// which is seen counter-clockwise from outside: negative where the foot lies inside the sector
/// and d in front of it.
double distance_to_sector(const Vec3d& d, const Vec3d& first, const Vec3d& second)
{
    const Vec3d normal = first.cross(second).unit();
    const double depth = -normal.dot(d);
    const Vec3d foot = d + depth * normal;
    if (first.cross(foot).dot(normal) >= 0 && foot.cross(second).dot(normal) >= 0)
        return depth;
    return std::min(distance_to_ray(d, first), distance_to_ray(d, second));
}

} // namespace

std::vector<double> own_sheet_slopes(const TriangleMesh& mesh, const Directions& directions)
{
    assert(directions.inward.size() == mesh.points.size());
    const VertexTriangles around = triangles_around_vertices(mesh.points.size(), mesh.triangles);
    std::vector<double> slopes(mesh.points.size(), 0.0);
    for_each_index(slopes.size(), [&](std::size_t v) {
        const Vec3d& d = directions.inward[v];
        if (d.lengthSqr() == 0)
            return;
        const Vec3d apex(mesh.points[v]);
        // The apex is in all sectors and at distance 1 from the end of the unit vector, so no slope
        // exceeds 1.
        double nearest = 1;
        for (const std::uint32_t t : around.around(v)) {
            const auto& corners = mesh.triangles[t];
            int i = 0;
            while (corners[i] != v)
                ++i;
            const Vec3d first = Vec3d(mesh.points[corners[(i + 1) % 3]]) - apex;
            const Vec3d second = Vec3d(mesh.points[corners[(i + 2) % 3]]) - apex;
            if (first.cross(second).lengthSqr() > 0)
                nearest = std::min(nearest, distance_to_sector(d, first, second));
        }
        slopes[v] = nearest;
    });
    return slopes;
}

} // namespace vdb_shell

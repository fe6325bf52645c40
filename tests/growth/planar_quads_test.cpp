// SPDX-License-Identifier: Apache-2.0
#include "growth/planar_quads.h"

#include "growth/initialise.h"
#include "support/shapes.h"
#include "vdb_shell/mesh/normals.h"
#include "vdb_shell/step/directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using namespace vdb_shell::growth;
using openvdb::Vec3d;

/// A surface with the directions that growth would start with.
struct Start {
    TriangleMesh mesh;
    Connectivity connectivity;
    GrowState state;
    Directions directions;
    std::vector<double> half;

    explicit Start(const TriangleMesh& of)
        : mesh(of), connectivity(connect(mesh.points.size(), mesh.triangles)),
          state(make_state(
              connectivity, mesh.points,
              std::vector<double>(mesh.points.size(), std::numeric_limits<double>::infinity()))),
          directions(directions_along(mesh, pseudo_normals(mesh))),
          half(half_rays(state, directions))
    {
    }
};

/// The most bent quad below the surface's edges, 1 where a tet of its prism is flat: six volumes of
/// the tet of its four corners, over twice the area of the face times the pillars' mean depth.
double most_bent_quad(const GrowState& s, const Directions& directions,
                      const std::vector<double>& length)
{
    const auto depth = [&](int v) { return length[v] * std::max(directions.visibility[v], 0.1); };
    double most = 0;
    for (const openvdb::Vec3I& face : s.mesh->faces) {
        const double twice_area =
            (s.a[face[1]] - s.a[face[0]]).cross(s.a[face[2]] - s.a[face[0]]).length();
        for (int k = 0; k < 3; ++k) {
            const auto p = int(face[k]), q = int(face[(k + 1) % 3]);
            const Vec3d first = length[p] * directions.inward[p],
                        second = length[q] * directions.inward[q];
            most = std::max(most, std::abs(first.cross(second).dot(s.a[q] - s.a[p])) /
                                      (twice_area * std::sqrt(depth(p) * depth(q))));
        }
    }
    return most;
}

// Fans of needles over a whole plate, and a band of short edges around it.
TEST(PlanarQuads, AreFoundOnAPlateOfNeedles)
{
    for (const int points : {9, 19, 31}) {
        const Start start(test::needled_plate(points));
        EXPECT_GT(most_bent_quad(start.state, start.directions, start.half), 1) << points;
        const Directions planar = with_planar_quads(start.state, start.directions, start.half);
        // No tet of any prism is flat or turned over for that.
        EXPECT_LT(most_bent_quad(start.state, planar, start.half), 1) << points;
        for (std::size_t v = 0; v < planar.inward.size(); ++v) {
            EXPECT_NEAR(planar.inward[v].length(), 1, 1e-12);
            EXPECT_GT(planar.visibility[v], 0);
        }
    }
}

// Along mitres the inner surface of a cube is parallel, and each quad planar, those below diagonals
// too.
TEST(PlanarQuads, LeaveMitresAsTheyAre)
{
    const Start cube(test::box({0, 0, 0}, {1, 1, 1}));
    Directions mitres = cube.directions;
    for (std::size_t v = 0; v < mitres.inward.size(); ++v) {
        const Vec3d p(cube.mesh.points[v]);
        for (int k = 0; k < 3; ++k)
            mitres.inward[v][k] = (p[k] > 0 ? -1 : 1) / std::sqrt(3.0);
        mitres.visibility[v] = 1 / std::sqrt(3.0);
    }
    EXPECT_LT(most_bent_quad(cube.state, mitres, cube.half), 1e-12);
    const Directions planar = with_planar_quads(cube.state, mitres, cube.half);
    for (std::size_t v = 0; v < mitres.inward.size(); ++v)
        EXPECT_LT((planar.inward[v] - mitres.inward[v]).length(), 1e-9);
}

TEST(PlanarQuads, LeaveWhatSeesNothing)
{
    Start start(test::needled_plate(9));
    start.directions.visibility[5] = 0;
    start.directions.inward[5] = Vec3d(0.0);
    const Directions planar = with_planar_quads(start.state, start.directions, start.half);
    EXPECT_EQ(planar.inward[5], Vec3d(0.0));
    EXPECT_EQ(planar.visibility[5], 0);
}

} // namespace
} // namespace vdb_shell

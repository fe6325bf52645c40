// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

// Surfaces whose volume, distances and medial axis are known; closed, outward, unless said
// otherwise.

namespace vdb_shell::test
{

TriangleMesh unit_tetrahedron();                                         ///< corners 0, x, y, z
TriangleMesh box(const openvdb::Vec3d& low, const openvdb::Vec3d& high); ///< 8 points, 12 triangles
TriangleMesh icosphere(double radius,
                       int subdivisions); ///< 20 * 4^n triangles, vertices on the sphere
TriangleMesh torus(double major, double minor, int around, int across);
/// A box whose faces are split into n x n quads (2 triangles each): flat vertices as well as
/// corners.
TriangleMesh gridded_box(const openvdb::Vec3d& low, const openvdb::Vec3d& high, int n);
/// A convex polygon (x, y counter-clockwise) pulled along z in rows of vertices at the heights
/// given, which rise: row r, corner i is vertex r * n + i; then the middles of the two ends.
TriangleMesh extruded(const std::vector<openvdb::Vec2d>& polygon,
                      const std::vector<double>& heights);

/// A cube of edge 2 without the eighth farthest from the origin, with no more triangles than that
/// needs. The notch begins next to the middle, so that two of them are nearly flat.
TriangleMesh notched_cube();
/// A plate of 100 x 100 x 3 with rounded corners of so many points each, whose flat faces are cut
/// as modellers cut them: from each corner's points needles reach to the next corner.
TriangleMesh needled_plate(int points_per_corner);
TriangleMesh translated(TriangleMesh mesh, const openvdb::Vec3d& by);
/// Turned about an axis through the origin.
TriangleMesh turned(TriangleMesh mesh, const openvdb::Vec3d& axis, double angle_radians);
TriangleMesh reversed(TriangleMesh mesh); ///< every triangle turned round
TriangleMesh joined(TriangleMesh first, const TriangleMesh& second);    ///< both, not welded
TriangleMesh without_triangle(TriangleMesh mesh, std::size_t triangle); ///< an open surface

} // namespace vdb_shell::test

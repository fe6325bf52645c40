// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/polygon_mesh.h"

namespace vdb_shell::samples
{

/// Radius 1 about the origin: quads between circles of latitude, triangles at the poles (+-y).
PolygonMesh sphere(int around, int down);

/// [-1,1] x [-0.6,0.6] x [-0.4,0.4], each face an n x n grid of quads.
PolygonMesh box(int n);

/// Radii 1 and 0.35 about the y axis, all quads.
PolygonMesh torus(int around, int across);

/// An L of sheet 0.2 thick, legs 1.6 (x) and 1.2 (y), 1 wide (z), with a rounded inner edge and a
/// hole of radius 0.28 through the lower leg. Triangulated as CAD programs export: no vertex that a
/// straight edge or a circle does not ask for, hence fans of long thin triangles.
PolygonMesh bracket(int hole_sides, int fillet_sides);

} // namespace vdb_shell::samples

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/repair/repair_mesh.h"

#include <openvdb/Types.h>

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace vdb_shell::repair
{

/// A rim with what fairness needs to know of the surface around it. Indices count along the rim.
struct Rim {
    std::vector<openvdb::Vec3d> points;
    std::vector<openvdb::Vec3d> beyond; ///< by edge i -> i+1: third corner of the triangle outside
    std::vector<std::vector<openvdb::Vec3d>> neighbours; ///< by point: off the rim
    std::vector<double> spacing; ///< by point: mean length of its edges in the surface
    /// Pairs (smaller first) that are edges of the surface already, those of the rim aside.
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
};

/// A fill: the rim's points, then new ones. Triangles run through each rim edge i -> i+1 that way.
struct Patch {
    std::vector<openvdb::Vec3d> points;
    std::vector<openvdb::Vec3I> triangles;
};

/// The best triangulation of the rim without new points (Barequet and Sharir 1995, Liepa 2003): by
/// the largest dihedral angle, then area, or by area alone. Time grows with the cube of the rim. No
/// triangles when every one needs an edge that exists already.
Patch triangulate_rim(const Rim& rim, bool by_dihedral);

/// Up to here triangulate_rim takes a second or two.
inline constexpr std::size_t kLongestOptimalRim = 1000;

/// A triangulation of a rim of any length without new points: always the corner with the smallest
/// angle whose triangle is empty is cut off, seen along the rim's mean normal. Nothing is best
/// about it, and it may fold where the rim does. No triangles when every corner left needs an edge
/// that exists already.
Patch cut_rim_ears(const Rim& rim);

/// Adds points until edges inside are as long as those around the rim (Liepa 2003), and turns edges
/// towards a Delaunay triangulation.
void refine(Patch& patch, const Rim& rim);

/// Moves the new points: each to the mean of its neighbours, or (`smooth`) so that the sum of
/// squared Laplacians, those of the rim's points included, is least.
void fair(Patch& patch, const Rim& rim, bool smooth);

/// Whether the rim lies in a plane, to a thousandth of its length.
bool is_planar(const Rim& rim);

} // namespace vdb_shell::repair

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <vector>

namespace vdb_shell
{

/// A triangle surface. Points are float32, as OpenVDB and Houdini store them: what is computed and
/// certified is what is written. Triangles are counter-clockwise seen from outside
/// (docs/conventions.md).
struct TriangleMesh {
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec3I> triangles; ///< 0-based indices into points
};

/// Corners of the tight axis-aligned box. Precondition: at least one point.
struct Bounds {
    openvdb::Vec3d low{0.0};
    openvdb::Vec3d high{0.0};
};
Bounds bounds_of(const std::vector<openvdb::Vec3s>& points);

/// Length of the diagonal of the bounding box, in world units.
double diagonal_of(const Bounds& bounds);

/// Volume enclosed by the surface: positive when a closed mesh is oriented outward. Summed in index
/// order relative to the centre of the bounding box, so it is reproducible and accurate far from
/// the origin.
double signed_volume(const std::vector<openvdb::Vec3s>& points,
                     const std::vector<openvdb::Vec3I>& triangles);

} // namespace vdb_shell

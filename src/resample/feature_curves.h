// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A chain of feature edges from corner to corner, or round to its own beginning.
struct FeatureCurve {
    std::vector<std::uint32_t> vertices; ///< of the surface, in order; a closed one ends with the
                                         ///< vertex that it begins with
    std::vector<openvdb::Vec3d> points;  ///< theirs
    std::vector<double> at;              ///< theirs: length along the curve, from 0, world units
    bool closed = false;

    double length() const { return at.back(); }
    /// The point at that length; of a closed curve any number of times round.
    openvdb::Vec3d point_at(double s) const;
    /// How far the vertices strictly between the two lengths are from the segment between the two
    /// points. Precondition: from < to.
    double distance_from(double from, double to, const openvdb::Vec3d& first,
                         const openvdb::Vec3d& last) const;
};

struct FeatureCurves {
    std::vector<FeatureCurve> curves;
    std::vector<std::uint8_t> corner; ///< by vertex: it stays where it is
    std::size_t edges = 0;            ///< feature edges
    std::size_t corners = 0;
};

/// The edges at which the normals of the two triangles are apart by more than `angle_radians`, as
/// curves. Corners are the vertices where not exactly two of them meet, or where these two turn by
/// more than that angle. Curves shorter than `least_length` (world units) of which an end meets no
/// other feature do not count: on coarse and on scanned surfaces they come by the hundred, and are
/// no shape of the object. Precondition: closed, manifold.
FeatureCurves find_features(const TriangleMesh& mesh, double angle_radians, double least_length);

} // namespace vdb_shell

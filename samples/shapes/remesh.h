// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shapes/polygon_mesh.h"

#include <functional>

namespace vdb_shell::samples
{

/// Negative inside; smooth near its zero.
using Field = std::function<double(const openvdb::Vec3d&)>;

struct RemeshOptions {
    double shortest_edge = 0.027;
    double longest_edge = 0.1;
    /// Largest distance aimed at between an edge's middle and the surface.
    double sagitta = 0.005;
    int rounds = 8;
};

/// Rebuilds a closed triangle surface of the field's zero with edges as short as its curvature asks
/// for. Based on: Botsch and Kobbelt, "A remeshing approach to multiresolution modeling", 2004
/// (split, collapse, flip, relax); edge lengths from Dunyach et al., "Adaptive remeshing for
/// real-time mesh deformation", 2013.
PolygonMesh remesh(const PolygonMesh& triangles, const Field& field, const RemeshOptions& options);

} // namespace vdb_shell::samples

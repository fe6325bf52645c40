// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

enum class DirectionSource {
    pseudo_normal, ///< angle-weighted pseudo-normal of the mesh, [15] of the paper
    gradient,      ///< the field's own gradient at the vertex, eq. 5
};
const NameTable<DirectionSource>& names(DirectionSource);

struct DirectionOptions {
    DirectionSource source = DirectionSource::pseudo_normal;
    /// Tilts each direction by a random tangential amount of at most this angle, against alignment
    /// with a symmetry line (the paper, section 2). 0: none.
    double perturbation_radians = 0.0;
    std::uint64_t seed = 1;
};
OptionList describe(DirectionOptions& options);

/// Per vertex, index for index with the mesh's points.
struct Directions {
    std::vector<openvdb::Vec3d> inward; ///< unit length; zero where none could be found
    /// Smallest cosine between -inward and the normals of the incident triangles. Not positive: the
    /// direction leaves some incident triangle on its outer side, and its prism inverts at any
    /// length.
    std::vector<double> visibility;
};

/// Against `outward`, one unit vector (or zero) for each point of the mesh.
Directions directions_along(const TriangleMesh& mesh, std::vector<openvdb::Vec3d> outward);

/// Directions of the extrusion lines. The level set is read only for DirectionSource::gradient.
/// The same seed gives the same directions, whatever the number of threads. Throws InvalidOption
/// when an option is out of its range.
Directions compute_directions(const TriangleMesh& mesh, const openvdb::FloatGrid& level_set,
                              const DirectionOptions& options);

} // namespace vdb_shell

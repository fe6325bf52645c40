// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/grid_types.h"
#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

#include <cstddef>

namespace vdb_shell
{

struct ContourOptions {
    /// How far simplification may move the surface, in voxels. 0 keeps every facet.
    double adaptivity = 0.25;
    /// Leave out the surfaces of voids, and what stands inside them.
    bool outer_only = false;
};
OptionList describe(ContourOptions& options);

/// What made the surface. `marching_tets` when OpenVDB's own surface was not manifold or not
/// embedded.
enum class ContourMethod { volume_to_mesh, marching_tets };
const NameTable<ContourMethod>& names(ContourMethod);

struct ContourReport {
    ContourMethod method = ContourMethod::volume_to_mesh;
    /// Non-manifold edges and vertices and self-intersections of OpenVDB's surface.
    std::size_t volume_to_mesh_defects = 0;
    std::size_t triangles = 0;            ///< before simplification
    std::size_t simplified_triangles = 0; ///< after it
    std::size_t components = 0;
    std::size_t dropped_components = 0; ///< voids and what was in them, with `outer_only`
    /// Simplifications that touched themselves and were done anew with more vertices held.
    int simplification_repeats = 0;
};

/// The zero surface of a field whose values are negative inside: closed, manifold and embedded by
/// check_mesh's exact tests, oriented outward. First by OpenVDB's volume to mesh; where the tests
/// object to that, by tetrahedra of the grid (Kuhn's six a cube), whose surface is all three by
/// construction; then edges are collapsed within `adaptivity`, and whatever the tests object to is
/// undone. Any invertible transform that is linear. Same result for any number of threads.
/// Preconditions: finite values; every change of sign has all voxels around it active or at their
/// right sign. Throws GeometryError when nothing is inside, when the surface leaves the active
/// voxels (it is open then), or when float32 cannot hold a voxel's parts at these coordinates;
/// InvalidOption for an adaptivity that is negative or not finite; Cancelled.
TriangleMesh contour(const openvdb::FloatGrid& field, const ContourOptions& options = {},
                     ContourReport* report = nullptr, Interrupter* interrupter = nullptr);

} // namespace vdb_shell

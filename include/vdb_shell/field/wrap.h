// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"
#include "vdb_shell/resample/surface_distance.h"

#include <cstddef>
#include <optional>

namespace vdb_shell
{

struct WrapOptions {
    /// Build the shell of a wrap instead of the mesh itself.
    bool wanted = false;
    /// Edge length of a voxel of the wrap's field, world units. Unset: from `resolution`.
    std::optional<double> voxel_size;
    /// Voxels along the longest side of the bounding box. Unset: as many as make a voxel as long
    /// as the triangles' edges are in the mean, but no fewer than 128 and no more than 256.
    std::optional<int> resolution;
    /// How far the surface may be moved for the sake of fewer triangles, in voxels.
    double adaptivity = 0.5;
    /// Half the thickness that sheets are given, in voxels, at least 0.9: with less a sheet could
    /// slip between the voxels.
    double sheet_voxels = 1.0;
    /// Keep enclosed voids, and what stands in them, instead of filling them.
    bool keep_voids = false;
};
OptionList describe(WrapOptions& options);

struct WrapReport {
    double voxel_size = 0;
    std::size_t voxels = 0;        ///< where the field was computed
    std::size_t filled_voxels = 0; ///< of these, in enclosed voids that were made solid
    /// Shares of the input's area: boundary of the solid, sheets that were given a thickness, and
    /// what lies inside the solid.
    double boundary_share = 0, sheet_share = 0, interior_share = 0;
    ContourReport contour;
    DistanceFigures input_to_wrap, wrap_to_input;
};

struct WrapResult {
    TriangleMesh mesh;
    WrapReport report;
};

/// Edge length of a voxel of the mesh's wrap, world units. Throws as wrap_mesh. Precondition: the
/// mesh has points, and its triangles' corners are among them.
double wrap_voxel_size(const TriangleMesh& mesh, const WrapOptions& options);

/// A new surface around anything that has triangles: closed, manifold, embedded (contour.h says
/// why) and oriented outward. The solid is where the winding number of the triangles, in either
/// sense, is over 0.6, together with all points within `sheet_voxels` of triangles that bound no
/// such solid, or one thinner than 1.5 voxels: sheets, loose triangles, patches turned the wrong
/// way. Gaps are closed by the surface where the winding number has that value. Features smaller
/// than a voxel are lost. docs/stages/wrap.md tells what to expect. Throws InvalidOption for
/// options out of range, points that are not finite and corners that are none of them;
/// GeometryError for a mesh without triangles or without extent, or when
/// float32 cannot hold the voxels at the mesh's coordinates, Cancelled. Same result for any number
/// of threads.
WrapResult wrap_mesh(const TriangleMesh& mesh, const WrapOptions& options,
                     Interrupter* interrupter = nullptr);

} // namespace vdb_shell

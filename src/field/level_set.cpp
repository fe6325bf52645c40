// SPDX-License-Identifier: Apache-2.0
// The dense route to the field: OpenVDB's mesh-to-volume (K. Museth, "VDB: High-Resolution Sparse
// Volumes with Dynamic Topology", 2013) with the inside active as deep as lines may go, in world
// units and negative inside. All that could make it fail is looked at first, because a conversion
// that runs out of memory may end the process without a message. The order of the tests matters:
// the memory is estimated last, from sizes that are known to be sound. field/narrow_band.cpp is the
// route that is usually taken, without the dense inside.

#include "vdb_shell/field/level_set.h"

#include "core/available_memory.h"
#include "core/fail.h"
#include "core/stage_progress.h"
#include "field/cavities.h"
#include "field/level_set_checks.h"
#include "field/map_values.h"
#include "field/mesh_distances.h"
#include "field/value_range.h"
#include "mesh/triangle_area.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

// The stencil of a point that is at most `interior_depth` deep reads voxels up to a cell diagonal
// and the one voxel of the central difference away, 1.73 + 1 voxels.
constexpr double kStencilVoxels = 3.0;
// With less, the stencil of a vertex on the surface would reach beyond the band.
constexpr double kSmallestExteriorVoxels = 3.0;
constexpr double kLargestExteriorVoxels = 1e4;
// With fewer voxels along its longest side an object has no field that lines could step through.
constexpr double kFewestVoxels = 8.0;

double longest_side(const Bounds& bounds)
{
    const Vec3d size = bounds.high - bounds.low;
    return std::max({size[0], size[1], size[2]});
}

struct BandVoxels {
    double exterior, interior;
};

BandVoxels band_of(const TriangleMesh& mesh, double voxel, const LevelSetOptions& options)
{
    const double deepest = 0.5 * diagonal_of(bounds_of(mesh.points));
    const double depth = std::min(options.interior_depth.value_or(deepest), deepest);
    const double exterior =
        options.exterior_depth
            ? std::max(options.exterior_voxels, *options.exterior_depth / voxel + kStencilVoxels)
            : options.exterior_voxels;
    return {exterior, depth / voxel + kStencilVoxels};
}

void check_mesh_and_options(const TriangleMesh& mesh, const LevelSetOptions& options)
{
    if (mesh.points.empty() || mesh.triangles.empty())
        fail<GeometryError>("level set: the mesh has ", mesh.points.size(), " points and ",
                            mesh.triangles.size(), " triangles");
    require_in_range(options, "level set");
}

void check_voxel_size(const TriangleMesh& mesh, double voxel)
{
    const Bounds bounds = bounds_of(mesh.points);
    const double size = longest_side(bounds);
    if (voxel >= size)
        fail<GeometryError>("level set: voxel larger than the object: voxel size ", voxel,
                            ", longest side ", size);
    if (voxel < kSmallestVoxelSize)
        fail<GeometryError>(
            "voxel size ", voxel, " is below ", kSmallestVoxelSize,
            ", the smallest that OpenVDB's transforms can hold; --rescale reads the mesh in "
            "a unit of its own size");
    for (int axis = 0; axis < 3; ++axis) {
        const double far = std::max(std::abs(bounds.low[axis]), std::abs(bounds.high[axis]));
        if (far / voxel > kLargestVoxelIndex)
            fail<GeometryError>(
                "voxel size ", voxel, " is too small for coordinates up to ", far, ": voxel index ",
                far / voxel, " is over the limit ", kLargestVoxelIndex,
                "; --recentre reads the mesh about its middle, or enlarge the voxels");
    }
}

void check_memory(const TriangleMesh& mesh, double voxel, const LevelSetOptions& options)
{
    const double estimate = estimate_level_set_bytes(mesh, voxel, options);
    const double limit =
        options.max_memory_gib ? *options.max_memory_gib * kBytesPerGib : available_memory();
    if (!(estimate <= limit))
        fail<GeometryError>("level set: voxel size ", voxel, " needs an estimated ",
                            estimate / kBytesPerGib, " GiB, over the limit of ",
                            limit / kBytesPerGib,
                            " GiB; enlarge the voxels or bound the depth of the band, ",
                            band_of(mesh, voxel, options).exterior,
                            " voxels outside (--exterior-depth, --thickness)");
}

openvdb::FloatGrid::Ptr convert(const TriangleMesh& mesh, const openvdb::math::Transform& transform,
                                const BandVoxels& band, Interrupter* interrupter)
{
    return signed_distances(mesh, transform, band.exterior, band.interior, interrupter);
}

/// The depth of the solid so far in voxels, and one voxel more, so that a cavity's inactive
/// background is beyond every value of the solid.
double deepest_voxels(const openvdb::FloatGrid& grid)
{
    return 1.0 - value_range(grid).least / grid.voxelSize()[0];
}

/// OpenVDB's flood fill takes everything inside the outermost surface for solid, so what stands
/// inside a cavity's surface is converted on its own and taken out, or put back.
openvdb::FloatGrid::Ptr convert_nested(const TriangleMesh& mesh,
                                       const openvdb::math::Transform& transform,
                                       const BandVoxels& band, Interrupter* interrupter)
{
    const std::vector<TriangleMesh> parts = split_by_nesting(mesh, interrupter);
    auto grid = convert(parts.front(), transform, band, interrupter);
    constexpr double kAllOfIt = std::numeric_limits<float>::max();
    for (std::size_t depth = 1; depth < parts.size(); ++depth) {
        const bool is_cavity = depth % 2 == 1;
        // Outside, a cavity's grid has to reach as deep as the solid so far, since its background
        // would cut off the depth of the solid otherwise. Inside it has to be active everywhere,
        // since only active voxels are taken out of the solid.
        const BandVoxels part_band = is_cavity ? BandVoxels{deepest_voxels(*grid), kAllOfIt}
                                               : BandVoxels{band.exterior, band.interior};
        const auto part = convert(parts[depth], transform, part_band, interrupter);
        if (is_cavity)
            subtract_cavity(*grid, *part);
        else
            add_solid(*grid, *part);
    }
    return grid;
}

} // namespace

OptionList describe(LevelSetOptions& o)
{
    return in_group(
        "Level set",
        {option("voxel_size", o.voxel_size, "--voxel-size", "Edge length of a voxel, world units")
             .in(Unit::world_length)
             .within(above(0)),
         option("resolution", o.resolution, "--resolution",
                "Voxels along the longest side of the bounding box")
             .in(Unit::voxels)
             .within(at_least(1))
             .excluding("--voxel-size"),
         option("exterior_voxels", o.exterior_voxels, "--exterior-voxels",
                "Width of the band outside the surface")
             .in(Unit::voxels)
             .within(at_least(kSmallestExteriorVoxels).at_most(kLargestExteriorVoxels)),
         option("exterior_depth", o.exterior_depth, "--exterior-depth",
                "Depth of the band outside, world units [outward: the thickness]")
             .in(Unit::world_length)
             .within(above(0)),
         option("interior_depth", o.interior_depth, "--interior-depth",
                "Depth of the band inside, world units [the thickness, else half the diagonal]")
             .in(Unit::world_length)
             .within(above(0)),
         option("max_memory_gib", o.max_memory_gib, "--max-memory",
                "Refuse a level set that would need more GiB than this [what is free]")
             .in(Unit::gibibytes)
             .within(above(0))
             .not_stored()});
}

double resolve_voxel_size(const TriangleMesh& mesh, const LevelSetOptions& options)
{
    require_in_range(options, "level set");
    if (options.voxel_size)
        return *options.voxel_size;
    if (mesh.points.empty())
        fail<GeometryError>("level set: the mesh has no points");
    const double size = longest_side(bounds_of(mesh.points));
    if (!(std::isfinite(size) && size > 0))
        fail<GeometryError>("level set: the mesh's longest side is ", size,
                            ", must be positive and finite to derive a voxel size from");
    // Objects of less than a few millimetres get fewer voxels than the options say, rather than
    // none.
    return std::max(size / options.resolution, std::min(kSmallestVoxelSize, size / kFewestVoxels));
}

double estimate_level_set_bytes(const TriangleMesh& mesh, double voxel_size,
                                const LevelSetOptions& options)
{
    const BandVoxels band = band_of(mesh, voxel_size, options);
    const double area = surface_area(mesh.points, mesh.triangles) / (voxel_size * voxel_size);
    const double solid =
        std::abs(signed_volume(mesh.points, mesh.triangles)) / std::pow(voxel_size, 3);
    // A sheet of w voxels meets the 8^3 leaves within w + 8 (|nx| + |ny| + |nz|) voxels, 1.5 on
    // average; half of that on either side.
    constexpr double kLeafReach = 6.0;
    const double inside = std::min(area * band.interior, solid) + area * kLeafReach;
    const Bounds bounds = bounds_of(mesh.points);
    double box = 1, sides = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double side = (bounds.high[axis] - bounds.low[axis]) / voxel_size;
        sides += side;
        box *= side + 2 * band.exterior + 16;
    }
    // Steiner's formula for the distances around a box: far from a small object the band is a ball,
    // whatever the object's area.
    const double depth = band.exterior;
    const double outside =
        area * (depth + kLeafReach) + M_PI * depth * depth * (sides + 4.0 / 3.0 * depth);
    // Where a surface has many folds, its bands overlap, and the box is the better bound.
    const double voxels = std::min(inside + outside, box);
    // The distance, the index of the nearest triangle and the buffer of the renormalisation take 4
    // bytes each. As much again is for masks, the threads' own trees and what the averages leave
    // out. Measured peaks of the process were between a half and four fifths of the whole estimate.
    constexpr double kBytesPerVoxel = 24.0;
    // For the children of both grids' roots, and for small surfaces, which have more leaves than
    // the averages say.
    constexpr double kFixed = 32.0 * 1024 * 1024;
    return voxels * kBytesPerVoxel + kFixed;
}

double checked_voxel_size(const TriangleMesh& mesh, const LevelSetOptions& options)
{
    check_mesh_and_options(mesh, options);
    const double voxel = resolve_voxel_size(mesh, options);
    check_voxel_size(mesh, voxel);
    check_memory(mesh, voxel, options);
    return voxel;
}

void finish_level_set(openvdb::FloatGrid& grid)
{
    grid.setName("surface");
    grid.setGridClass(openvdb::GRID_LEVEL_SET);
    grid.setIsInWorldSpace(true);
    grid.setCreator("vdb_shell");
}

openvdb::FloatGrid::Ptr mesh_to_level_set(const TriangleMesh& mesh, const LevelSetOptions& options,
                                          Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "level set");
    const double voxel = checked_voxel_size(mesh, options);
    const BandVoxels band = band_of(mesh, voxel, options);
    // Voxel centres at whole multiples of the voxel size, wherever the mesh stands: grids of
    // different objects of a scene then fit voxel on voxel.
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    auto grid = convert_nested(mesh, *transform, band, interrupter);
    finish_level_set(*grid);
    return grid;
}

bool has_inside(const openvdb::FloatGrid& grid)
{
    return value_range(grid).least < 0;
}

void negate_level_set(openvdb::FloatGrid& level_set)
{
    map_values(level_set.tree(), [](float value) { return -value; });
}

} // namespace vdb_shell

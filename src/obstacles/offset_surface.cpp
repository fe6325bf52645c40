// SPDX-License-Identifier: Apache-2.0

// Takes: closed surfaces and a distance. Gives: a surface around them that is at least so far away.
// It is the contour of their level set, whose voxels cut off and round; so what was made is
// measured, and made anew farther out by what was missing, until the measured distance is enough.
// Only that measure counts (docs/theory.md, "Cores"): the level set proposes.

#include "obstacles/offset_surface.h"

#include "core/grid_instances.h"
#include "field/map_values.h"
#include "field/mesh_distances.h"
#include "obstacles/nearest_core.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/field/contour.h"
#include "vdb_shell/field/level_set.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

/// Finer voxels than this along the longest side are not worth their number: with them the surface
/// is farther out than it had to be by a five-hundredth of that side at most.
constexpr double kMostVoxelsAlong = 500;
constexpr double kVoxelsInDistance = 2;
/// The contour is moved out by what is missing, and that changes little else, so two rounds do.
constexpr int kMostRounds = 8;

/// Distances without a sign, as far out as `depth`: a core may be thinner than a voxel, and then no
/// voxel is inside it.
openvdb::FloatGrid::Ptr distances_to(const TriangleMesh& mesh, double voxel, double depth,
                                     Interrupter* interrupter)
{
    return unsigned_distances(mesh, *openvdb::math::Transform::createLinearTransform(voxel),
                              depth / voxel, interrupter);
}

/// The distances less `iso`: negative nearer than that.
openvdb::FloatGrid::Ptr lowered(const openvdb::FloatGrid& field, double iso)
{
    openvdb::FloatGrid::Ptr grid = field.deepCopy();
    const auto by = static_cast<float>(iso);
    map_values(grid->tree(), [by](float value) { return value - by; });
    // Of any other class OpenVDB takes what is positive for the inside.
    grid->setGridClass(openvdb::GRID_LEVEL_SET);
    return grid;
}

/// Throws where the grid would have no room for it.
double voxel_for(const TriangleMesh& mesh, double distance)
{
    const Bounds bounds = bounds_of(mesh.points);
    double side = 0, far = 0;
    for (int k = 0; k < 3; ++k) {
        side = std::max(side, bounds.high[k] - bounds.low[k]);
        far = std::max({far, std::abs(bounds.low[k]), std::abs(bounds.high[k])});
    }
    const double voxel = std::max(distance / kVoxelsInDistance, side / kMostVoxelsAlong);
    if (voxel < kSmallestVoxelSize || far / voxel > kLargestVoxelIndex)
        throw InvalidOption("cores: distance is " + std::to_string(distance) +
                            " (--core-distance), too small for cores of size " +
                            std::to_string(side) + " at coordinates up to " + std::to_string(far) +
                            "; --rescale or --recentre reads them in a frame of their own");
    return voxel;
}

} // namespace

TriangleMesh without_unused_points(const TriangleMesh& mesh)
{
    std::vector<std::uint32_t> number(mesh.points.size(), 0);
    for (const Vec3I& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            number[t[k]] = 1;
    TriangleMesh used;
    for (std::size_t v = 0; v < number.size(); ++v)
        // The mark of a used point makes way for its new number, which is also what an unused one
        // gets, and nobody asks for.
        if (std::exchange(number[v], std::uint32_t(used.points.size())) != 0)
            used.points.push_back(mesh.points[v]);
    for (const Vec3I& t : mesh.triangles)
        used.triangles.emplace_back(number[t[0]], number[t[1]], number[t[2]]);
    return used;
}

TriangleMesh offset_surface(const TriangleMesh& mesh, double distance, Interrupter* interrupter)
{
    const double voxel = voxel_for(mesh, distance);
    ContourOptions contouring;
    // Every point of the mesh has a voxel within the half diagonal of one, so none gets lost. The
    // contour may be moved inward by its adaptivity.
    double iso = std::max(distance + 1.2 * contouring.adaptivity * voxel, voxel);
    // Far enough out for the rounds that follow, and for the contour's own stencil.
    constexpr double kSpareVoxels = 6;
    const auto field = distances_to(mesh, voxel, iso + kSpareVoxels * voxel, interrupter);
    // The surfaces on the inner side of the band, and those of voids where no shell gets to.
    contouring.outer_only = true;
    for (int round = 0; round < kMostRounds; ++round) {
        TriangleMesh around = contour(*lowered(*field, iso), contouring, nullptr, interrupter);
        const double found = least_distance(around, mesh);
        // Measured on the float32 that the shell will be held against, so nothing is left to trust.
        if (found >= distance)
            return without_unused_points(around);
        // A hundredth of a voxel more, or the rounds would only come ever nearer.
        iso += distance - found + 0.01 * voxel;
    }
    throw GeometryError("cores: no surface at the distance " + std::to_string(distance) +
                        " (--core-distance) could be made around them");
}

} // namespace vdb_shell

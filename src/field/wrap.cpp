// SPDX-License-Identifier: Apache-2.0
// A closed surface around any triangles, whatever their faults: open, crossing, turned the wrong
// way. The solid is where the winding number says inside, with plates around all that bounds no
// solid (field/wrap_field.cpp); its contour passes the exact tests (field/contour.cpp). So whatever
// comes in, what leaves is closed, manifold and embedded. All fields are in voxels about the middle
// of the bounding box, which keeps numbers small and spares the transform, since OpenVDB's cannot
// hold tiny voxels. The report measures how far input and wrap are apart, both ways, because
// neither distance bounds the other.

#include "vdb_shell/field/wrap.h"

#include "core/fail.h"
#include "core/stage_progress.h"
#include "field/contour_mapped.h"
#include "field/value_range.h"
#include "field/wrap_field.h"
#include "mesh/equal_points.h"
#include "mesh/surface_defects.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "vdb_shell/resample/remesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

// More than half the diagonal of a voxel, 0.866. So every point of a sheet has a voxel centre
// within this distance, and no sheet passes between the voxels.
constexpr double kThinnestSheet = 0.9;
constexpr double kMostAdaptivityVoxels = 1e3;
// All voxels within that distance of a sheet get a value, so memory grows with its cube: of igl's
// circle at 256 voxels (tuning), 64 take 0.5 GiB and 200 already 4.8. Larger voxels give a plate of
// the same thickness for less.
constexpr double kThickestSheet = 64.0;
// The field takes some ten voxels for each voxel of area, so 4096^2 voxels of area are 170 million
// of them.
constexpr double kMostVoxelsAlong = 4096.0;
// Few triangles say little about what they are of: a gap or a slot between them may be finer than
// their edges. Nor does a wrap that nobody has asked to be fine take minutes.
constexpr double kFewestVoxelsUnasked = 128.0, kMostVoxelsUnasked = 256.0;
constexpr double kDistanceSpacingVoxels = 1.0;
/// The flags under which there may be a wrap.
constexpr const char* kWraps = "--wrap or --mend";

/// A wrap is to show what the triangles show: a voxel as long as their edges does.
double voxels_along(const TriangleMesh& mesh, double longest, const WrapOptions& options)
{
    if (options.resolution)
        return *options.resolution;
    const double edge = triangle_figures(mesh).mean_edge;
    return edge > 0 ? std::clamp(longest / edge, kFewestVoxelsUnasked, kMostVoxelsUnasked)
                    : kFewestVoxelsUnasked;
}

/// The first of those that are the same and turned the same way. A winding number would count each
/// copy, and see a solid far around thousands of them.
std::vector<openvdb::Vec3I> without_repeats(const TriangleMesh& mesh)
{
    const std::vector<std::uint32_t> point = first_equal_point(mesh.points);
    std::set<std::array<std::uint32_t, 3>> known;
    std::vector<openvdb::Vec3I> kept;
    for (const openvdb::Vec3I& t : mesh.triangles) {
        std::array<std::uint32_t, 3> corners{point[t[0]], point[t[1]], point[t[2]]};
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                    corners.end());
        if (known.insert(corners).second)
            kept.push_back(t);
    }
    return kept;
}

/// Triangles in voxels about the middle of the box, so that the numbers are small wherever the mesh
/// stands.
std::vector<TriangleCorners> in_voxels(const TriangleMesh& mesh, const Vec3d& centre, double voxel)
{
    std::vector<TriangleCorners> triangles;
    triangles.reserve(mesh.triangles.size());
    const auto to_voxels = [&](std::uint32_t v) {
        return (Vec3d(mesh.points[v]) - centre) / voxel;
    };
    for (const openvdb::Vec3I& t : without_repeats(mesh))
        triangles.push_back({to_voxels(t[0]), to_voxels(t[1]), to_voxels(t[2])});
    return triangles;
}

void set_shares(WrapReport& report, const WrapPieces& pieces)
{
    const double area = pieces.boundary_area + pieces.sheet_area + pieces.interior_area;
    if (!(area > 0))
        return;
    report.boundary_share = pieces.boundary_area / area;
    report.sheet_share = pieces.sheet_area / area;
    report.interior_share = pieces.interior_area / area;
}

/// `half_size`: of the triangles' box, whose middle is the origin, voxels.
openvdb::FloatGrid::Ptr field_of(const std::vector<TriangleCorners>& triangles,
                                 const Vec3d& half_size, const WrapOptions& options,
                                 WrapReport& report, const StageProgress& progress)
{
    WindingGrid winding(cut_to_sum_up(triangles));
    WrapPieces pieces = sort_pieces(winding, progress);
    auto field = wrap_field(pieces, winding, options.sheet_voxels, half_size, progress);
    // A solid that is smaller than a voxel can slip between the voxel centres. As plates its
    // triangles cannot, so there always is a surface.
    if (!(value_range(*field).least < 0)) {
        pieces = all_sheets(winding.number().triangles());
        field = wrap_field(pieces, winding, options.sheet_voxels, half_size, progress);
    }
    set_shares(report, pieces);
    report.voxels = field->activeVoxelCount();
    // Before there is a surface: those in a soup that fills space may have ten times the triangles
    // of what is around them.
    if (!options.keep_voids)
        report.filled_voxels = fill_voids(*field);
    return field;
}

} // namespace

OptionList describe(WrapOptions& o)
{
    return in_group(
        "Wrap",
        {option("wanted", o.wanted, "--wrap",
                "Build the shell of a new closed surface around the triangles, whatever they are"),
         option("voxel_size", o.voxel_size, "--wrap-voxel-size",
                "Edge length of a voxel of the wrap, world units")
             .needing(kWraps)
             .in(Unit::world_length)
             .within(above(0)),
         option("resolution", o.resolution, "--wrap-resolution",
                "Voxels of the wrap along the longest side of the bounding box; unset: a voxel is "
                "as long as the mesh's mean edge, within 128 to 256 of them")
             .needing(kWraps)
             .in(Unit::voxels)
             .within(at_least(1).at_most(kMostVoxelsAlong))
             .excluding("--wrap-voxel-size"),
         option("adaptivity", o.adaptivity, "--wrap-adaptivity",
                "How far simplification may move the wrap, voxels")
             .needing(kWraps)
             .in(Unit::voxels)
             .within(at_least(0).at_most(kMostAdaptivityVoxels)),
         option("sheet_voxels", o.sheet_voxels, "--wrap-sheet",
                "Half the thickness given to sheets and loose triangles, voxels")
             .needing(kWraps)
             .in(Unit::voxels)
             .within(at_least(kThinnestSheet).at_most(kThickestSheet)),
         option("keep_voids", o.keep_voids, "--wrap-keep-voids",
                "Keep enclosed voids and what stands in them")
             .needing(kWraps)});
}

double wrap_voxel_size(const TriangleMesh& mesh, const WrapOptions& options)
{
    const Bounds bounds = bounds_of(mesh.points);
    const Vec3d size = bounds.high - bounds.low;
    const double longest = std::max({size[0], size[1], size[2]});
    if (!(longest > 0 && std::isfinite(longest)))
        fail<GeometryError>("wrap: the mesh's longest side is ", longest, ", must be positive");
    const double voxel =
        options.voxel_size ? *options.voxel_size : longest / voxels_along(mesh, longest, options);
    // The range of the options bounds the resolution only, not what a voxel size comes to for this
    // mesh.
    if (longest / voxel > kMostVoxelsAlong)
        fail<InvalidOption>("wrap: voxel size ", voxel, " gives ", longest / voxel,
                            " voxels along the longest side ", longest, ", over the limit ",
                            kMostVoxelsAlong);
    return voxel;
}

WrapResult wrap_mesh(const TriangleMesh& mesh, const WrapOptions& options, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "wrap");
    require_in_range(options, "wrap");
    require_well_formed(mesh, "wrap_mesh");
    if (mesh.points.empty() || mesh.triangles.empty())
        fail<GeometryError>("wrap: the mesh has ", mesh.points.size(), " points and ",
                            mesh.triangles.size(), " triangles");
    const Bounds bounds = bounds_of(mesh.points);
    const Vec3d centre = 0.5 * (bounds.low + bounds.high);
    WrapResult result;
    const double voxel = result.report.voxel_size = wrap_voxel_size(mesh, options);

    const auto field =
        field_of(in_voxels(mesh, centre, voxel), 0.5 / voxel * (bounds.high - bounds.low), options,
                 result.report, progress);
    const auto to_world = [&](const Vec3d& index) { return centre + voxel * index; };
    result.mesh = contour_mapped(*field, to_world, {options.adaptivity, !options.keep_voids},
                                 result.report.contour, interrupter);
    // Samples a voxel apart: features between them are smaller than what the wrap can show.
    const auto distance = [&](const TriangleMesh& from, const TriangleMesh& to) {
        const double spacing = std::max(kDistanceSpacingVoxels * voxel, finest_spacing(from));
        return surface_distance(from, to, spacing, interrupter);
    };
    result.report.input_to_wrap = distance(mesh, result.mesh);
    result.report.wrap_to_input = distance(result.mesh, mesh);
    return result;
}

} // namespace vdb_shell

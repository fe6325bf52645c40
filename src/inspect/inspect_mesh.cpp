// SPDX-License-Identifier: Apache-2.0

// Takes a mesh however bad it is and finds everything that stands in the way of a shell or will
// show in it. It changes nothing and throws at no bad surface, so every part has to bear any
// topology: what needs an orientation looks at edges of two triangles only, and loops may be open.
// Connectivity and contacts are exact, as they are those of check_mesh(), and so are blind
// vertices; thin triangles are measured in doubles. Marks hold every element in ascending order,
// the result only counts and first ones, so neither depends on threads.

#include "vdb_shell/inspect/inspect_mesh.h"

#include "core/disjoint_sets.h"
#include "core/stage_progress.h"
#include "inspect/marks.h"
#include "mesh/boundary_loops.h"
#include "mesh/most_visible.h"
#include "mesh/orientation.h"
#include "vdb_shell/options/option.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

/// Of a one-sided piece only the first triangle is marked: which of its triangles disagree depends
/// on where one begins, and none of them is the wrong one.
void mark_orientation(DefectMarks& marks, std::size_t triangle_count)
{
    const Orientation orientation = consistent_orientation(marks.uses, triangle_count);
    std::vector<char> seen(orientation.one_sided.size());
    for (std::uint32_t t = 0; t < triangle_count; ++t) {
        if (orientation.turn[t])
            marks.flipped.push_back(t);
        const std::uint32_t piece = orientation.piece_of[t];
        if (orientation.one_sided[piece] && !seen[piece])
            marks.one_sided.push_back(t);
        seen[piece] = 1;
    }
}

/// A walk that is not closed has a point more than edges. Loops are sorted by their first points;
/// stable, since loops that meet in a point can have the same.
std::vector<BoundaryLoop> measure_loops(const TriangleMesh& mesh,
                                        const std::vector<Edge>& boundary_edges)
{
    std::vector<BoundaryLoop> loops;
    for (const BoundaryWalk& walk : boundary_walks(boundary_edges)) {
        BoundaryLoop loop;
        loop.first_point = *std::min_element(walk.points.begin(), walk.points.end());
        loop.closed = walk.closed;
        loop.edges = walk.points.size() - (walk.closed ? 0 : 1);
        for (std::size_t i = 0; i < loop.edges; ++i) {
            const std::uint32_t to = walk.points[(i + 1) % walk.points.size()];
            loop.length += (Vec3d(mesh.points[to]) - Vec3d(mesh.points[walk.points[i]])).length();
        }
        loops.push_back(loop);
    }
    std::stable_sort(loops.begin(), loops.end(), [](const BoundaryLoop& a, const BoundaryLoop& b) {
        return a.first_point < b.first_point;
    });
    return loops;
}

/// The flipped triangles as patches, by union of those that share an edge. The root of a patch is
/// its first triangle, and as flipped triangles ascend it comes before all others of its patch in
/// the last loop.
std::vector<FlippedPatch> patches_of(const DefectMarks& marks, std::size_t triangle_count)
{
    std::vector<char> flipped(triangle_count);
    for (const std::uint32_t t : marks.flipped)
        flipped[t] = 1;
    EdgeUses between;
    for (const EdgeUse& use : marks.uses)
        if (flipped[use.triangle])
            between.push_back(use);
    DisjointSets sets(triangle_count);
    for (std::size_t i = 1; i < between.size(); ++i)
        if (between[i].edge == between[i - 1].edge)
            sets.join(between[i].triangle, between[i - 1].triangle);
    std::vector<FlippedPatch> patches;
    std::vector<std::uint32_t> patch_of(triangle_count);
    for (const std::uint32_t t : marks.flipped) {
        const std::uint32_t root = sets.root_of(t);
        if (root == t) {
            patch_of[t] = static_cast<std::uint32_t>(patches.size());
            patches.push_back({t, 0});
        }
        ++patches[patch_of[root]].triangles;
    }
    return patches;
}

} // namespace

double voxel_size_to_inspect(const TriangleMesh& mesh, const InspectOptions& options)
{
    if (mesh.points.empty())
        return 0;
    // When all points are in one place, no voxel size follows from the resolution. It is the
    // triangles then, all without area, that tell what is wrong.
    const bool known = options.level_set.voxel_size || diagonal_of(bounds_of(mesh.points)) > 0;
    return known ? resolve_voxel_size(mesh, options.level_set) : 0;
}

DefectMarks mark_defects(const TriangleMesh& mesh, double voxel_size, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "inspect");
    DefectMarks marks;
    marks.uses = sorted_edge_uses(mesh.triangles);
    marks.surface = find_defects(mesh, marks.uses, interrupter);
    mark_orientation(marks, mesh.triangles.size());
    marks.blind = blind_vertices(mesh);
    progress.stop_if_interrupted(80);
    marks.thin = find_thin_triangles(mesh, marks.surface.duplicate_triangles, voxel_size);
    return marks;
}

/// Inspection needs the options of the level set for the size of a voxel only. The first of them
/// gets a help that fits.
OptionList describe(InspectOptions& o)
{
    OptionList options;
    for (Option& level_set : describe(o.level_set))
        if (level_set.key == "voxel_size" || level_set.key == "resolution")
            options.push_back(level_set);
    options.front().help = "Voxel that features are measured against, world units";
    return options;
}

MeshInspection inspect_mesh(const TriangleMesh& mesh, const InspectOptions& options,
                            Interrupter* interrupter)
{
    require_well_formed(mesh, "inspect_mesh");
    MeshInspection inspection;
    if (mesh.triangles.empty())
        return inspection;
    inspection.voxel_size = voxel_size_to_inspect(mesh, options);
    const DefectMarks marks = mark_defects(mesh, inspection.voxel_size, interrupter);
    inspection.check = summarise(mesh, marks.uses, marks.surface);
    inspection.boundary_loops = measure_loops(mesh, marks.surface.boundary_edges);
    inspection.flipped_patches = patches_of(marks, mesh.triangles.size());
    inspection.one_sided_pieces = summary_of(marks.one_sided);
    inspection.blind_vertices = summary_of(marks.blind);
    inspection.thin_triangles = summary_of(marks.thin);
    inspection.floats = float_limits(mesh);
    inspection.floats.largest_rounding = options.largest_rounding;
    return inspection;
}

} // namespace vdb_shell

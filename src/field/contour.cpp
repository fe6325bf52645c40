// SPDX-License-Identifier: Apache-2.0
// The zero surface of a field, as triangles that pass the exact tests of check_mesh. OpenVDB's
// volume to mesh is tried first, since it makes fewer triangles. Where it is not manifold or not
// embedded the surface is made anew by marching_tets, which is both by construction. What comes out
// is closed, oriented outward and simplified within the given adaptivity. The trap is float32: far
// from the origin the points of small voxels round onto each other, and then no method helps, so
// this is an error of its own. docs/stages/wrap.md, "Why it always ends in an accepted surface",
// has the argument.

#include "vdb_shell/field/contour.h"

#include "core/stage_progress.h"
#include "field/contour_mapped.h"
#include "field/marching_tets.h"
#include "mesh/components.h"
#include "resample/simplify.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/options/option.h"

#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

// Longer edges are not collapsed: flat parts keep triangles of up to about twice this.
constexpr double kLongestEdgeVoxels = 6.0;

double squared(const Vec3s& a, const Vec3s& b)
{
    return (Vec3d(a) - Vec3d(b)).lengthSqr();
}

/// Quads are cut along their shorter diagonal, which avoids slivers. OpenVDB's polygons run
/// clockwise seen from outside, ours counter-clockwise, so the corners are taken in reverse.
void add_polygons(const std::vector<Vec3I>& triangles, const std::vector<openvdb::Vec4I>& quads,
                  TriangleMesh& mesh)
{
    const std::vector<Vec3s>& p = mesh.points;
    for (const Vec3I& t : triangles)
        mesh.triangles.emplace_back(t[2], t[1], t[0]);
    for (const openvdb::Vec4I& q : quads) {
        if (squared(p[q[0]], p[q[2]]) <= squared(p[q[1]], p[q[3]])) {
            mesh.triangles.emplace_back(q[2], q[1], q[0]);
            mesh.triangles.emplace_back(q[3], q[2], q[0]);
        } else {
            mesh.triangles.emplace_back(q[1], q[0], q[3]);
            mesh.triangles.emplace_back(q[3], q[2], q[1]);
        }
    }
}

TriangleMesh by_volume_to_mesh(const openvdb::FloatGrid& field, const PointMap& to_world)
{
    // Points come out in index space and are mapped here, since the map to the world may be one
    // that no transform of OpenVDB can hold (voxels under 1.5e-5). The copy shares the tree.
    const auto in_index_space =
        field.copyGridReplacingTransform(openvdb::math::Transform::createLinearTransform(1.0));
    TriangleMesh mesh;
    std::vector<Vec3I> triangles;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*openvdb::gridConstPtrCast<openvdb::FloatGrid>(in_index_space),
                                 mesh.points, triangles, quads, 0.0, 0.0, true);
    for (Vec3s& p : mesh.points)
        p = Vec3s(to_world(Vec3d(p)));
    add_polygons(triangles, quads, mesh);
    return mesh;
}

TriangleMesh by_marching_tets(const openvdb::FloatGrid& field, const PointMap& to_world)
{
    const IndexSurface surface = marching_tets(field);
    TriangleMesh mesh;
    for (const Vec3d& p : surface.points)
        mesh.points.emplace_back(to_world(p));
    mesh.triangles = surface.triangles;
    return mesh;
}

/// Everything that a closed, manifold and embedded surface must not have. The orientation of whole
/// components is not among it, since it follows from the signs of the field.
std::size_t defects_of(const MeshCheck& check)
{
    return check.boundary_edges.count + check.non_manifold_edges.count +
           check.inconsistent_edges.count + check.non_manifold_vertices.count +
           check.degenerate_triangles.count + check.duplicate_triangles.count +
           check.self_intersections.count;
}

[[noreturn]] void fail_for(const MeshCheck& check, const TriangleMesh& mesh, double voxel)
{
    if (!check.closed())
        throw GeometryError("contour: the zero surface ends in " +
                            std::to_string(check.boundary_edges.count) +
                            " edges where the active voxels end; rebuild the level set with a "
                            "wider band");
    const Bounds bounds = bounds_of(mesh.points);
    double far = 0;
    for (int axis = 0; axis < 3; ++axis)
        far = std::max({far, std::abs(bounds.low[axis]), std::abs(bounds.high[axis])});
    throw GeometryError("contour: coordinates up to " + std::to_string(far) +
                        " are too large for float32 to hold voxels of " + std::to_string(voxel) +
                        " (" + std::to_string(defects_of(check)) +
                        " defects after rounding); move the surface to the origin or enlarge the "
                        "voxels");
}

/// Keeps the components that no other encloses, in place; points that are then unused are left out.
/// The numbers of components are those of `check`, since both number them by their first triangle.
void keep_outermost(TriangleMesh& mesh, const MeshCheck& check, ContourReport& report)
{
    const std::vector<std::uint32_t> component =
        component_of_triangles(sorted_edge_uses(mesh.triangles), mesh.triangles.size());
    std::vector<Vec3I> kept;
    std::vector<std::uint32_t> place(mesh.points.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (check.components.at(component[t]).nesting_depth == 0) {
            kept.push_back(mesh.triangles[t]);
            for (int k = 0; k < 3; ++k)
                place[mesh.triangles[t][k]] = 1;
        }
    // Points move to lower places only, so they can be moved within the array, in ascending order.
    std::uint32_t used = 0;
    for (std::size_t v = 0; v < place.size(); ++v)
        if (place[v]) {
            mesh.points[used] = mesh.points[v];
            place[v] = used++;
        }
    mesh.points.resize(used);
    for (Vec3I& t : kept)
        t = Vec3I(place[t[0]], place[t[1]], place[t[2]]);
    mesh.triangles = std::move(kept);
    report.dropped_components = static_cast<std::size_t>(
        std::count_if(check.components.begin(), check.components.end(),
                      [](const Component& c) { return c.nesting_depth > 0; }));
}

} // namespace

const NameTable<ContourMethod>& names(ContourMethod)
{
    static const NameTable<ContourMethod> table{{"volume-to-mesh", ContourMethod::volume_to_mesh},
                                                {"marching-tets", ContourMethod::marching_tets}};
    return table;
}

OptionList describe(ContourOptions& o)
{
    return in_group("Wrap",
                    {option("adaptivity", o.adaptivity, "--contour-adaptivity",
                            "How far simplification may move the surface of a level set, voxels")
                         .in(Unit::voxels)
                         .within(at_least(0)),
                     option("outer_only", o.outer_only, "",
                            "Leave out the surfaces of voids, and what stands inside them")});
}

TriangleMesh contour_mapped(const openvdb::FloatGrid& field, const PointMap& to_world,
                            const ContourOptions& options, ContourReport& report,
                            Interrupter* interrupter)
{
    require_in_range(options, "contour");
    // The diagonal of a voxel over sqrt(3): the edge of a voxel that is a cube, however the map
    // turns it, and some mean where it is none. Only tolerances are measured in it.
    const double voxel = (to_world(Vec3d(1, 1, 1)) - to_world(Vec3d(0.0))).length() / std::sqrt(3);
    TriangleMesh mesh = by_volume_to_mesh(field, to_world);
    if (mesh.triangles.empty())
        throw GeometryError("contour: the field has no zero surface");
    MeshCheck check = check_mesh(mesh);
    report.volume_to_mesh_defects = defects_of(check);
    if (report.volume_to_mesh_defects > 0) {
        report.method = ContourMethod::marching_tets;
        mesh = by_marching_tets(field, to_world);
        check = check_mesh(mesh);
        // The surface of tetrahedra can fail for two reasons only, an open end of the active voxels
        // or the rounding of its points to float32, and fail_for tells which.
        if (defects_of(check) > 0)
            fail_for(check, mesh, voxel);
    }
    if (options.outer_only)
        keep_outermost(mesh, check, report);
    report.components = check.components.size() - report.dropped_components;
    report.triangles = mesh.triangles.size();
    Simplified simple =
        simplify(mesh, {options.adaptivity * voxel, kLongestEdgeVoxels * voxel}, interrupter);
    report.simplification_repeats = simple.repeats;
    report.simplified_triangles = simple.mesh.triangles.size();
    return std::move(simple.mesh);
}

TriangleMesh contour(const openvdb::FloatGrid& field, const ContourOptions& options,
                     ContourReport* report, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "contour");
    const openvdb::math::Transform& transform = field.transform();
    ContourReport own;
    TriangleMesh mesh = contour_mapped(
        field, [&](const Vec3d& p) { return transform.indexToWorld(p); }, options,
        report ? *report : own, interrupter);
    // A transform that mirrors turns all triangles inside out, so they are turned back at the end.
    if (transform.baseMap()->determinant() < 0)
        for (Vec3I& t : mesh.triangles)
            std::swap(t[1], t[2]);
    return mesh;
}

} // namespace vdb_shell

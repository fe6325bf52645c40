// SPDX-License-Identifier: Apache-2.0

// The check of a surface before anything is built on it. It takes any mesh whose indices and
// coordinates can be worked with, and says which of the conditions of a closed, oriented, embedded
// manifold fail, and where; the decisions are exact and without tolerance (core/exact.h). A bad
// surface is a result and no exception, because people want to see all that is wrong at once;
// mesh/require_usable.cpp is what refuses. All lists are in ascending order, whatever the number of
// threads.

#include "vdb_shell/mesh/check_mesh.h"

#include "core/stage_progress.h"
#include "mesh/components.h"
#include "mesh/surface_defects.h"
#include "mesh/topology.h"
#include "vdb_shell/core/error.h"

#include <cmath>
#include <utility>

namespace vdb_shell
{
std::size_t MeshCheck::inside_out_components() const
{
    return components_that_are(&Component::inside_out).count;
}

Defect<std::uint32_t> MeshCheck::components_that_are(bool Component::*mark) const
{
    Defect<std::uint32_t> found;
    for (std::uint32_t c = 0; c < components.size(); ++c) {
        if (!(components[c].*mark))
            continue;
        if (found.count++ < Defect<std::uint32_t>::kFirstShown)
            found.first.push_back(c);
    }
    return found;
}

void require_well_formed(const TriangleMesh& mesh, const std::string& caller)
{
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        if (!mesh.points[v].isFinite())
            // Finite first: what is not a number would pass the comparison with the limit below.
            throw InvalidOption(caller + ": point " + std::to_string(v) + " is " +
                                mesh.points[v].str() + ", which is not finite");
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            if (std::abs(double(mesh.points[v][axis])) > kLargestCoordinate)
                throw InvalidOption(caller + ": point " + std::to_string(v) +
                                    " has the coordinate " + std::to_string(mesh.points[v][axis]) +
                                    ", over the limit of 1e18");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (int corner = 0; corner < 3; ++corner)
            if (mesh.triangles[t][corner] >= mesh.points.size())
                throw InvalidOption(caller + ": triangle " + std::to_string(t) +
                                    " has the point index " +
                                    std::to_string(mesh.triangles[t][corner]) + ", there are " +
                                    std::to_string(mesh.points.size()) + " points");
}

MeshCheck summarise(const TriangleMesh& mesh, const EdgeUses& sorted_uses,
                    const SurfaceDefects& defects)
{
    MeshCheck check;
    check.points = mesh.points.size();
    check.triangles = mesh.triangles.size();
    check.boundary_edges = summary_of(defects.boundary_edges);
    check.non_manifold_edges = summary_of(defects.non_manifold_edges);
    check.inconsistent_edges = summary_of(defects.inconsistent_edges);
    check.non_manifold_vertices = summary_of(defects.non_manifold_vertices);
    check.degenerate_triangles = summary_of(defects.degenerate_triangles);
    check.duplicate_triangles = summary_of(defects.duplicate_triangles);
    check.self_intersections = summary_of(defects.self_intersections);
    check.self_intersections.at_least = defects.more_self_intersections;
    const std::vector<std::uint32_t> component_of =
        component_of_triangles(sorted_uses, mesh.triangles.size());
    check.components =
        describe_components(mesh, sorted_uses, component_of,
                            crossing_components(defects.self_intersections, component_of));
    // In the order of the components, so the sum has the same bits every time.
    for (const Component& component : check.components)
        check.volume += component.volume;
    return check;
}

MeshCheck check_mesh(const TriangleMesh& mesh, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "check");
    require_well_formed(mesh, "check_mesh");
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    return summarise(mesh, uses, find_defects(mesh, uses, interrupter));
}

TriangleMesh turn_outward(TriangleMesh mesh, const MeshCheck& check)
{
    if (check.inside_out_components() == 0)
        return mesh;
    // The numbers of components follow from the triangles alone, so they are those of the check.
    // Turning triangles round does not change which of them share an edge.
    const std::vector<std::uint32_t> component =
        component_of_triangles(sorted_edge_uses(mesh.triangles), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (check.components.at(component[t]).inside_out)
            std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    return mesh;
}

} // namespace vdb_shell

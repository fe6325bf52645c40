// SPDX-License-Identifier: Apache-2.0

// Takes: a surface and closed surfaces inside it, the cores. Leaves: the cores, proven to be where
// a core may be, and the triangles that the shell is kept out of. Everything is asked before the
// first line is stepped, and a refusal names both triangles. Contacts and insides are decided by
// exact tests on the float32 that the shell will be held against; the order of findings is that of
// indices.

#include "vdb_shell/obstacles/cores.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "core/triangle_pairs.h"
#include "mesh/components.h"
#include "mesh/exact_winding.h"
#include "mesh/topology.h"
#include "obstacles/offset_surface.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/check_mesh.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

std::string core_named(const CoreMesh& core)
{
    return "core " + core.name;
}
std::string part_named(const CoreMesh& core, std::uint32_t first_triangle)
{
    return core_named(core) + ": the part of triangle " + std::to_string(first_triangle);
}

std::string shown(std::uint32_t index)
{
    return std::to_string(index);
}
std::string shown(const std::array<std::uint32_t, 2>& pair)
{
    return shown(pair[0]) + " and " + shown(pair[1]);
}

template <typename Element>
void refuse_any(const CoreMesh& core, const Defect<Element>& defect, const char* what,
                const char* element)
{
    if (defect.count > 0)
        throw GeometryError(core_named(core) + ": " + what + ": " + std::to_string(defect.count) +
                            " found, the first at " + element + " " + shown(defect.first.front()));
}

/// Sound by itself: closed, manifold, embedded, outward, and no part of it within another.
void require_sound(const CoreMesh& core)
{
    const MeshCheck check = check_mesh(core.mesh);
    if (check.triangles == 0)
        throw GeometryError(core_named(core) + ": it has no triangles");
    refuse_any(core, check.boundary_edges, "it is open", "the edge of vertices");
    refuse_any(core, check.non_manifold_edges, "edges have three triangles or more",
               "the edge of vertices");
    refuse_any(core, check.inconsistent_edges, "triangles beside an edge are turned differently",
               "the edge of vertices");
    refuse_any(core, check.non_manifold_vertices, "triangles around a vertex form no fan",
               "vertex");
    refuse_any(core, check.degenerate_triangles, "triangles have no area", "triangle");
    refuse_any(core, check.duplicate_triangles, "triangles come twice", "triangle");
    refuse_any(core, check.self_intersections, "it crosses or touches itself", "triangles");
    for (const Component& part : check.components) {
        if (part.nesting_depth > 0)
            throw GeometryError(part_named(core, part.first_triangle) +
                                " lies inside another part; what is inside a core is of no use");
        if (part.inside_out)
            throw GeometryError(part_named(core, part.first_triangle) +
                                " is inside out: its triangles face inward");
    }
}

/// Several meshes as one list, with the mesh of each triangle.
struct Together {
    TriangleMesh mesh;
    std::vector<std::uint32_t> part;  ///< by triangle
    std::vector<std::uint32_t> first; ///< by part: its first triangle
};

void add_part(Together& all, const TriangleMesh& mesh)
{
    const auto points = std::uint32_t(all.mesh.points.size());
    all.first.push_back(std::uint32_t(all.mesh.triangles.size()));
    all.mesh.points.insert(all.mesh.points.end(), mesh.points.begin(), mesh.points.end());
    for (const Vec3I& t : mesh.triangles)
        all.mesh.triangles.push_back(t + Vec3I(points));
    // Fills in the triangles that have just been added and leaves those before.
    all.part.resize(all.mesh.triangles.size(), std::uint32_t(all.first.size() - 1));
}

/// Pairs of triangles of different parts that have a common point, sorted.
std::vector<std::array<std::uint32_t, 2>> contacts_between(const Together& all)
{
    const TriangleMesh& mesh = all.mesh;
    return overlapping_triangles(
        mesh.points, mesh.triangles, [&](std::uint32_t a, std::uint32_t b) {
            // Contacts within a part are for its own check.
            return all.part[a] != all.part[b] &&
                   exact::triangles_touch(mesh.points, mesh.triangles[a], mesh.triangles[b]);
        });
}

/// Part 0 is the surface.
void require_no_contact(const std::string& surface, const std::vector<CoreMesh>& cores,
                        const Together& all)
{
    const auto contacts = contacts_between(all);
    if (contacts.empty())
        return;
    const auto named = [&](std::uint32_t triangle) {
        const std::uint32_t part = all.part[triangle];
        return "triangle " + std::to_string(triangle - all.first[part]) + " of " +
               (part == 0 ? surface : core_named(cores[part - 1]));
    };
    // The lower index is that of the earlier part, so the second is of a core in any case.
    const auto [first, second] = contacts.front();
    throw GeometryError(
        core_named(cores[all.part[second] - 1]) + " crosses or touches " +
        (all.part[first] == 0 ? "the surface" : core_named(cores[all.part[first] - 1])) + ": " +
        named(first) + " and " + named(second) + ", the first of " +
        std::to_string(contacts.size()) + " pairs");
}

/// Of a closed mesh that does not hold the point.
int winding_number(const TriangleMesh& mesh, const Vec3s& point)
{
    return exact_winding(point, mesh.points, mesh.triangles).number;
}

/// Of each part of a mesh the first triangle and a corner of it. As nothing touches, that point
/// stands for all of the part.
struct Part {
    std::uint32_t first_triangle = 0;
    Vec3s point;
};
std::vector<Part> parts_of(const TriangleMesh& mesh)
{
    const std::vector<std::uint32_t> component =
        component_of_triangles(sorted_edge_uses(mesh.triangles), mesh.triangles.size());
    std::vector<Part> parts;
    // Components are numbered by their first triangles.
    for (std::uint32_t t = 0; t < component.size(); ++t)
        if (component[t] == parts.size())
            parts.push_back({t, mesh.points[mesh.triangles[t][0]]});
    return parts;
}

void require_inside(const TriangleMesh& surface, const std::string& name,
                    const std::vector<CoreMesh>& cores, std::size_t which)
{
    const CoreMesh& core = cores[which];
    for (const Part& part : parts_of(core.mesh)) {
        if (winding_number(surface, part.point) <= 0)
            throw GeometryError(part_named(core, part.first_triangle) + " lies outside of " + name);
        for (std::size_t other = 0; other < cores.size(); ++other)
            if (other != which && winding_number(cores[other].mesh, part.point) > 0)
                throw GeometryError(part_named(core, part.first_triangle) + " lies inside " +
                                    core_named(cores[other]));
    }
    // The wall of a cavity, whose shell would lie in the core.
    for (const Part& part : parts_of(surface))
        if (winding_number(core.mesh, part.point) > 0)
            throw GeometryError(core_named(core) + ": a part of " + name +
                                " lies inside it, that of triangle " +
                                std::to_string(part.first_triangle));
}

/// A triangle of the surface is named, for the user knows nothing of what is around the cores.
[[noreturn]] void refuse_distance(const std::string& name, double distance, std::uint32_t triangle)
{
    throw GeometryError(name + ": the surface comes nearer to a core than " +
                        std::to_string(distance) + " (--core-distance), at triangle " +
                        std::to_string(triangle));
}

void require_room(const TriangleMesh& surface, const std::string& name, const TriangleMesh& around,
                  double distance)
{
    Together both;
    add_part(both, surface);
    add_part(both, around);
    const auto contacts = contacts_between(both);
    if (!contacts.empty())
        refuse_distance(name, distance, contacts.front()[0]);
    for (const Part& part : parts_of(surface))
        if (winding_number(around, part.point) > 0)
            refuse_distance(name, distance, part.first_triangle);
}

/// Every part of the cores has to lie inside the surface around them, which touches none.
void require_held(const std::vector<CoreMesh>& cores, const TriangleMesh& around)
{
    for (const CoreMesh& core : cores)
        for (const Part& part : parts_of(core.mesh))
            if (winding_number(around, part.point) <= 0)
                throw GeometryError(part_named(core, part.first_triangle) +
                                    " is too small for --core-distance");
}

} // namespace

OptionList describe(CoreOptions& o)
{
    return in_group(
        "Cores",
        {option("distance", o.distance, "--core-distance",
                "The shell stays at least so far from the surfaces of --core FILE, world units")
             .needing("--core")
             .in(Unit::world_length)
             .within(at_least(0)),
         option("reach", o.reach, "--core-reach",
                "A pillar counts as ended at a core if no more than this share of its length is "
                "left to it")
             .needing("--core")
             .in(Unit::share)
             .within(at_least(0))});
}

TriangleMesh joined_cores(const std::vector<CoreMesh>& cores)
{
    Together all;
    for (const CoreMesh& core : cores)
        add_part(all, core.mesh);
    return std::move(all.mesh);
}

Cores prepare_cores(const TriangleMesh& surface, const std::string& name,
                    std::vector<CoreMesh> cores, const CoreOptions& options,
                    Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "cores");
    require_in_range(options, "cores");
    assert(!cores.empty());
    Together all;
    add_part(all, surface);
    for (const CoreMesh& core : cores) {
        require_sound(core);
        add_part(all, core.mesh);
    }
    progress.stop_if_interrupted(30);
    // Before anything is asked of insides: a winding number says where a part is only if nothing
    // touches.
    require_no_contact(name, cores, all);
    for (std::size_t i = 0; i < cores.size(); ++i)
        require_inside(surface, name, cores, i);
    Cores prepared{std::move(cores), {}};
    const TriangleMesh joined = joined_cores(prepared.given);
    if (options.distance == 0) {
        // Every point becomes a vertex of the surface that is grown on, and one without a triangle
        // has no fan.
        prepared.kept_out = without_unused_points(joined);
        return prepared;
    }
    prepared.kept_out = offset_surface(joined, options.distance, interrupter);
    // The distance is only kept if what is around the cores holds all of them (docs/theory.md,
    // "Cores").
    require_held(prepared.given, prepared.kept_out);
    require_room(surface, name, prepared.kept_out, options.distance);
    return prepared;
}

} // namespace vdb_shell

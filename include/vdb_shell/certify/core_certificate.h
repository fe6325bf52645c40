// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/certify/conformity.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/core_tets.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The surface of what a shell inside its surface leaves empty: the inner faces of the tets, and
/// outer triangles that no tet has; counter-clockwise seen from the shell. Closed as a sum of
/// triangles; it may share points and edges with itself.
struct VoidSurface {
    std::vector<openvdb::Vec3s> points; ///< those of the tets, then outer ones that no tet has
    std::vector<openvdb::Vec3I> triangles;
    std::vector<std::uint32_t> lone_vertices; ///< of the outermost surface: those next points
    std::size_t hole_points = 0;              ///< of surfaces inside the void: those last points
};
/// `holes`: closed surfaces inside of which the void ends, as the cores of a shell are; oriented
/// outward. Precondition: the stack is certified, and lies inside its surface.
VoidSurface void_surface(const ShellStack& stack, const TetMesh& tets,
                         const TriangleMesh& holes = {});

/// The proof that a certified shell inside its surface and tets that fill it are one geometric
/// simplicial complex that covers the solid, less its holes, or what stands against it
/// (docs/theory.md, "A filled core"). Exact signs and indices only.
struct CoreCertificate {
    Defect<std::uint32_t> foreign_points; ///< own points that are no lone vertex, hole's or inside
    Defect<std::uint32_t> corners_out_of_range; ///< tets; nothing else has been looked at then
    Defect<std::uint32_t> bad_tets;             ///< not positive
    Defect<std::uint32_t> crowded_faces;        ///< of three tets or more, by the first
    Defect<std::uint32_t> misoriented_faces;    ///< two tets on one side of a face, by the first
    Defect<std::uint32_t>
        stray_faces; ///< of one tet, and no triangle of the void's surface; by tet
    Defect<std::uint32_t> missing_triangles; ///< of the void's surface, that no tet has
    Defect<std::uint32_t> unused_points;     ///< own points that no tet has
    /// All tets together have the volume of the outermost surface less the holes, as exact sums.
    bool volume_agrees = false;

    bool certified() const;
    /// One line for each kind of failure, as Certificate::failures.
    std::vector<std::string> failures() const;
};

/// Any core, one read from a file included. Precondition: the stack is certified and lies inside
/// its surface, `tets` are its tets; finite points, as many source vertices as own points; holes
/// closed, embedded, oriented outward, none within another, none around a part of the surface.
CoreCertificate certify_core(const ShellStack& stack, const TetMesh& tets, const CoreTets& core,
                             const TriangleMesh& holes = {});

/// The surfaces inside at which the tets of a core end, oriented outward: what a file does not say
/// by itself. Empty where those points are not where certify_core wants them. Precondition: as
/// there, corners in range.
TriangleMesh holes_of_core(const ShellStack& stack, const TetMesh& tets, const CoreTets& core);

} // namespace vdb_shell

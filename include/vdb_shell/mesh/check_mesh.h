// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"
#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/options/describe.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// Coordinates over this are refused: from 1.8e18 on squares leave float32, in which much of growth
/// and the trees over triangles compute.
inline constexpr double kLargestCoordinate = 1e18;

/// How many elements have a defect, and the first of them by index (at most kFirstShown).
template <typename Element> struct Defect {
    static constexpr std::size_t kFirstShown = 8;
    std::size_t count = 0;
    std::vector<Element> first;
    bool at_least = false; ///< not all were counted, since there are very many
};
using Edge = std::array<std::uint32_t, 2>;         ///< two point indices, smaller first
using TrianglePair = std::array<std::uint32_t, 2>; ///< two triangle indices, smaller first

/// One edge-connected piece of the surface.
struct Component {
    std::size_t triangles = 0;
    std::uint32_t first_triangle = 0;
    double volume = 0; ///< signed; meaningful when the component is closed
    bool closed = false;
    int euler = 0;
    /// How many other closed components enclose this one (of those that it crosses or
    /// touches: that hold all corners asked). Even: an
    /// outer surface. Odd: a cavity, which has to be oriented the other way round (its own signed
    /// volume is negative).
    int nesting_depth = 0;
    /// Closed, every edge run through as often one way as the other, but oriented against the
    /// nesting depth.
    bool inside_out = false;
    /// Closed, every edge run through as often one way as the other, and its volume is exactly
    /// zero, as that of a sheet that was closed by its own back is.
    bool flat = false;
};

struct MeshCheck {
    std::size_t points = 0, triangles = 0;
    Defect<Edge> boundary_edges;     ///< one incident triangle
    Defect<Edge> non_manifold_edges; ///< three or more incident triangles
    Defect<Edge> inconsistent_edges; ///< two triangles that run through the edge the same way
    /// Incident triangles do not form one fan; the ends of non-manifold edges are among them.
    Defect<std::uint32_t> non_manifold_vertices;
    Defect<std::uint32_t> degenerate_triangles; ///< exactly zero area (exact arithmetic)
    Defect<std::uint32_t> duplicate_triangles;  ///< same three points as an earlier triangle
    /// Touching other than in shared vertices and edges. Of n triangles that all meet in one place
    /// some million pairs and 16 n are counted, not all n^2 / 2.
    Defect<TrianglePair> self_intersections;
    std::vector<Component> components; ///< by first triangle
    double volume = 0;                 ///< sum of the signed volumes

    bool closed() const { return boundary_edges.count == 0; }
    bool manifold() const { return non_manifold_edges.count + non_manifold_vertices.count == 0; }
    bool embedded() const { return self_intersections.count == 0; }
    std::size_t inside_out_components() const;
    /// Components of which that mark holds, by index.
    Defect<std::uint32_t> components_that_are(bool Component::*mark) const;
};

struct CheckOptions {
    /// Accept surfaces that cross themselves: they have a level set and can be stepped, but their
    /// shells are certified tet by tet at most (certify/overlaps.h).
    bool allow_self_intersections = false;
    /// Turn components that are oriented against their nesting depth, instead of refusing them.
    bool turn_inside_out = false;
};
OptionList describe(CheckOptions& options);

/// Looks at everything that the stages after this one rely on. Exact predicates, no tolerance.
/// Precondition, which read_mesh guarantees: points within kLargestCoordinate, corners that index
/// them; else InvalidOption. Never throws for a bad surface: the findings are the result.
/// Degenerate triangles and repeats are listed as such, not among the self-intersections. The
/// interrupter may be null; throws Cancelled.
MeshCheck check_mesh(const TriangleMesh& mesh, Interrupter* interrupter = nullptr);

/// Why no shell can be made of the mesh under `options`: how many defects of each kind. Empty if
/// one can be tried.
std::string why_not_usable(const MeshCheck& check, const CheckOptions& options);

/// Throws GeometryError with counts and first offenders by index when the mesh cannot be worked
/// with under `options`; `name` (the file) opens the message, which ends in the option that helps,
/// if any.
void require_usable(const MeshCheck& check, const CheckOptions& options, const std::string& name);

/// The mesh with every inside-out component reversed.
TriangleMesh turn_outward(TriangleMesh mesh, const MeshCheck& check);

} // namespace vdb_shell

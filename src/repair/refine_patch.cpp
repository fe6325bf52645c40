// SPDX-License-Identifier: Apache-2.0

// Takes a triangulated rim and adds points inside until the edges are about as long as those around
// the rim, after Liepa 2003, "Filling holes in meshes": triangles that are large for the spacing at
// their corners are split at their middles, and edges are turned towards a Delaunay triangulation,
// by turns. The rim's points keep their places in the list, since new ones are only appended and
// nothing is deleted. The trap is that triangles in space, unlike those in a plane, need not come
// to an end of turning; both loops have a bound.

#include "repair/fill_patch.h"

// GCC warns that a new point's OpenMesh vector is copied before it has a value. Nothing reads that
// copy. The warning comes where OpenMesh's code is inlined, after this point, so the setting is not
// undone.
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <cmath>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

struct Traits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;
using Vertex = HalfEdgeMesh::VertexHandle;

/// A rim of n edges gets no more new points than this for each of them, which bounds the work where
/// a rim has edges of very different lengths. A round rim of 1000 equal edges, the longest that
/// gets here, needs about 92 for each edge: n^2 / (4 pi) squares of an edge, times 2 / sqrt(3)
/// points of a triangular lattice in each, over n.
constexpr std::size_t kMostPointsAnEdge = 200;

HalfEdgeMesh to_half_edges(const Patch& patch)
{
    HalfEdgeMesh mesh;
    for (const Vec3d& p : patch.points)
        mesh.add_vertex({p[0], p[1], p[2]});
    for (const Vec3I& t : patch.triangles)
        mesh.add_face(Vertex(int(t[0])), Vertex(int(t[1])), Vertex(int(t[2])));
    return mesh;
}

void from_half_edges(const HalfEdgeMesh& mesh, Patch& patch)
{
    patch = {};
    for (const auto v : mesh.vertices()) {
        const auto& p = mesh.point(v);
        patch.points.emplace_back(p[0], p[1], p[2]);
    }
    for (const auto f : mesh.faces()) {
        std::vector<std::uint32_t> corners;
        for (const auto v : mesh.fv_range(f))
            corners.push_back(static_cast<std::uint32_t>(v.idx()));
        patch.triangles.emplace_back(corners[0], corners[1], corners[2]);
    }
}

/// Splits the triangles whose middle is farther from each corner, times Liepa's alpha, than the
/// spacing at the corners and in the middle. The spacing of a new point is the mean of its
/// corners', so spacing goes over from one side of the hole to the other. Parts made here are
/// looked at in the next turn.
bool split_large(HalfEdgeMesh& mesh, std::vector<double>& spacing, std::size_t most_points)
{
    constexpr double kDensity = 1.4142135623730951; // Liepa's alpha
    bool any = false;
    const std::size_t faces = mesh.n_faces();
    for (std::size_t f = 0; f < faces && mesh.n_vertices() < most_points; ++f) {
        const HalfEdgeMesh::FaceHandle face(static_cast<int>(f));
        OpenMesh::Vec3d middle(0.0, 0.0, 0.0);
        double mean = 0;
        for (const auto v : mesh.fv_range(face)) {
            middle += mesh.point(v) / 3.0;
            mean += spacing[std::size_t(v.idx())] / 3.0;
        }
        bool large = true;
        for (const auto v : mesh.fv_range(face)) {
            const double distance = kDensity * (middle - mesh.point(v)).norm();
            large = large && distance > mean && distance > spacing[std::size_t(v.idx())];
        }
        if (!large)
            continue;
        mesh.split(face, mesh.add_vertex(middle));
        spacing.push_back(mean);
        any = true;
    }
    return any;
}

double angle_at(const OpenMesh::Vec3d& p, const OpenMesh::Vec3d& a, const OpenMesh::Vec3d& b)
{
    const OpenMesh::Vec3d u = a - p, v = b - p;
    return std::atan2(cross(u, v).norm(), dot(u, v));
}

/// Turns every edge whose opposite angles sum to more than a half turn, which in a plane is the
/// sign that it is not Delaunay; false when there is none. The rim is the patch's boundary and is
/// never turned.
bool turn_edges(HalfEdgeMesh& mesh, const Rim& rim)
{
    constexpr double kSlack = 1e-9; // on four points of a circle both ways are right
    const auto rim_size = static_cast<int>(rim.points.size());
    bool any = false;
    for (const auto edge : mesh.edges()) {
        if (mesh.is_boundary(edge) || !mesh.is_flip_ok(edge))
            continue;
        const auto h = mesh.halfedge_handle(edge, 0), o = mesh.halfedge_handle(edge, 1);
        const Vertex a = mesh.from_vertex_handle(h), b = mesh.to_vertex_handle(h);
        const Vertex c = mesh.to_vertex_handle(mesh.next_halfedge_handle(h));
        const Vertex d = mesh.to_vertex_handle(mesh.next_halfedge_handle(o));
        // Two corners of the rim may have an edge in the surface outside already; with the new one
        // it would get more than two triangles.
        const int low = std::min(c.idx(), d.idx()), high = std::max(c.idx(), d.idx());
        const std::pair<std::uint32_t, std::uint32_t> chord(low, high);
        if (high < rim_size && rim.edges.count(chord) > 0)
            continue;
        if (angle_at(mesh.point(c), mesh.point(a), mesh.point(b)) +
                angle_at(mesh.point(d), mesh.point(a), mesh.point(b)) <=
            M_PI + kSlack)
            continue;
        mesh.flip(edge);
        any = true;
    }
    return any;
}

} // namespace

void refine(Patch& patch, const Rim& rim)
{
    constexpr int kMostSweeps = 30;
    HalfEdgeMesh mesh = to_half_edges(patch);
    // OpenMesh refuses triangles that make no manifold; such a patch stays as it was triangulated.
    if (mesh.n_faces() != patch.triangles.size())
        return;
    std::vector<double> spacing = rim.spacing;
    const std::size_t most_points = rim.points.size() * (1 + kMostPointsAnEdge);
    while (split_large(mesh, spacing, most_points))
        for (int sweep = 0; sweep < kMostSweeps && turn_edges(mesh, rim); ++sweep)
            ;
    from_half_edges(mesh, patch);
}

} // namespace vdb_shell::repair

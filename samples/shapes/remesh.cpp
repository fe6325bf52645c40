// SPDX-License-Identifier: Apache-2.0
#include "shapes/remesh.h"

#include "core/parallel.h"

// OpenMesh grows its arrays by default-made vectors, which GCC takes for a read of unset values; it
// says so where they are inlined, at the end of the file.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell::samples
{

namespace
{

using openvdb::Vec3d;

struct MeshTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<MeshTraits>;
using Vertex = OpenMesh::VertexHandle;
using Edge = OpenMesh::EdgeHandle;
using Halfedge = OpenMesh::HalfedgeHandle;
using Face = OpenMesh::FaceHandle;
using Point = Mesh::Point;

// An operation may turn no triangle by more than about 41 degrees from the skin's own normal, nor
// make one thinner than this (1 = equilateral).
constexpr double kSmallestFacing = 0.75;
constexpr double kSmallestShape = 0.25;

Vec3d to_vec(const Point& p)
{
    return {p[0], p[1], p[2]};
}
Point to_point(const Vec3d& p)
{
    return {p[0], p[1], p[2]};
}

Vec3d gradient(const Field& field, const Vec3d& p)
{
    constexpr double kStep = 1e-4;
    Vec3d g;
    for (int k = 0; k < 3; ++k) {
        Vec3d low = p, high = p;
        low[k] -= kStep;
        high[k] += kStep;
        g[k] = (field(high) - field(low)) / (2 * kStep);
    }
    return g;
}

/// Newton steps along the gradient, held short so that a thin part is not crossed.
Vec3d project(const Field& field, Vec3d p)
{
    for (int i = 0; i < 4; ++i) {
        const Vec3d g = gradient(field, p);
        Vec3d move = g * (-field(p) / std::max(g.dot(g), 0.05));
        const double length = move.length();
        if (length > 0.01)
            move *= 0.01 / length;
        p += move;
    }
    return p;
}

/// Frobenius norm of the shape operator, at the scale of the smallest edges.
double curvature(const Field& field, const Vec3d& p, double scale)
{
    const Vec3d n = gradient(field, p).unitSafe();
    const Vec3d aside = std::abs(n[0]) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    const Vec3d u = n.cross(aside).unitSafe(), v = n.cross(u);
    double sum = 0.0;
    for (const Vec3d& t : {u, v}) {
        const Vec3d change =
            gradient(field, p + t * scale).unitSafe() - gradient(field, p - t * scale).unitSafe();
        sum += change.dot(change) / (4 * scale * scale);
    }
    return std::sqrt(sum);
}

struct Remesher {
    const Field& field;
    const RemeshOptions& options;
    Mesh mesh;
    std::vector<double> target{}; ///< edge length by vertex index
    std::vector<Vec3d> normal{};  ///< of the skin, by vertex index
};

template <typename Body> void for_each_vertex(const Mesh& mesh, const Body& body)
{
    for_each_index(mesh.n_vertices(), [&](std::size_t i) { body(Vertex(static_cast<int>(i))); });
}

/// Projects every vertex, then measures the skin there. Neighbouring targets differ by a fraction
/// of the distance between them, so that sizes change gradually.
void measure(Remesher& r)
{
    constexpr double kGrading = 0.35;
    r.target.resize(r.mesh.n_vertices());
    r.normal.resize(r.mesh.n_vertices());
    for_each_vertex(r.mesh, [&](Vertex v) {
        const Vec3d p = to_vec(r.mesh.point(v));
        const double k = std::max(curvature(r.field, p, 0.5 * r.options.shortest_edge), 1e-3);
        const double e = r.options.sagitta;
        r.target[v.idx()] = std::clamp(std::sqrt(std::max(6 * e / k - 3 * e * e, 0.0)),
                                       r.options.shortest_edge, r.options.longest_edge);
        r.normal[v.idx()] = gradient(r.field, p).unitSafe();
    });
    for (int pass = 0; pass < 8; ++pass) {
        std::vector<double> graded = r.target;
        for_each_vertex(r.mesh, [&](Vertex v) {
            for (const Vertex w : r.mesh.vv_range(v))
                graded[v.idx()] = std::min(
                    graded[v.idx()],
                    r.target[w.idx()] + kGrading * (r.mesh.point(v) - r.mesh.point(w)).length());
        });
        r.target.swap(graded);
    }
}

double target_of(const Remesher& r, Vertex a, Vertex b)
{
    return 0.5 * (r.target[a.idx()] + r.target[b.idx()]);
}

/// Whether the triangle is well shaped and faces as the skin does at its corners.
bool acceptable(const Remesher& r, const std::array<Vertex, 3>& c, const std::array<Vec3d, 3>& p)
{
    const Vec3d area = (p[1] - p[0]).cross(p[2] - p[0]);
    const double edges =
        (p[1] - p[0]).lengthSqr() + (p[2] - p[1]).lengthSqr() + (p[0] - p[2]).lengthSqr();
    if (2 * std::sqrt(3.0) * area.length() < kSmallestShape * edges)
        return false;
    const Vec3d skin = r.normal[c[0].idx()] + r.normal[c[1].idx()] + r.normal[c[2].idx()];
    return area.unitSafe().dot(skin.unitSafe()) > kSmallestFacing;
}

void split_long_edges(Remesher& r)
{
    const std::size_t before = r.mesh.n_edges();
    for (std::size_t i = 0; i < before; ++i) {
        const Edge e(static_cast<int>(i));
        const Halfedge h = r.mesh.halfedge_handle(e, 0);
        const Vertex a = r.mesh.from_vertex_handle(h), b = r.mesh.to_vertex_handle(h);
        if (r.mesh.calc_edge_length(e) <= 4.0 / 3.0 * target_of(r, a, b))
            continue;
        const Vec3d middle = project(r.field, to_vec(r.mesh.calc_edge_midpoint(e)));
        const double target = target_of(r, a, b);
        r.mesh.split(e, r.mesh.add_vertex(to_point(middle)));
        r.target.push_back(target);
        r.normal.push_back(gradient(r.field, middle).unitSafe());
    }
}

/// Whether pulling the halfedge's start onto its end leaves good triangles and no long edge.
bool may_collapse(const Remesher& r, Halfedge h)
{
    const Vertex from = r.mesh.from_vertex_handle(h), to = r.mesh.to_vertex_handle(h);
    for (const Vertex v : r.mesh.vv_range(from))
        if ((r.mesh.point(v) - r.mesh.point(to)).length() > 4.0 / 3.0 * target_of(r, v, to))
            return false;
    for (const Face f : r.mesh.vf_range(from)) {
        std::array<Vertex, 3> corners;
        std::array<Vec3d, 3> points;
        bool vanishes = false;
        std::size_t k = 0;
        for (const Vertex v : r.mesh.fv_range(f)) {
            vanishes = vanishes || v == to;
            corners[k] = v == from ? to : v;
            points[k] = to_vec(r.mesh.point(corners[k]));
            ++k;
        }
        if (!vanishes && !acceptable(r, corners, points))
            return false;
    }
    return true;
}

void collapse_short_edges(Remesher& r)
{
    for (std::size_t i = 0; i < r.mesh.n_edges(); ++i) {
        const Edge e(static_cast<int>(i));
        if (r.mesh.status(e).deleted())
            continue;
        const Halfedge h = r.mesh.halfedge_handle(e, 0);
        const Vertex a = r.mesh.from_vertex_handle(h), b = r.mesh.to_vertex_handle(h);
        if (r.mesh.calc_edge_length(e) >= 0.8 * target_of(r, a, b))
            continue;
        for (const int side : {0, 1}) {
            const Halfedge way = r.mesh.halfedge_handle(e, side);
            if (r.mesh.is_collapse_ok(way) && may_collapse(r, way)) {
                r.mesh.collapse(way);
                break;
            }
        }
    }
    // Moves vertices to other indices: measure() has to follow.
    r.mesh.garbage_collection();
}

/// Towards six edges a vertex, and away from bad triangles.
void flip_edges(Remesher& r)
{
    for (std::size_t i = 0; i < r.mesh.n_edges(); ++i) {
        const Edge e(static_cast<int>(i));
        if (!r.mesh.is_flip_ok(e))
            continue;
        const Halfedge h = r.mesh.halfedge_handle(e, 0), g = r.mesh.halfedge_handle(e, 1);
        const Vertex a = r.mesh.from_vertex_handle(h), b = r.mesh.to_vertex_handle(h);
        const Vertex c = r.mesh.opposite_vh(h), d = r.mesh.opposite_vh(g);
        const auto excess = [&](Vertex v, int change) {
            const int off = static_cast<int>(r.mesh.valence(v)) + change - 6;
            return off * off;
        };
        const int before = excess(a, 0) + excess(b, 0) + excess(c, 0) + excess(d, 0);
        const int after = excess(a, -1) + excess(b, -1) + excess(c, 1) + excess(d, 1);
        const auto good = [&](Vertex x, Vertex y, Vertex z) {
            return acceptable(
                r, {x, y, z},
                {to_vec(r.mesh.point(x)), to_vec(r.mesh.point(y)), to_vec(r.mesh.point(z))});
        };
        const bool mend = !good(a, b, c) || !good(b, a, d);
        if ((mend || after < before) && good(c, a, d) && good(d, b, c))
            r.mesh.flip(e);
    }
}

/// Moves each vertex towards the middle of its neighbours along the skin, and onto the skin.
Vec3d relaxed(const Remesher& r, Vertex v)
{
    Vec3d sum(0.0);
    double weight = 0.0;
    for (const Vertex w : r.mesh.vv_range(v)) {
        sum += to_vec(r.mesh.point(w));
        weight += 1.0;
    }
    const Vec3d p = to_vec(r.mesh.point(v)), n = r.normal[v.idx()];
    const Vec3d move = sum / weight - p;
    return project(r.field, p + (move - n * move.dot(n)) * 0.7);
}

void relax(Remesher& r)
{
    std::vector<Vec3d> moved(r.mesh.n_vertices());
    for_each_vertex(r.mesh, [&](Vertex v) { moved[v.idx()] = relaxed(r, v); });
    for (const Vertex v : r.mesh.vertices()) {
        const Point kept = r.mesh.point(v);
        const Vec3d kept_normal = r.normal[v.idx()];
        r.mesh.set_point(v, to_point(moved[v.idx()]));
        r.normal[v.idx()] = gradient(r.field, moved[v.idx()]).unitSafe();
        bool good = true;
        for (const Face f : r.mesh.vf_range(v)) {
            std::array<Vertex, 3> corners;
            std::array<Vec3d, 3> points;
            std::size_t k = 0;
            for (const Vertex w : r.mesh.fv_range(f)) {
                corners[k] = w;
                points[k++] = to_vec(r.mesh.point(w));
            }
            good = good && acceptable(r, corners, points);
        }
        if (!good) {
            r.mesh.set_point(v, kept);
            r.normal[v.idx()] = kept_normal;
        }
    }
}

Mesh half_edges(const PolygonMesh& triangles)
{
    Mesh mesh;
    mesh.request_vertex_status();
    mesh.request_edge_status();
    mesh.request_halfedge_status();
    mesh.request_face_status();
    for (const Vec3d& p : triangles.points)
        mesh.add_vertex(to_point(p));
    for (const Polygon& t : triangles.faces)
        mesh.add_face(Vertex(static_cast<int>(t[0])), Vertex(static_cast<int>(t[1])),
                      Vertex(static_cast<int>(t[2])));
    return mesh;
}

} // namespace

PolygonMesh remesh(const PolygonMesh& triangles, const Field& field, const RemeshOptions& options)
{
    Remesher r{field, options, half_edges(triangles)};
    std::vector<Vec3d> projected(r.mesh.n_vertices());
    for_each_vertex(
        r.mesh, [&](Vertex v) { projected[v.idx()] = project(field, to_vec(r.mesh.point(v))); });
    for (const Vertex v : r.mesh.vertices())
        r.mesh.set_point(v, to_point(projected[v.idx()]));
    for (int round = 0; round < options.rounds; ++round) {
        measure(r);
        split_long_edges(r);
        collapse_short_edges(r);
        measure(r);
        flip_edges(r);
        relax(r);
    }
    for (int i = 0; i < 4; ++i) {
        flip_edges(r);
        relax(r);
    }
    PolygonMesh result;
    for (const Vertex v : r.mesh.vertices())
        result.points.push_back(to_vec(r.mesh.point(v)));
    for (const Face f : r.mesh.faces()) {
        Polygon corners;
        for (const Vertex v : r.mesh.fv_range(f))
            corners.push_back(static_cast<std::uint32_t>(v.idx()));
        result.faces.push_back(corners);
    }
    return result;
}

} // namespace vdb_shell::samples

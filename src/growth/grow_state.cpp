// SPDX-License-Identifier: Apache-2.0

// Takes: the surface and the caps. Leaves: the state in which growth begins, with every inner point
// on its outer one; the scales that all lengths and errors are put in relation to; and all that
// growth needs to know of the surface as a whole. Points are float32 values held as doubles, so
// that what is computed and tested is what will be written. Trap: no vertex is marked as pinned
// yet, so the state passes no test before pillars have been placed (place_pillars.h).

#include "growth/grow_state.h"

#include "core/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace vdb_shell::growth
{

namespace
{

Box box_around(const std::vector<Vec3d>& points)
{
    Box b;
    for (const Vec3d& p : points)
        b.add(p);
    return b;
}

std::vector<int> first_of_each_component(const Connectivity& c)
{
    std::vector<int> witness;
    std::vector<std::uint8_t> seen(static_cast<std::size_t>(c.components), 0);
    for (int v = 0; v < c.vertices; ++v) {
        // One vertex stands for its component: components do not touch each other, so one of them
        // lies as a whole inside the shell of another or as a whole outside. A vertex of no
        // triangle belongs to no surface.
        if (seen[c.component[v]] || star(c, v).size() == 0)
            continue;
        seen[c.component[v]] = 1;
        witness.push_back(v);
    }
    return witness;
}

FloatBox inner_box(const GrowState& s, std::size_t f)
{
    return float_box_of(inner_corners(s, static_cast<int>(f)));
}

double longest_finite(const std::vector<double>& lengths)
{
    double longest = 0;
    for (const double length : lengths)
        longest = std::isfinite(length) ? std::max(longest, length) : longest;
    return longest;
}

} // namespace

GrowState make_state(const Connectivity& mesh, const std::vector<Vec3s>& outer,
                     const std::vector<double>& cap, const GrowthSchedule& schedule)
{
    GrowState s;
    s.mesh = &mesh;
    s.schedule = schedule;
    s.a.assign(outer.begin(), outer.end());
    s.b = s.trust_centre = s.a;
    s.cap = cap;
    s.pinned.assign(outer.size(), 0);
    s.trust_radius.assign(outer.size(), 0.0);
    // Diagonals that do not conform yet: under the twelve-tet test every order is valid, and a
    // conforming one is chosen before it matters (order_by_length, improve).
    s.order.assign(mesh.faces.size(), 0);
    // Outer triangles never move: their tree is built once, that of the inner ones in each round.
    s.outer_tree.build(mesh.faces.size(), [&](std::size_t f) {
        return float_box_of(outer_corners(s, static_cast<int>(f)));
    });
    const Box all = box_around(s.a);
    s.diagonal = outer.empty() ? 0 : (all.hi - all.lo).length();
    double largest = 0;
    for (const Vec3d& p : s.a)
        for (int k = 0; k < 3; ++k)
            largest = std::max(largest, std::abs(p[k]));
    // A reversed surface has a negative volume, and what lies behind its triangles has no bound.
    s.bounded = volume6(s.a, mesh.faces) > 0;
    // Inner points of a bounded side lie within the surface's own box, others beyond it.
    if (!s.bounded)
        largest += longest_finite(cap);
    // To nearest, each coordinate is off by half an epsilon of its size at most, so the point by
    // less than a whole one.
    s.rounding = largest * double(std::numeric_limits<float>::epsilon());
    s.witness = first_of_each_component(mesh);
    return s;
}

void put_shell(GrowState& s, const PrismShell& shell, const std::vector<PrismOrder>& order)
{
    s.b.assign(shell.inner.begin(), shell.inner.end());
    for (std::size_t v = 0; v < s.b.size(); ++v)
        s.pinned[v] = s.b[v] == s.a[v];
    s.order = order_indices(order);
    // Rounds build the tree anew, but pins are released before the first of them.
    build_inner_tree(s);
}

PrismShell shell_of(const TriangleMesh& mesh, const GrowState& s)
{
    PrismShell shell{mesh.points, mesh.points, mesh.triangles, {}};
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
        if (!s.pinned[v])
            shell.inner[v] = openvdb::Vec3s(s.b[v]);
    return shell;
}

PrismShell shell_out_of_order(const PrismShell& shell, const MeshOrder& order)
{
    PrismShell before;
    before.outer = out_of_order(shell.outer, order.vertices);
    before.inner = out_of_order(shell.inner, order.vertices);
    if (!shell.stop.empty())
        before.stop = out_of_order(shell.stop, order.vertices);
    before.triangles = out_of_order(shell.triangles, order.triangles);
    for_each_index(before.triangles.size(), [&](std::size_t t) {
        for (int k = 0; k < 3; ++k)
            before.triangles[t][k] = order.vertices[before.triangles[t][k]];
    });
    return before;
}

double volume6(const std::vector<Vec3d>& p, const std::vector<Vec3I>& faces)
{
    if (p.empty())
        return 0;
    // Relative to a point of the surface, so that a solid far from the origin loses no digits.
    const Vec3d origin = p[0];
    return sum_in_order(faces.size(), [&](std::size_t i) {
        const Vec3I& f = faces[i];
        return (p[f[0]] - origin).dot((p[f[1]] - origin).cross(p[f[2]] - origin));
    });
}

Vec3d inner_volume6_gradient(const GrowState& s, int v)
{
    const Connectivity& m = *s.mesh;
    // The volume is affine in one vertex: twice the area vector of its star, pointing outward.
    Vec3d sum(0.0);
    for (const FaceCorner& at : star(m, v)) {
        const Vec3d u = s.b[m.corner(at.face, (at.local + 1) % 3)] - s.b[v];
        const Vec3d w = s.b[m.corner(at.face, (at.local + 2) % 3)] - s.b[v];
        sum += u.cross(w);
    }
    return sum;
}

double fill_of(const GrowState& s)
{
    // Outward, the grown surface encloses more than the given one, not less.
    const double ratio = volume6(s.b, s.mesh->faces) / volume6(s.a, s.mesh->faces);
    return s.bounded ? 1 - ratio : ratio - 1;
}

bool bounds_thickness(const std::vector<double>& cap)
{
    return std::any_of(cap.begin(), cap.end(), [](double c) { return c > 0 && std::isfinite(c); });
}

bool fills_void(const GrowState& s)
{
    return s.bounded && !bounds_thickness(s.cap);
}

std::ptrdiff_t count_pins(const GrowState& s)
{
    return std::count(s.pinned.begin(), s.pinned.end(), 1);
}

void build_inner_tree(GrowState& s)
{
    s.inner_tree.build(s.mesh->faces.size(), [&](std::size_t f) { return inner_box(s, f); });
}

void refit_inner_tree(GrowState& s, const std::vector<std::uint8_t>& changed)
{
    assert(s.inner_tree.size() == s.mesh->faces.size());
    s.inner_tree.refit([&](std::size_t f) { return inner_box(s, f); }, changed);
}

Box box_of_star(const GrowState& s, int v, const Vec3d& x)
{
    Box box;
    box.add(x);
    for (const int u : neighbours(*s.mesh, v))
        box.add(s.b[u]);
    return box;
}

} // namespace vdb_shell::growth

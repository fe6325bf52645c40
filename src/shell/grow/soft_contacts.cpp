// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/soft_contacts.h"

#include "shell/grow/candidates.h"

namespace vdb_shell::growth
{
namespace
{

// A corner that meets a star's triangle far from b_v hardly restrains b_v.
constexpr double kLeastWeight = 0.02;

/// Closest point of the triangle to p, its barycentric weights in `weight` (Ericson 2005,
/// "Real-Time Collision Detection", 5.1.5).
Vec3d closest_on_triangle(const Vec3d& p, const Corners& t, Vec3d& weight)
{
    const Vec3d ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    const auto at = [&](double u, double v, double w) {
        weight = {u, v, w};
        return t[0] * u + t[1] * v + t[2] * w;
    };
    if (d1 <= 0 && d2 <= 0)
        return at(1, 0, 0);
    const Vec3d bp = p - t[1];
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3)
        return at(0, 1, 0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return at(1 - d1 / (d1 - d3), d1 / (d1 - d3), 0);
    const Vec3d cp = p - t[2];
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6)
        return at(0, 0, 1);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return at(1 - d2 / (d2 - d6), 0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return at(0, 1 - w, w);
    }
    const double sum = va + vb + vc;
    return at(va / sum, vb / sum, vc / sum);
}

bool near_box(const Box& b, const Vec3d& p, double range)
{
    for (int k = 0; k < 3; ++k)
        if (p[k] < b.lo[k] - range || p[k] > b.hi[k] + range)
            return false;
    return true;
}

/// b_v against the triangles close to it.
void bounds_of_vertex(const GrowState& s, int v, double range, const ContactScratch& scratch,
                      std::vector<HalfSpace>& bounds)
{
    const int faces = s.mesh->face_count();
    const Vec3d& x = s.b[v];
    Vec3d weight;
    for (const int id : scratch.near) {
        const bool inner = id < faces;
        const int g = inner ? id : id - faces;
        if (!near_box(inner ? s.inner_box[g] : s.outer_box[g], x, range))
            continue;
        const Vec3d q =
            closest_on_triangle(x, inner ? inner_corners(s, g) : outer_corners(s, g), weight);
        const double distance = (x - q).length();
        if (distance > 0 && distance < range)
            bounds.push_back({(x - q) / distance, q});
    }
}

/// The star's triangles against corners close to them.
void bounds_of_star(const GrowState& s, int v, double range, const ContactScratch& scratch,
                    std::vector<HalfSpace>& bounds)
{
    const Connectivity& m = *s.mesh;
    const Vec3d& x = s.b[v];
    Vec3d weight;
    for (const FaceCorner& at : star(m, v)) {
        const Corners c = inner_corners(s, at.face);
        for (const int id : scratch.corner) {
            const bool inner = id >= m.vertices;
            const int u = inner ? id - m.vertices : id;
            const Vec3d& p = inner ? s.b[u] : s.a[u];
            if (!near_box(s.inner_box[at.face], p, range))
                continue;
            if (inner ? m.incident_to(at.face, u) : u == v)
                continue;
            const Vec3d q = closest_on_triangle(p, c, weight);
            const double distance = (q - p).length(), share = weight[at.local];
            if (distance <= 0 || distance >= range || share < kLeastWeight)
                continue;
            // The gap closes by the share of b_v's motion at q: gap(x) = distance + share (x-b_v).n
            const Vec3d n = (q - p) * (share / distance);
            bounds.push_back({n, x - n * (distance / n.lengthSqr())});
        }
    }
}

void gather(const GrowState& s, int v, const Box& box, ContactScratch& scratch)
{
    const Connectivity& m = *s.mesh;
    const int faces = m.face_count();
    scratch.near.clear(2 * m.faces.size());
    scratch.corner.clear(2 * s.b.size());
    for (const FaceCorner& at : star(m, v)) {
        for (const int g : s.near_inner[at.face])
            if (box.overlaps(s.inner_box[g]) && !m.incident_to(g, v))
                scratch.near.add(g);
        for (const int g : s.near_outer[at.face])
            if (box.overlaps(s.outer_box[g]) && !m.incident_to(g, v))
                scratch.near.add(faces + g);
    }
    for (const int id : scratch.near)
        for (int k = 0; k < 3; ++k) {
            const bool inner = id < faces;
            const int u = m.corner(inner ? id : id - faces, k);
            if (box.contains(inner ? s.b[u] : s.a[u]))
                scratch.corner.add(inner ? m.vertices + u : u);
        }
}

} // namespace

void contact_bounds(const GrowState& s, int v, ContactScratch& scratch,
                    std::vector<HalfSpace>& bounds)
{
    const double range = kSoftRange * s.reach[v];
    Box box;
    for (const FaceCorner& at : star(*s.mesh, v))
        box.add(s.inner_box[at.face]);
    box.inflate(range);
    gather(s, v, box, scratch);
    bounds_of_vertex(s, v, range, scratch, bounds);
    bounds_of_star(s, v, range, scratch, bounds);
}

} // namespace vdb_shell::growth

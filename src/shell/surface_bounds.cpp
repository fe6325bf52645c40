// SPDX-License-Identifier: Apache-2.0

// Takes: a surface. Gives: how good the tets on its triangles can be at best. Closed formulas, for
// they have to hold for any shell (docs/theory.md, "What the surface bounds"): the least AMIPS over
// all places of the fourth corner, the least ratio of edges, and the half of each edge's angle,
// which two tets have to share. In doubles; nothing is decided by them.

#include "vdb_shell/shell/surface_bounds.h"

#include "mesh/topology.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

constexpr double kPi = 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRegularDihedral = 1.2309594173407747; // arccos(1/3)

Vec3d corner(const TriangleMesh& mesh, std::uint32_t triangle, int local)
{
    return Vec3d(mesh.points[mesh.triangles[triangle][local]]);
}

Vec3d normal_of(const TriangleMesh& mesh, std::uint32_t triangle)
{
    const Vec3d a = corner(mesh, triangle, 0);
    return (corner(mesh, triangle, 1) - a).cross(corner(mesh, triangle, 2) - a);
}

/// The angle of the solid between the triangles of two uses of an edge.
double angle_inside(const TriangleMesh& mesh, const EdgeUse& first, const EdgeUse& second)
{
    const Vec3d n = normal_of(mesh, first.triangle), m = normal_of(mesh, second.triangle);
    const Vec3d edge = corner(mesh, first.triangle, (first.side + 1) % 3) -
                       corner(mesh, first.triangle, first.side);
    // Both normals are perpendicular to the edge. It is convex where they turn about it forward.
    const double turn = std::atan2(n.cross(m).dot(edge) / edge.length(), n.dot(m));
    return kPi - turn;
}

double angle_on_side(double inside, Side side)
{
    switch (side) {
    case Side::inward:
        return inside;
    case Side::outward:
        return 2 * kPi - inside;
    case Side::both:
        break;
    }
    return std::min(inside, 2 * kPi - inside);
}

} // namespace

double least_amips(const Vec3d& a, const Vec3d& b, const Vec3d& c)
{
    constexpr double kFourRootsOfThree = 6.9282032302755088;
    const double edges = (b - a).lengthSqr() + (c - b).lengthSqr() + (a - c).lengthSqr();
    const double double_area = (b - a).cross(c - a).length();
    if (!(double_area > 0))
        return kInfinity;
    const double ratio = 2 * edges / (kFourRootsOfThree * double_area);
    return 3 * std::cbrt(ratio * ratio);
}

double least_edge_ratio(const Vec3d& a, const Vec3d& b, const Vec3d& c)
{
    const auto [least, most] =
        std::minmax({(b - a).lengthSqr(), (c - b).lengthSqr(), (a - c).lengthSqr()});
    return least > 0 ? std::sqrt(most / least) : kInfinity;
}

std::vector<EdgeAngle> edge_angles(const TriangleMesh& surface, Side side)
{
    const EdgeUses uses = sorted_edge_uses(surface.triangles);
    std::vector<EdgeAngle> angles;
    for (std::size_t i = 0, next = 0; i < uses.size(); i = next) {
        for (next = i; next < uses.size() && uses[next].edge == uses[i].edge;)
            ++next;
        if (next == i + 2)
            angles.push_back(
                {uses[i].edge, angle_on_side(angle_inside(surface, uses[i], uses[i + 1]), side)});
    }
    return angles;
}

SurfaceBounds measure_surface_bounds(const TriangleMesh& surface, Side side)
{
    SurfaceBounds bounds;
    std::vector<double> amips, ratio, dihedral;
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        const Vec3d a = corner(surface, t, 0), b = corner(surface, t, 1), c = corner(surface, t, 2);
        amips.push_back(least_amips(a, b, c));
        ratio.push_back(least_edge_ratio(a, b, c));
        bounds.sofa_bad += ratio.back() > kSofaEdgeRatio;
    }
    for (const EdgeAngle& at : edge_angles(surface, side))
        dihedral.push_back(std::min(at.radians / 2, kRegularDihedral));
    // A triangle whose area is lost to the rounding of doubles has no figure that could be shown.
    const auto finite = [](std::vector<double> values) {
        values.erase(std::remove(values.begin(), values.end(), kInfinity), values.end());
        return spread_of(std::move(values));
    };
    bounds.amips = finite(std::move(amips));
    bounds.edge_ratio = finite(std::move(ratio));
    bounds.min_dihedral_radians = spread_of(std::move(dihedral));
    return bounds;
}

} // namespace vdb_shell

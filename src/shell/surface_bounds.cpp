// SPDX-License-Identifier: Apache-2.0

// Takes: a surface. Gives: how good the tets on its triangles can be at best. Closed formulas, for
// they have to hold for any shell (docs/theory.md, "What the surface bounds"): the least AMIPS over
// all places of the fourth corner, the least ratio of edges, and the half of each edge's angle,
// which two tets have to share. In doubles; nothing is decided by them.

#include "vdb_shell/shell/surface_bounds.h"

#include "core/parallel.h"
#include "core/raw_vector.h"
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
    const auto begins_edge = [&](std::size_t i) {
        return i == 0 || uses[i].edge != uses[i - 1].edge;
    };
    // Edges of two triangles stand at the place of their first use, with others between them.
    constexpr double kNone = -1;
    RawVector<double> radians(uses.size());
    for_each_index(
        uses.size(),
        [&](std::size_t i) {
            const bool of_two = begins_edge(i) && i + 1 < uses.size() && !begins_edge(i + 1) &&
                                (i + 2 == uses.size() || begins_edge(i + 2));
            radians[i] =
                of_two ? angle_on_side(angle_inside(surface, uses[i], uses[i + 1]), side) : kNone;
        },
        1024);
    std::vector<EdgeAngle> angles;
    angles.reserve(uses.size() / 2);
    for (std::size_t i = 0; i < uses.size(); ++i)
        if (radians[i] != kNone)
            angles.push_back({uses[i].edge, radians[i]});
    return angles;
}

SurfaceBounds measure_surface_bounds(const TriangleMesh& surface, Side side)
{
    SurfaceBounds bounds;
    const std::size_t count = surface.triangles.size();
    std::vector<double> amips(count), ratio(count);
    for_each_index(
        count,
        [&](std::size_t i) {
            const auto t = static_cast<std::uint32_t>(i);
            const Vec3d a = corner(surface, t, 0), b = corner(surface, t, 1),
                        c = corner(surface, t, 2);
            amips[i] = least_amips(a, b, c);
            ratio[i] = least_edge_ratio(a, b, c);
        },
        1024);
    for (const double of_triangle : ratio)
        bounds.sofa_bad += of_triangle > kSofaEdgeRatio;
    std::vector<double> dihedral;
    {
        const std::vector<EdgeAngle> angles = edge_angles(surface, side);
        dihedral.reserve(angles.size());
        for (const EdgeAngle& at : angles)
            dihedral.push_back(std::min(at.radians / 2, kRegularDihedral));
    }
    // A triangle whose area is lost to the rounding of doubles has no figure that could be shown.
    const auto finite = [](std::vector<double> values) {
        values.erase(std::remove(values.begin(), values.end(), kInfinity), values.end());
        return spread_of(std::move(values));
    };
    run_together([&] { bounds.amips = finite(std::move(amips)); },
                 [&] { bounds.edge_ratio = finite(std::move(ratio)); },
                 [&] { bounds.min_dihedral_radians = spread_of(std::move(dihedral)); });
    return bounds;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
// Bounds the lengths of lines by the local shape of the surface, as the two papers before line
// stepping did: K. Erleben and H. Dohlmann, "The Thin Shell Tetrahedral Mesh", 2004, with one
// length for all, and K. Erleben, H. Dohlmann and J. Sporring, "The Adaptive Thin Shell Tetrahedral
// Mesh", 2005, with one length for each vertex. The limits say nothing of parts of the surface that
// face each other, nor of pillars of different lengths, so a shell within all limits can overlap.

#include "vdb_shell/step/limits.h"

#include "core/parallel.h"
#include "core/text_stream.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// On a sphere all three quadratics have a double root, and rounding decides whether the
// discriminant comes out positive. A quadratic whose least value is this small a part of its own
// terms is taken to touch zero: the safe side.
constexpr double kTouching = 1e-10;

// Two directions that differ by less than this are parallel but for rounding, which would otherwise
// show as a fold at some absurd but finite length.
constexpr double kParallel = 1e-12;

Vec3d turn_between(const Vec3d& from, const Vec3d& to)
{
    const Vec3d turn = to - from;
    return turn.length() > kParallel ? turn : Vec3d(0.0);
}

/// Smallest positive root of a e^2 + b e + c, infinity where there is none.
double smallest_positive_root(double a, double b, double c)
{
    double discriminant = b * b - 4 * a * c;
    if (std::abs(discriminant) <= kTouching * b * b)
        discriminant = 0;
    if (!(discriminant >= 0))
        return kNoLimit;
    // This sum does not cancel, since the root has the sign of b. The textbook's other sum would
    // cancel, so the second root comes from the product of both roots, which is c / a.
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    double smallest = kNoLimit;
    for (const double root : {q / a, c / q})
        // Where a or q is zero, a quotient is infinite or not a number, and then one of the two
        // comparisons fails. So linear and constant polynomials need no branch of their own.
        if (root > 0 && root < smallest)
            smallest = root;
    return smallest;
}

/// The triangle at length e has the edges edge + e turn, so its area vector is a quadratic in e.
/// Its product with the outward direction of pillar i is the Jacobian of the prism's map on that
/// pillar. The Jacobian is linear in the barycentric coordinates, so the first zero in the prism is
/// on one of the three pillars. Lengths are in world units.
double triangle_limit(const TriangleMesh& mesh, const Directions& directions,
                      const openvdb::Vec3I& t)
{
    const Vec3d p0(mesh.points[t[0]]);
    const Vec3d edge1 = Vec3d(mesh.points[t[1]]) - p0, edge2 = Vec3d(mesh.points[t[2]]) - p0;
    const Vec3d& d0 = directions.inward[t[0]];
    const Vec3d turn1 = turn_between(d0, directions.inward[t[1]]);
    const Vec3d turn2 = turn_between(d0, directions.inward[t[2]]);
    const Vec3d a = turn1.cross(turn2);
    const Vec3d b = edge1.cross(turn2) + turn1.cross(edge2);
    const Vec3d c = edge1.cross(edge2);
    double limit = kNoLimit;
    for (int i = 0; i < 3; ++i) {
        const Vec3d n = -directions.inward[t[i]];
        limit = std::min(limit, smallest_positive_root(n.dot(a), n.dot(b), n.dot(c)));
    }
    return limit;
}

} // namespace

const NameTable<Limit>& names(Limit)
{
    static const NameTable<Limit> table{
        {"none", Limit::none}, {"uniform", Limit::uniform}, {"adaptive", Limit::adaptive}};
    return table;
}

OptionList describe(LimitOptions& o)
{
    return in_group("Lines",
                    {option("limit", o.limit, "--limit", "Thin-shell limit on the lengths")});
}

std::vector<double> triangle_limits(const TriangleMesh& mesh, const Directions& directions)
{
    assert(directions.inward.size() == mesh.points.size());
    std::vector<double> limits(mesh.triangles.size());
    for_each_index(limits.size(), [&](std::size_t t) {
        limits[t] = triangle_limit(mesh, directions, mesh.triangles[t]);
    });
    return limits;
}

std::vector<double> vertex_limits(const TriangleMesh& mesh, const Directions& directions,
                                  Limit limit)
{
    std::vector<double> limits(mesh.points.size(), kNoLimit);
    if (limit == Limit::none)
        return limits;
    const std::vector<double> of_triangle = triangle_limits(mesh, directions);
    if (limit == Limit::uniform) {
        double smallest = kNoLimit;
        for (const double one : of_triangle)
            smallest = std::min(smallest, one);
        std::fill(limits.begin(), limits.end(), smallest);
        return limits;
    }
    for (std::size_t t = 0; t < of_triangle.size(); ++t)
        for (int i = 0; i < 3; ++i) {
            double& bound = limits[mesh.triangles[t][i]];
            bound = std::min(bound, of_triangle[t]);
        }
    return limits;
}

void apply_limits(LineLengths& lengths, const std::vector<double>& limits)
{
    assert(limits.size() == lengths.length.size());
    for (std::size_t v = 0; v < limits.size(); ++v) {
        if (limits[v] < lengths.length[v]) {
            lengths.length[v] = limits[v];
            lengths.reason[v] = StopReason::limit;
        }
        if (!std::isfinite(lengths.length[v])) {
            OutText message;
            message << "limits: vertex " << v << " has no bound on its length ("
                    << lengths.length[v]
                    << "): the surface never folds there; give a thickness or a stop test";
            throw GeometryError(message.str());
        }
    }
}

} // namespace vdb_shell

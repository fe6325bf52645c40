// SPDX-License-Identifier: Apache-2.0

// Takes the normals of a star. Gives the direction that sees the worst of its triangles best. Where
// even that sees one from behind, no pillar can stand (docs/theory.md, "Growth").

#include "mesh/most_visible.h"

#include "core/exact.h"
#include "core/orient3d_filter.h"
#include "core/parallel.h"
#include "core/star_sight.h"
#include "core/unit_vector.h"
#include "mesh/topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

// All triples of so many normals are tried; of more, only of those that matter.
constexpr std::size_t kSmallStar = 16;

/// A direction, and the one, two or three normals that have the smallest dot product with it: it is
/// one of them, or halfway between two, or as far from each of three.
struct Optimum {
    Vec3d direction{0.0};
    double least = -2;
    std::vector<Vec3d> touching;
};

Optimum best_of_few(const std::vector<Vec3d>& n)
{
    Optimum best;
    std::array<std::size_t, 3> touching{};
    std::size_t count = 0;
    const auto consider = [&](const Vec3d& candidate, std::array<std::size_t, 3> of,
                              std::size_t size) {
        const Vec3d d = unit_vector(candidate);
        const double dot = smallest_dot(n, d);
        if (d.lengthSqr() > 0 && dot > best.least) {
            best.least = dot;
            best.direction = d;
            touching = of;
            count = size;
        }
    };
    for (std::size_t i = 0; i < n.size(); ++i) {
        consider(n[i], {i}, 1);
        for (std::size_t j = 0; j < i; ++j) {
            consider(n[i] + n[j], {i, j}, 2);
            for (std::size_t l = 0; l < j; ++l) {
                const Vec3d c = (n[j] - n[i]).cross(n[l] - n[i]);
                consider(c, {i, j, l}, 3);
                consider(-c, {i, j, l}, 3);
            }
        }
    }
    for (std::size_t k = 0; k < count; ++k)
        best.touching.push_back(n[touching[k]]);
    return best;
}

/// Three normals decide, and which ones they are is found by taking in the one that the best
/// direction so far sees worst, and leaving out those that it does not touch: an LP-type problem
/// (Sharir and Welzl 1992, "A combinatorial bound for linear programming and related problems").
/// The value falls with each step, so no three come twice. Where no direction sees all of some
/// four, the best one for these is given.
Vec3d most_visible_of_many(const std::vector<Vec3d>& n)
{
    Optimum best{n[0], 1, {n[0]}};
    while (best.least > 0) {
        const Vec3d worst =
            *std::min_element(n.begin(), n.end(), [&](const Vec3d& x, const Vec3d& y) {
                return x.dot(best.direction) < y.dot(best.direction);
            });
        if (!(worst.dot(best.direction) < best.least))
            break;
        std::vector<Vec3d> taken = best.touching;
        taken.push_back(worst);
        Optimum next = best_of_few(taken);
        // What does not fall is the rounding of the same value.
        if (!(next.least < best.least))
            break;
        best = std::move(next);
    }
    return best.direction;
}

} // namespace

double smallest_dot(const std::vector<Vec3d>& normals, const Vec3d& d)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3d& n : normals)
        least = std::min(least, n.dot(d));
    return least;
}

Vec3d most_visible(const std::vector<Vec3d>& normals)
{
    if (normals.empty())
        return Vec3d(0.0);
    return normals.size() <= kSmallStar ? best_of_few(normals).direction
                                        : most_visible_of_many(normals);
}

std::vector<Vec3d> star_normals(const TriangleMesh& mesh, const VertexTriangles::Range& around)
{
    std::vector<Vec3d> normals;
    for (const std::uint32_t triangle : around) {
        const Vec3I& t = mesh.triangles[triangle];
        const Vec3d a(mesh.points[t[0]]);
        const Vec3d n =
            unit_vector((Vec3d(mesh.points[t[2]]) - a).cross(Vec3d(mesh.points[t[1]]) - a));
        if (n.lengthSqr() > 0)
            normals.push_back(n);
    }
    return normals;
}

namespace
{

/// A star's triangles as what they look like from its vertex, and their inward unit normals. Kept
/// from vertex to vertex: most need no more memory than the one before.
struct SeenStar {
    std::vector<exact::Side> sides;
    std::vector<Vec3d> normals;
};

/// The triangles at a vertex that have an area.
void list_sides(const TriangleMesh& mesh, const VertexTriangles::Range& around,
                std::uint32_t vertex, std::vector<exact::Side>& sides)
{
    sides.clear();
    for (const std::uint32_t t : around) {
        const Vec3I& c = mesh.triangles[t];
        const int k = c[0] == vertex ? 0 : c[1] == vertex ? 1 : 2;
        const Vec3s &p = mesh.points[c[(k + 1) % 3]], &q = mesh.points[c[(k + 2) % 3]];
        const Vec3d apex(mesh.points[vertex]);
        // What is zero in doubles may have an area of a few bits; only then is it worth asking.
        if ((Vec3d(p) - apex).cross(Vec3d(q) - apex).lengthSqr() > 0 ||
            !exact::collinear(mesh.points[vertex], p, q))
            sides.push_back({p, q});
    }
}

Vec3d inward(const Vec3d& apex, const exact::Side& side)
{
    return (Vec3d(side[1]) - apex).cross(Vec3d(side[0]) - apex);
}

/// Whether doubles show that d sees all sides; false tells nothing.
bool surely_sees(const Vec3d& apex, const std::vector<exact::Side>& sides, const Vec3d& d)
{
    return std::all_of(sides.begin(), sides.end(), [&](const exact::Side& side) {
        return exact::certain_triple_sign(d, Vec3d(side[1]) - apex, Vec3d(side[0]) - apex) > 0;
    });
}

/// Two directions are tried in doubles: the mean of the normals, which is enough nearly
/// everywhere, and the best one. Exact numbers decide where neither is sure.
bool is_blind(const TriangleMesh& mesh, const VertexTriangles::Range& around, std::uint32_t vertex,
              SeenStar& star)
{
    list_sides(mesh, around, vertex, star.sides);
    const Vec3d apex(mesh.points[vertex]);
    star.normals.clear();
    Vec3d mean(0.0);
    for (const exact::Side& side : star.sides) {
        star.normals.push_back(unit_vector(inward(apex, side)));
        mean += star.normals.back();
    }
    return !surely_sees(apex, star.sides, mean) &&
           !surely_sees(apex, star.sides, most_visible(star.normals)) &&
           !exact::a_direction_sees(mesh.points[vertex], star.sides);
}

} // namespace

std::vector<std::uint32_t> blind_vertices(const TriangleMesh& mesh)
{
    const VertexTriangles stars = triangles_around_vertices(mesh.points.size(), mesh.triangles);
    std::vector<char> blind(mesh.points.size());
    for_each_range(blind.size(), [&](std::size_t begin, std::size_t end) {
        SeenStar star;
        for (std::size_t v = begin; v < end; ++v)
            blind[v] = is_blind(mesh, stars.around(v), static_cast<std::uint32_t>(v), star);
    });
    std::vector<std::uint32_t> list;
    for (std::uint32_t v = 0; v < blind.size(); ++v)
        if (blind[v])
            list.push_back(v);
    return list;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes: triangles that close up. Gives: the sign of the volume that they enclose, always the right
// one. Doubles with a bound on their error decide it unless the volume is about as small as that
// bound; whole numbers of any size decide the rest, at many times the cost. No triangle has to be
// embedded or sound: the sum over the cones is the volume for any closed list. Doubles alone would
// not do, because condition 4 of docs/theory.md, "The whole shell", is one of those that the proof
// rests on.

#include "mesh/exact_volume.h"

#include "core/parallel.h"

#include <CGAL/Exact_integer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdb_shell::exact
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// Six volumes of the cone from `apex` over a triangle.
double cone(const Vec3s& apex, const Vec3s& a, const Vec3s& b, const Vec3s& c)
{
    // Differences are rounded once, as coordinates of very different size need more digits than a
    // double has.
    const Vec3d to_a = Vec3d(a) - Vec3d(apex), to_b = Vec3d(b) - Vec3d(apex),
                to_c = Vec3d(c) - Vec3d(apex);
    return to_a.dot(to_b.cross(to_c));
}

/// An upper bound, up to its own rounding, on the sum of the absolute products in cone(): there are
/// six, and none is larger than the product of the largest coordinates of the three corners as seen
/// from the apex.
double cone_bound(const Vec3s& apex, const Vec3s& a, const Vec3s& b, const Vec3s& c)
{
    double product = 6;
    for (const Vec3s* corner : {&a, &b, &c}) {
        double largest = 0;
        for (int k = 0; k < 3; ++k)
            largest = std::max(largest, std::abs(double((*corner)[k]) - double(apex[k])));
        product *= largest;
    }
    return product;
}

/// The exponent of a power of two, at most 1, of which the coordinates are multiples.
int lowest_bit(const Vec3s& point)
{
    int lowest = 0;
    for (int k = 0; k < 3; ++k)
        if (point[k] != 0)
            lowest = std::min(lowest, std::ilogb(point[k]) - std::numeric_limits<float>::digits);
    return lowest;
}
int lowest_bit(const std::vector<Vec3s>& points)
{
    int lowest = 0;
    for (const Vec3s& point : points)
        lowest = std::min(lowest, lowest_bit(point));
    return lowest;
}

/// Six volumes of the cone, in units of 2^(-3 shift).
CGAL::Exact_integer whole_cone(const Vec3s& apex, const Vec3s& a, const Vec3s& b, const Vec3s& c,
                               int shift)
{
    using Number = CGAL::Exact_integer;
    std::array<std::array<Number, 3>, 3> m;
    const std::array<const Vec3s*, 3> corner{&a, &b, &c};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            m[i][k] = Number(std::ldexp(double((*corner[i])[int(k)]), shift)) -
                      Number(std::ldexp(double(apex[int(k)]), shift));
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) +
           m[0][1] * (m[1][2] * m[2][0] - m[1][0] * m[2][2]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

} // namespace

int volume_sign(const std::vector<Vec3s>& points, const std::vector<Vec3I>& triangles,
                const std::vector<std::uint32_t>& chosen)
{
    if (chosen.empty())
        return 0;
    // Any apex gives the same volume for a closed surface. One of the surface's own corners keeps
    // the cones small, and the bound with them, far from the origin.
    const Vec3s& apex = points[triangles[chosen.front()][0]];
    // A term has fewer than eight roundings, each of at most 2^-53 of its bound, and every sum one
    // more of its own size; the factor of two is for the roundings of the bounds themselves.
    // Differences of float32 values are nought or at least 2^-149, so no product of three
    // underflows; the absolute term is a guard that no such sum depends on.
    double six_volumes = 0, bound = 0, of_sums = 0;
    for (const std::uint32_t t : chosen) {
        const Vec3I& v = triangles[t];
        six_volumes += cone(apex, points[v[0]], points[v[1]], points[v[2]]);
        bound += cone_bound(apex, points[v[0]], points[v[1]], points[v[2]]);
        of_sums += std::abs(six_volumes);
    }
    const double error = (8 * bound + of_sums) * std::ldexp(1.0, -52) + 1e-280;
    if (six_volumes > error)
        return 1;
    if (six_volumes < -error)
        return -1;
    int lowest = 0;
    for (const std::uint32_t t : chosen)
        for (int k = 0; k < 3; ++k)
            lowest = std::min(lowest, lowest_bit(points[triangles[t][k]]));
    CGAL::Exact_integer sum(0);
    for (const std::uint32_t t : chosen) {
        const Vec3I& v = triangles[t];
        sum += whole_cone(apex, points[v[0]], points[v[1]], points[v[2]], -lowest);
    }
    return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

std::vector<int> volume_signs(const std::vector<Vec3s>& points, const std::vector<Vec3I>& triangles,
                              const std::vector<int>& component_of_vertex, int count)
{
    std::vector<std::vector<std::uint32_t>> chosen(static_cast<std::size_t>(count));
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        chosen[std::size_t(component_of_vertex[triangles[t][0]])].push_back(t);
    std::vector<int> signs(chosen.size());
    for_each_index(signs.size(),
                   [&](std::size_t c) { signs[c] = volume_sign(points, triangles, chosen[c]); });
    return signs;
}

bool same_volume(const std::vector<Vec3s>& points, const std::vector<openvdb::Vec4I>& tets,
                 const std::vector<Vec3s>& surface_points, const std::vector<Vec3I>& triangles)
{
    // Whole numbers, as rationals spend most of their time on common divisors. One scale for all.
    const int shift = -std::min(lowest_bit(points), lowest_bit(surface_points));
    CGAL::Exact_integer difference(0);
    for (const openvdb::Vec4I& t : tets)
        difference += whole_cone(points[t[0]], points[t[1]], points[t[2]], points[t[3]], shift);
    // A closed surface encloses the same volume from every apex.
    const Vec3s apex(0);
    for (const Vec3I& t : triangles)
        difference -= whole_cone(apex, surface_points[t[0]], surface_points[t[1]],
                                 surface_points[t[2]], shift);
    return difference == 0;
}

} // namespace vdb_shell::exact

// SPDX-License-Identifier: Apache-2.0

// Takes the triangles around a point and decides without rounding whether a direction sees all of
// them from inside: whether linear inequalities n . x > 0, one for each normal, have a common
// solution. Normals are taken one after the other, with a solution of those before (Seidel 1991,
// "Small-dimensional linear programming and convex hulls made easy"). Where the next one fails, a
// solution of all, if there is one, is joined to the present one by a segment that crosses the
// plane of the new normal, and all points of it solve the others; so the question is the same in
// that plane, one dimension lower. From a solution there, a step along the new normal that is small
// enough solves all. docs/theory.md, "Growth", has the proof. A solution
// is made anew at each failure, so its numbers do not grow with the number of triangles; these are
// shuffled, so that the expected number of failures is their logarithm.

#include "core/star_sight.h"

#include <CGAL/Exact_rational.h>

#include <algorithm>
#include <cstddef>
#include <random>
#include <utility>

namespace vdb_shell::exact
{
namespace
{

using Number = CGAL::Exact_rational;
template <std::size_t N> using Vector = std::array<Number, N>;

template <std::size_t N> Number dot(const Vector<N>& a, const Vector<N>& b)
{
    Number sum = 0;
    for (std::size_t k = 0; k < N; ++k)
        sum += a[k] * b[k];
    return sum;
}

Vector<3> cross(const Vector<3>& a, const Vector<3>& b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Two vectors square to n and to each other. Precondition: n is not zero.
std::array<Vector<3>, 2> square_to(const Vector<3>& n)
{
    // The cross product with an axis along which n does not lie.
    Vector<3> axis{0, 0, 0};
    axis[n[0] == 0 ? 0 : n[1] == 0 ? 1 : 2] = 1;
    const Vector<3> u = cross(n, axis);
    return {u, cross(n, u)};
}

std::array<Vector<2>, 1> square_to(const Vector<2>& n)
{
    return {Vector<2>{-n[1], n[0]}};
}

/// Three that span what is square to n.
std::array<Vector<4>, 3> square_to(const Vector<4>& n)
{
    std::size_t pivot = 0;
    while (n[pivot] == 0)
        ++pivot;
    std::array<Vector<4>, 3> axes;
    for (std::size_t k = 0; k < axes.size(); ++k) {
        const std::size_t other = k < pivot ? k : k + 1;
        axes[k].fill(0);
        axes[k][other] = n[pivot];
        axes[k][pivot] = -n[other];
    }
    return axes;
}

template <std::size_t N> struct Search;

/// On a line: all have to point the same way.
template <> struct Search<1> {
    static bool solve(const std::vector<Vector<1>>& normals, Vector<1>& x)
    {
        x = {normals.empty() || normals[0][0] > 0 ? 1 : -1};
        return std::all_of(normals.begin(), normals.end(),
                           [&](const Vector<1>& n) { return n[0] * x[0] > 0; });
    }
};

template <std::size_t N> struct Search {
    /// Finds x with n . x > 0 for all of these.
    static bool solve(const std::vector<Vector<N>>& normals, Vector<N>& x)
    {
        x.fill(0);
        for (std::size_t i = 0; i < normals.size(); ++i)
            if (!(dot<N>(normals[i], x) > 0) && !solve_with(normals, i, x))
                return false;
        return true;
    }

private:
    /// Replaces a solution of the first i by one of these and the next.
    static bool solve_with(const std::vector<Vector<N>>& normals, std::size_t i, Vector<N>& x)
    {
        const Vector<N>& n = normals[i];
        if (dot<N>(n, n) == 0)
            return false;
        const auto axes = square_to(n);
        std::vector<Vector<N - 1>> within(i);
        for (std::size_t j = 0; j < i; ++j)
            for (std::size_t k = 0; k + 1 < N; ++k)
                within[j][k] = dot<N>(normals[j], axes[k]);
        Vector<N - 1> y;
        if (!Search<N - 1>::solve(within, y))
            return false;
        x.fill(0);
        for (std::size_t k = 0; k + 1 < N; ++k)
            for (std::size_t c = 0; c < N; ++c)
                x[c] += y[k] * axes[k][c];
        // Half of the way to where the first of the others would fail.
        Number step = 1;
        for (std::size_t j = 0; j < i; ++j) {
            const Number along = dot<N>(normals[j], n);
            if (along < 0)
                step = std::min(step, Number(dot<N>(normals[j], x) / (-2 * along)));
        }
        for (std::size_t c = 0; c < N; ++c)
            x[c] += step * n[c];
        return true;
    }
};

Vector<3> exactly(const openvdb::Vec3s& p)
{
    return {Number(double(p[0])), Number(double(p[1])), Number(double(p[2]))};
}

/// Not std::shuffle, whose order differs from library to library. No order gives another answer.
template <std::size_t N> bool any_solution(std::vector<Vector<N>> normals)
{
    std::mt19937 random;
    for (std::size_t i = normals.size(); i > 1; --i)
        std::swap(normals[i - 1], normals[random() % i]);
    Vector<N> x;
    return Search<N>::solve(normals, x);
}

Vector<3> difference(const Vector<3>& a, const Vector<3>& b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

} // namespace

bool a_direction_sees(const openvdb::Vec3s& apex, const std::vector<Side>& sides)
{
    const Vector<3> origin = exactly(apex);
    std::vector<Vector<3>> normals;
    normals.reserve(sides.size());
    for (const Side& side : sides)
        normals.push_back(
            cross(difference(exactly(side[1]), origin), difference(exactly(side[0]), origin)));
    return any_solution(std::move(normals));
}

bool a_point_sees(const std::vector<std::array<openvdb::Vec3s, 3>>& triangles)
{
    // In homogeneous coordinates: n . x - n . a w > 0, and w > 0.
    std::vector<Vector<4>> normals{Vector<4>{0, 0, 0, 1}};
    normals.reserve(triangles.size() + 1);
    for (const auto& triangle : triangles) {
        const Vector<3> a = exactly(triangle[0]);
        const Vector<3> n =
            cross(difference(exactly(triangle[1]), a), difference(exactly(triangle[2]), a));
        normals.push_back({n[0], n[1], n[2], -dot<3>(n, a)});
    }
    return any_solution(std::move(normals));
}

} // namespace vdb_shell::exact

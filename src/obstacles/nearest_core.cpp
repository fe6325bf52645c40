// SPDX-License-Identifier: Apache-2.0

// Takes: two surfaces, or a surface and a point. Gives: how near they come to each other. The
// distance of two triangles that do not meet is that of a corner of one to the other, or of two of
// their edges (Ericson 2005, "Real-Time Collision Detection", 5.1). What is nearest is looked for
// in doubles; that nothing meets is for the exact tests.

#include "obstacles/nearest_core.h"

#include "core/box_tree.h"
#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using Corners = std::array<Vec3d, 3>;

// A surface that is a single point has no diagonal to measure in.
constexpr double kLeastUnit = 1e-30;

double clamped(double value)
{
    return std::clamp(value, 0.0, 1.0);
}

/// The squared distance of the segments p + s d and q + t e.
double segments_squared(const Vec3d& p, const Vec3d& d, const Vec3d& q, const Vec3d& e)
{
    const Vec3d r = p - q;
    const double a = d.dot(d), b = d.dot(e), c = e.dot(e), f = e.dot(r), g = d.dot(r);
    const double determinant = a * c - b * b;
    // Parallel segments, or a segment that is a point, have no one nearest pair: any s will do, as
    // t is found for it.
    double s = determinant > 0 ? clamped((b * f - c * g) / determinant) : 0;
    double t = c > 0 ? (b * s + f) / c : 0;
    // The nearest place on the second line is beyond its segment: it is an end then, and s is
    // sought again for that.
    if (t < 0 || t > 1) {
        t = clamped(t);
        s = a > 0 ? clamped((b * t - g) / a) : 0;
    }
    return (r + s * d - t * e).lengthSqr();
}

double triangles_squared(const Corners& first, const Corners& second)
{
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        least =
            std::min(least, (nearest_on_triangle(second, first[i]).point - first[i]).lengthSqr());
        least =
            std::min(least, (nearest_on_triangle(first, second[i]).point - second[i]).lengthSqr());
        for (std::size_t j = 0; j < 3; ++j)
            least = std::min(least, segments_squared(first[i], first[(i + 1) % 3] - first[i],
                                                     second[j], second[(j + 1) % 3] - second[j]));
    }
    return least;
}

/// Of a triangle, wider by `margin` and what rounding it to float32 may take away.
FloatBox box_around(const Corners& c, double margin)
{
    FloatBox box = FloatBox::around(Vec3s(c[0]));
    for (const Vec3d& p : c) {
        const double size = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
        const double wider =
            margin + (size + margin) * double(std::numeric_limits<float>::epsilon());
        box.add(Vec3s(p - Vec3d(wider)));
        box.add(Vec3s(p + Vec3d(wider)));
    }
    return box;
}

/// From the corners of one to the other surface: no less than the distance looked for.
double bound_on_distance(const TriangleMesh& first, const TriangleMesh& second)
{
    constexpr double kNone = std::numeric_limits<double>::infinity();
    // A point of no triangle is none of the surface.
    std::vector<double> distance(first.points.size(), kNone);
    for (const openvdb::Vec3I& t : first.triangles)
        for (int k = 0; k < 3; ++k)
            distance[t[k]] = 0;
    const NearestOnMesh nearest(second);
    for_each_index(distance.size(), [&](std::size_t v) {
        if (distance[v] != kNone)
            distance[v] = nearest.nearest(Vec3d(first.points[v])).distance;
    });
    return *std::min_element(distance.begin(), distance.end());
}

} // namespace

NearestOnMesh::NearestOnMesh(const TriangleMesh& mesh)
    : mesh_(mesh), tree_(mesh, std::max(kLeastUnit, diagonal_of(bounds_of(mesh.points))))
{
}

NearestPoint NearestOnMesh::nearest(const Vec3d& point) const
{
    // Without a seed of an earlier query, so that the answer is one of mesh and point alone.
    TriangleTree::Seed seed = TriangleTree::kNoSeed;
    NearestPoint found;
    found.triangle = tree_.nearest(point, 0.0f, seed).triangle;
    found.point = nearest_on_triangle(triangle_corners(mesh_, found.triangle), point).point;
    found.distance = (found.point - point).length();
    return found;
}

double least_distance(const TriangleMesh& first, const TriangleMesh& second)
{
    // The distance is found among vertices first, which a tree does fast; then only triangles whose
    // boxes are nearer than that are held against each other.
    const double bound = bound_on_distance(first, second);
    std::vector<FloatBox> boxes;
    boxes.reserve(second.triangles.size());
    for (std::size_t t = 0; t < second.triangles.size(); ++t)
        boxes.push_back(box_around(triangle_corners(second, t), 0));
    BoxTree tree;
    tree.build(boxes);
    std::vector<double> squared(first.triangles.size(), bound * bound);
    for_each_index(squared.size(), [&](std::size_t t) {
        const Corners c = triangle_corners(first, t);
        tree.for_each_overlap(box_around(c, bound), [&](int other) {
            squared[t] = std::min(
                squared[t], triangles_squared(c, triangle_corners(second, std::size_t(other))));
        });
    });
    return std::sqrt(*std::min_element(squared.begin(), squared.end()));
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
// The generalised winding number of triangles that need not be closed: A. Jacobson, L. Kavan and O.
// Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding Numbers", 2013.
// Far clusters of triangles count as one dipole, as in G. Barill and others, "Fast Winding Numbers
// for Soups and Clouds", 2018, so a query costs about the logarithm of the number of triangles. The
// tree is built by one thread and each query sums in the same order, so a value has the same bits
// for any number of threads. On closed meshes the error was about 0.01, and thresholds have to
// leave room for it.

#include "field/winding_number.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

constexpr std::uint32_t kLeafTriangles = 8;
// From this many radii on, a cluster counts as one dipole. The error of the field comes from this
// number.
constexpr double kFar = 3.0;
constexpr double kFullAngle = 4.0 * 3.14159265358979323846;

/// Signed solid angle of a triangle (van Oosterom and Strackee), positive from behind.
double solid_angle(const TriangleCorners& triangle, const Vec3d& point)
{
    const Vec3d a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
    const double la = a.length(), lb = b.length(), lc = c.length();
    const double numerator = a.dot(b.cross(c));
    const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    // A point in the triangle's plane sees it edge on. On the triangle itself the angle jumps from
    // one half of the sphere to minus that; 0 is the mean, and does not depend on the sign of a
    // zero.
    return numerator == 0.0 ? 0.0 : 2.0 * std::atan2(numerator, denominator);
}

Vec3d centroid(const TriangleCorners& t)
{
    return (t[0] + t[1] + t[2]) / 3.0;
}

} // namespace

WindingNumber::WindingNumber(std::vector<TriangleCorners> triangles)
    : triangles_(std::move(triangles))
{
    if (!triangles_.empty())
        build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void WindingNumber::summarise(Node& node) const
{
    double area = 0;
    for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const TriangleCorners& corners = triangles_[t];
        const Vec3d normal = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        node.area_normal += normal;
        node.centre += normal.length() * centroid(corners);
        area += normal.length();
    }
    // Seen from the mean weighted by area, the next term of the expansion is small for triangles
    // that are turned alike, so one dipole goes far.
    node.centre = area > 0 ? node.centre / area : centroid(triangles_[node.begin]);
    for (std::uint32_t t = node.begin; t < node.end; ++t)
        for (const Vec3d& corner : triangles_[t])
            node.radius = std::max(node.radius, (corner - node.centre).length());
}

void WindingNumber::build(std::uint32_t begin, std::uint32_t end)
{
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    nodes_[self].begin = begin;
    nodes_[self].end = end;
    summarise(nodes_[self]);
    if (end - begin <= kLeafTriangles)
        return;
    Vec3d low = centroid(triangles_[begin]), high = low;
    for (std::uint32_t t = begin; t < end; ++t) {
        low = openvdb::math::minComponent(low, centroid(triangles_[t]));
        high = openvdb::math::maxComponent(high, centroid(triangles_[t]));
    }
    const auto axis = static_cast<int>(openvdb::math::MaxIndex(high - low));
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle,
                     triangles_.begin() + end,
                     [axis](const TriangleCorners& a, const TriangleCorners& b) {
                         return centroid(a)[axis] < centroid(b)[axis];
                     });
    build(begin, middle);
    // Nodes are named by index, since the vector may move them while children are added. The right
    // child is never node 0, the root, so 0 can mark a leaf.
    nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end);
}

double WindingNumber::at(const Vec3d& point) const
{
    if (nodes_.empty())
        return 0.0;
    double angle = 0;
    std::array<std::uint32_t, 64> stack{};
    std::size_t height = 1;
    while (height > 0) {
        const std::uint32_t index = stack[--height];
        const Node& node = nodes_[index];
        const Vec3d to = node.centre - point;
        const double distance = to.length();
        // The solid angle of a far small area is its area vector times the direction over the
        // distance cubed.
        if (distance > kFar * node.radius) {
            angle += distance > 0 ? node.area_normal.dot(to) / (distance * distance * distance) : 0;
        } else if (node.right == 0) {
            for (std::uint32_t t = node.begin; t < node.end; ++t)
                angle += solid_angle(triangles_[t], point);
        } else {
            // Halving by number keeps the tree at most 32 levels deep, and each level leaves one
            // node on the stack.
            stack[height++] = node.right;
            stack[height++] = index + 1;
        }
    }
    return angle / kFullAngle;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
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
// A cluster is seen as one dipole from this many radii on.
constexpr double kFar = 3.0;
constexpr double kFullAngle = 4.0 * 3.14159265358979323846;

/// Signed solid angle of a triangle (van Oosterom and Strackee), positive from behind.
double solid_angle(const TriangleCorners& triangle, const Vec3d& point)
{
    const Vec3d a = triangle[0] - point, b = triangle[1] - point, c = triangle[2] - point;
    const double la = a.length(), lb = b.length(), lc = c.length();
    const double numerator = a.dot(b.cross(c));
    const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
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
        if (distance > kFar * node.radius) {
            angle += distance > 0 ? node.area_normal.dot(to) / (distance * distance * distance) : 0;
        } else if (node.right == 0) {
            for (std::uint32_t t = node.begin; t < node.end; ++t)
                angle += solid_angle(triangles_[t], point);
        } else {
            // Halving keeps the tree at most 32 levels deep.
            stack[height++] = node.right;
            stack[height++] = index + 1;
        }
    }
    return angle / kFullAngle;
}

} // namespace vdb_shell

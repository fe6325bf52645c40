// SPDX-License-Identifier: Apache-2.0
#include "certify/cell_grid.h"

#include "certify/tet_faces.h"

#include <algorithm>

namespace vdb_shell
{

using openvdb::Vec3d;
using openvdb::Vec3s;

Vec3s CellGrid::point_in(std::uint32_t cell_index, const Vec3d& unit) const
{
    const std::array<std::uint32_t, 3> position = position_of(cell_index);
    Vec3s point;
    for (int a = 0; a < 3; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        const std::uint32_t i = position[axis];
        const double x = low[a] + (i + unit[a]) * step[a];
        point[a] = std::clamp(static_cast<float>(x), planes[axis][i], planes[axis][i + 1]);
    }
    return point;
}

CellRange CellGrid::overlapped(const Vec3s& box_low, const Vec3s& box_high) const
{
    CellRange range;
    for (int a = 0; a < 3; ++a) {
        const std::vector<float>& p = planes[static_cast<std::size_t>(a)];
        const auto first = std::lower_bound(p.begin() + 1, p.end() - 1, box_low[a]);
        const auto last = std::upper_bound(p.begin() + 1, p.end() - 1, box_high[a]);
        range.first[static_cast<std::size_t>(a)] =
            static_cast<std::uint32_t>(first - (p.begin() + 1));
        range.last[static_cast<std::size_t>(a)] =
            static_cast<std::uint32_t>(last - (p.begin() + 1));
    }
    return range;
}

CellGrid make_cell_grid(const Bounds& bounds, std::size_t cells)
{
    constexpr double kMostAlongAxis = 1024;
    CellGrid grid;
    grid.low = bounds.low;
    const Vec3d size = bounds.high - bounds.low;
    const double edge = std::cbrt(size[0] * size[1] * size[2] / static_cast<double>(cells));
    for (int a = 0; a < 3; ++a) {
        const double wanted = edge > 0 ? std::floor(size[a] / edge) : 1.0;
        const double count = std::clamp(wanted, 1.0, kMostAlongAxis);
        grid.step[a] = size[a] / count;
        std::vector<float>& planes = grid.planes[static_cast<std::size_t>(a)];
        for (double i = 0; i < count; ++i)
            planes.push_back(static_cast<float>(bounds.low[a] + i * grid.step[a]));
        planes.push_back(static_cast<float>(bounds.high[a]));
    }
    return grid;
}

void HalfSpaces::add(const Vec3d& point, const Vec3d& outward, double size, double span)
{
    // `size` bounds the lengths that were multiplied into `outward`, so its rounding error is a few
    // times 2^-53 * size, and that of a distance times it as much times the span. Four digits more:
    constexpr double kSlack = 1e-12;
    planes_[count_++] = {point, outward, kSlack * size * span};
    height_slack_ = kSlack * span;
}

HalfSpaces HalfSpaces::of_tet(const std::array<Vec3s, 4>& corners, int sign, double span)
{
    HalfSpaces shape;
    for (const auto& face : kTetFaces) {
        const Vec3d p(corners[static_cast<std::size_t>(face[0])]);
        const Vec3d u = Vec3d(corners[static_cast<std::size_t>(face[1])]) - p;
        const Vec3d v = Vec3d(corners[static_cast<std::size_t>(face[2])]) - p;
        shape.add(p, double(sign) * u.cross(v), u.length() * v.length(), span);
    }
    return shape;
}

HalfSpaces HalfSpaces::of_triangle(const std::array<Vec3s, 3>& corners, double span)
{
    HalfSpaces shape;
    const Vec3d a(corners[0]), b(corners[1]), c(corners[2]);
    const Vec3d normal = (b - a).cross(c - a);
    const double size = (b - a).length() * (c - a).length();
    shape.add(a, normal, size, span);
    shape.add(a, -normal, size, span);
    const std::array<Vec3d, 3> points{a, b, c};
    for (std::size_t side = 0; side < 3; ++side) {
        const Vec3d edge = points[(side + 1) % 3] - points[side];
        shape.add(points[side], edge.cross(normal), edge.length() * size, span);
    }
    return shape;
}

} // namespace vdb_shell

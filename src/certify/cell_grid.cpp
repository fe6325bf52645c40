// SPDX-License-Identifier: Apache-2.0

// Takes: a bounding box and a number of cells; later float32 points, triangles and tets. Gives: the
// cells that each of them may meet. The guarantee is one-sided: a cell that is met is never left
// out, while one that is not met may be listed, which costs time and nothing else. It rests on
// planes that are float32 themselves, so that comparing a point with them is exact, and on
// half-spaces moved outward by more than the rounding of their doubles. Planes may coincide where
// the box is thin beside its distance from the origin; then there are cells without volume, and all
// comparisons hold for them too.

#include "certify/cell_grid.h"

#include "shell/tet_faces.h"

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
        // Rounding to float32 is monotone, so only the rounding of the double sum could take the
        // point beyond a plane. The clamp makes the cell a certainty, whatever the sum was.
        point[a] = std::clamp(static_cast<float>(x), planes[axis][i], planes[axis][i + 1]);
    }
    return point;
}

CellRange CellGrid::overlapped(const Vec3s& box_low, const Vec3s& box_high) const
{
    CellRange range;
    for (int a = 0; a < 3; ++a) {
        const std::vector<float>& p = planes[static_cast<std::size_t>(a)];
        // The outermost planes are left out of the search: what lies on or, by an error of the
        // caller, beyond them falls into the first or the last cell. A box that ends on a plane
        // meets the cells on both of its sides, as cells are closed; hence the lower bound for one
        // end and the upper bound for the other.
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
    // Three axes of this length have 2^30 cells, so an index of a cell fits into 32 bits.
    constexpr double kMostAlongAxis = 1024;
    CellGrid grid;
    grid.low = bounds.low;
    const Vec3d size = bounds.high - bounds.low;
    const double edge = std::cbrt(size[0] * size[1] * size[2] / static_cast<double>(cells));
    for (int a = 0; a < 3; ++a) {
        // A box without extent along some axis has no volume, and nothing to divide by; it gets a
        // single cell.
        const double wanted = edge > 0 ? std::floor(size[a] / edge) : 1.0;
        const double count = std::clamp(wanted, 1.0, kMostAlongAxis);
        grid.step[a] = size[a] / count;
        std::vector<float>& planes = grid.planes[static_cast<std::size_t>(a)];
        for (double i = 0; i < count; ++i)
            planes.push_back(static_cast<float>(bounds.low[a] + i * grid.step[a]));
        // The last plane is the bound itself, which is a coordinate of a float32 point. A sum of
        // steps might end just below it.
        planes.push_back(static_cast<float>(bounds.high[a]));
    }
    return grid;
}

void HalfSpaces::add(const Vec3d& point, const Vec3d& outward, double size, double span)
{
    // `size` bounds the product of the lengths that were multiplied into `outward`, so the rounding
    // error of `outward` is a few times 2^-53 * size, and that of a distance times `outward` as
    // much times the span. The slack is four decimal digits larger. The slack of a height covers
    // the division and the sums after it.
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
        // The faces of a positive tet turn outward; those of an inverted one inward, which the sign
        // mends.
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
    // A triangle is its plane, as two half-spaces, and a half-space square to it at each side.
    // Where it has no area all normals are nought; such half-spaces exclude nothing, so the
    // triangle gets all cells of its box.
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

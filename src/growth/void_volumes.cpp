// SPDX-License-Identifier: Apache-2.0

// Takes: a finished shell. Gives: where its void is, triangle by triangle, so that refinement can
// cut those under which most is left to fill. Rays go from even places of each inner triangle
// against its normal, through the void, to where they leave it on the other side. In doubles, as an
// estimate: nothing that is certified rests on it.

#include "growth/void_volumes.h"

#include "core/box_pairs.h"
#include "core/parallel.h"
#include "mesh/ray_through.h"

#include <algorithm>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// Rays a triangle: the square of this. Sixteen tell triangles apart well enough to rank them.
constexpr int kPiecesAlong = 4;

/// Calls visit(place) for the centres of kPiecesAlong^2 equal pieces of a triangle.
template <typename Visit>
void for_each_place(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Visit& visit)
{
    const double step = 1.0 / kPiecesAlong;
    const auto at = [&](double u, double v) {
        visit(a + (b - a) * (u * step) + (c - a) * (v * step));
    };
    for (int i = 0; i < kPiecesAlong; ++i)
        for (int j = 0; i + j < kPiecesAlong; ++j) {
            at(i + 1.0 / 3.0, j + 1.0 / 3.0);
            if (i + j + 1 < kPiecesAlong)
                at(i + 2.0 / 3.0, j + 2.0 / 3.0);
        }
}

/// The length of the ray up to where it leaves the inner surface; 0 where it never does.
double chord(const TriangleMesh& inner, const BoxTree& tree, std::uint32_t from, const Ray& ray,
             double longest)
{
    double nearest = longest;
    tree.for_each_on_ray(ray.from, ray.along, nearest, [&](int other) {
        const auto triangle = static_cast<std::uint32_t>(other);
        if (triangle != from)
            nearest = std::min(nearest, leaves_through(inner, inner.triangles[triangle], ray));
    });
    return nearest < longest ? nearest : 0.0;
}

} // namespace

std::vector<double> void_volumes(const PrismShell& shell)
{
    const TriangleMesh inner = inner_surface(shell);
    BoxTree tree;
    tree.build(triangle_boxes(inner.points, inner.triangles));
    const double longest = diagonal_of(bounds_of(inner.points));
    std::vector<double> volumes(inner.triangles.size());
    for_each_index(volumes.size(), [&](std::size_t t) {
        const Vec3I& corners = inner.triangles[t];
        const Vec3d a(inner.points[corners[0]]), b(inner.points[corners[1]]),
            c(inner.points[corners[2]]);
        const Vec3d cross = (c - a).cross(b - a);
        const double twice_area = cross.length();
        if (!(twice_area > 0))
            return;
        double sum = 0;
        for_each_place(a, b, c, [&](const Vec3d& place) {
            sum += chord(inner, tree, static_cast<std::uint32_t>(t), {place, cross / twice_area},
                         longest);
        });
        // The area, half of twice_area, times half the mean chord: the other half of the way
        // belongs to the triangle that the ray leaves through.
        volumes[t] = 0.25 * twice_area * sum / (kPiecesAlong * kPiecesAlong);
    });
    return volumes;
}

} // namespace vdb_shell

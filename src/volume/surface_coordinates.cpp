// SPDX-License-Identifier: Apache-2.0

// Takes a textured surface and another one that was made of it, gives texture coordinates for the
// corners of the other. Triangles that are the same are found by the bits of their corners. For
// the others the textured triangles are joined across the edges that have the same coordinates on
// both sides; the edges that have not are seams. Every triangle is done by itself.

#include "vdb_shell/volume/surface_coordinates.h"

#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/topology.h"
#include "mesh/triangle_corners.h"
#include "mesh/triangle_tree.h"
#include "vdb_shell/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <unordered_set>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec2d;
using openvdb::Vec3d;
using openvdb::Vec3s;
using Corners = std::array<Vec2d, 3>;

/// A triangle with its corners turned so that the least comes first: equal for triangles that are
/// the same, oriented alike.
struct Key {
    std::array<Vec3s, 3> point;
    std::uint32_t triangle;
    int first; ///< the corner that comes first

    Key(const TriangleMesh& mesh, std::uint32_t t) : triangle(t), first(0)
    {
        // Only turned and never reversed: a triangle that is turned over is another one, whose
        // texture would be mirrored.
        const openvdb::Vec3I& c = mesh.triangles[t];
        for (int k = 1; k < 3; ++k)
            if (mesh.points[c[k]] < mesh.points[c[first]])
                first = k;
        for (int k = 0; k < 3; ++k)
            point[std::size_t(k)] = mesh.points[c[(first + k) % 3]];
    }
    bool operator<(const Key& o) const
    {
        return std::tie(point[0], point[1], point[2], triangle) <
               std::tie(o.point[0], o.point[1], o.point[2], o.triangle);
    }
};

/// The textured surface, ready to be asked.
class Charts
{
public:
    explicit Charts(const TextureCoordinates& textured)
        : textured_(textured),
          around_(triangles_around_vertices(textured.mesh.points.size(), textured.mesh.triangles)),
          tree_(textured.mesh, std::max(diagonal_of(bounds_of(textured.mesh.points)) / 256,
                                        std::numeric_limits<double>::min()))
    {
    }

    /// The coordinates of a triangle's corners, and how far its middle is from the surface.
    Corners of(const std::array<Vec3d, 3>& corner, double& far) const
    {
        const Vec3d middle = (corner[0] + corner[1] + corner[2]) / 3.0;
        TriangleTree::Seed seed = TriangleTree::kNoSeed;
        const std::uint32_t begin = tree_.nearest(middle, 0.0F, seed).triangle;
        far = std::sqrt(squared(begin, middle));
        // As far as the chart is from the middle, and the middle from the farthest corner: the part
        // of the chart that the triangle lies over.
        double reach = far;
        for (const Vec3d& c : corner)
            reach = std::max(reach, far + (c - middle).length());
        std::array<std::uint32_t, 3> nearest{begin, begin, begin};
        std::array<double, 3> least{};
        for (std::size_t k = 0; k < 3; ++k)
            least[k] = squared(begin, corner[k]);
        std::vector<std::uint32_t> found{begin};
        // A large triangle may lie over thousands of the chart's.
        std::unordered_set<std::uint32_t> known{begin};
        // Breadth first, across edges without a seam only. `found` grows while it is gone through,
        // and ends where no neighbour is within reach.
        for (std::size_t n = 0; n < found.size(); ++n)
            for (int side = 0; side < 3; ++side) {
                const std::uint32_t next = across(found[n], side);
                if (next == kNone || !known.insert(next).second ||
                    squared(next, middle) > reach * reach)
                    continue;
                found.push_back(next);
                for (std::size_t k = 0; k < 3; ++k)
                    if (const double d = squared(next, corner[k]); d < least[k])
                        least[k] = d, nearest[k] = next;
            }
        Corners made;
        for (std::size_t k = 0; k < 3; ++k)
            made[k] = extended(nearest[k], corner[k]);
        return made;
    }

private:
    static constexpr std::uint32_t kNone = ~0U;

    double squared(std::uint32_t t, const Vec3d& place) const
    {
        return (nearest_on_triangle(triangle_corners(textured_.mesh, t), place).point - place)
            .lengthSqr();
    }

    /// The triangle beyond side k (from corner k) with the same coordinates along it.
    std::uint32_t across(std::uint32_t t, int k) const
    {
        const auto& triangles = textured_.mesh.triangles;
        const std::uint32_t a = triangles[t][k], b = triangles[t][(k + 1) % 3];
        for (const std::uint32_t other : around_.around(a))
            for (int j = 0; j < 3; ++j)
                if (other != t && triangles[other][j] == b && triangles[other][(j + 1) % 3] == a) {
                    const Corners &x = textured_.corner[t], &y = textured_.corner[other];
                    // Bit for bit: files repeat the index of a texture coordinate where a chart
                    // goes on.
                    const bool joined = x[std::size_t(k)] == y[std::size_t((j + 1) % 3)] &&
                                        x[std::size_t((k + 1) % 3)] == y[std::size_t(j)];
                    return joined ? other : kNone;
                }
        return kNone;
    }

    /// Affine in the plane of the triangle; of one without area that of the nearest corner.
    Vec2d extended(std::uint32_t t, const Vec3d& place) const
    {
        const std::array<Vec3d, 3> c = triangle_corners(textured_.mesh, t);
        const Corners& uv = textured_.corner[t];
        const Vec3d n = (c[1] - c[0]).cross(c[2] - c[0]);
        const double area = n.lengthSqr();
        if (!(area > 0)) {
            const std::array<double, 3> weight = nearest_weights(c, place);
            return weight[0] * uv[0] + weight[1] * uv[1] + weight[2] * uv[2];
        }
        // Barycentric coordinates of the foot in the plane. They may be negative: a corner beyond
        // the chart's edge is drawn on in the scale of its last triangle.
        const double b = (place - c[0]).cross(c[2] - c[0]).dot(n) / area;
        const double d = (c[1] - c[0]).cross(place - c[0]).dot(n) / area;
        return uv[0] + b * (uv[1] - uv[0]) + d * (uv[2] - uv[0]);
    }

    const TextureCoordinates& textured_;
    VertexTriangles around_;
    TriangleTree tree_;
};

} // namespace

SurfaceCoordinates surface_coordinates(const TextureCoordinates& textured,
                                       const TriangleMesh& surface)
{
    if (textured.mesh.triangles.empty())
        throw InvalidOption("texture coordinates: the textured surface has no triangles");
    std::vector<Key> known;
    known.reserve(textured.mesh.triangles.size());
    for (std::uint32_t t = 0; t < textured.mesh.triangles.size(); ++t)
        known.emplace_back(textured.mesh, t);
    std::sort(known.begin(), known.end());
    const Charts charts(textured);
    const std::size_t count = surface.triangles.size();
    SurfaceCoordinates made;
    made.corner.resize(count);
    std::vector<double> far(count, -1);
    for_each_index(count, [&](std::size_t t) {
        Key key(surface, std::uint32_t(t));
        // Below every number, so that lower_bound finds the first of equal triangles.
        key.triangle = 0;
        const auto found = std::lower_bound(known.begin(), known.end(), key);
        if (found == known.end() || found->point != key.point) {
            made.corner[t] = charts.of(triangle_corners(surface, t), far[t]);
            return;
        }
        for (int k = 0; k < 3; ++k)
            made.corner[t][std::size_t((key.first + k) % 3)] =
                textured.corner[found->triangle][std::size_t((found->first + k) % 3)];
    });
    // After the threads, in the order of triangles. A distance below 0 is left over where none was
    // measured.
    for (const double d : far) {
        made.same += d < 0;
        made.farthest = std::max(made.farthest, d);
    }
    return made;
}

} // namespace vdb_shell

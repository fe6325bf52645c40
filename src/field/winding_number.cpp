// SPDX-License-Identifier: Apache-2.0
// The generalised winding number of triangles that need not be closed: A. Jacobson, L. Kavan and O.
// Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized Winding Numbers", 2013.
// Far clusters of triangles count as one dipole, as in G. Barill and others, "Fast Winding Numbers
// for Soups and Clouds", 2018. Points are asked about in groups: the tree is walked once for a
// group and leaves lists of far clusters and near triangles, which eight points at a time are
// summed over (field/eight_windings.h). The tree is built by one thread and each sum has its order,
// so a value has the same bits for any number of threads. On closed meshes the error was up to
// 0.02, and thresholds have to leave room for it.

#include "field/winding_number.h"

#include "field/eight_windings.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

// Half as many take 3 %, twice as many 12 % longer for the wrap of 96,000 faces of a tet mesh
// (tet_faces of docs/scripts/cost_inputs.py): small leaves are far sooner, but are more of them.
constexpr std::uint32_t kLeafTriangles = 4;
// As kFar for a single triangle, whose dipole is nearer to the truth: 0.017 turns off beside a
// sphere, 0.021 from twice the radius on.
constexpr double kFarTriangle = 2.5;
// Rarely are there more of either kind around a group of points.
constexpr std::size_t kUsualList = 2048;

Vec3d centroid(const TriangleCorners& t)
{
    return (t[0] + t[1] + t[2]) / 3.0;
}

Vec3d area_normal(const TriangleCorners& t)
{
    return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
}

} // namespace

WindingNumber::WindingNumber(std::vector<TriangleCorners> triangles)
    : triangles_(std::move(triangles))
{
    if (!triangles_.empty())
        build(0, static_cast<std::uint32_t>(triangles_.size()));
    // Each triangle is met by the groups of points all around it, a hundred of them and more.
    dipoles_.reserve(triangles_.size());
    for (const TriangleCorners& corners : triangles_) {
        Dipole& dipole = dipoles_.emplace_back();
        dipole.centre = centroid(corners);
        dipole.area_normal = area_normal(corners);
        for (const Vec3d& corner : corners)
            dipole.far = std::max(dipole.far, kFarTriangle * (corner - dipole.centre).length());
    }
}

void WindingNumber::summarise(Node& node) const
{
    double area = 0;
    for (std::uint32_t t = node.begin; t < node.end; ++t) {
        const TriangleCorners& corners = triangles_[t];
        const Vec3d normal = area_normal(corners);
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

/// What points within `radius` of `middle` see, relative to `middle`.
struct WindingNumber::Surroundings {
    Vec3d middle;
    double radius;
    std::vector<FarCluster> far;
    std::vector<NearTriangle> near;

    bool is_beyond(double distance, const Vec3d& centre) const
    {
        return (centre - middle).lengthSqr() > (distance + radius) * (distance + radius);
    }
    FarCluster cluster(const Vec3d& centre, const Vec3d& normal) const
    {
        const Vec3d to = centre - middle;
        return {{float(to[0]), float(to[1]), float(to[2])},
                {float(normal[0]), float(normal[1]), float(normal[2])}};
    }
    void add_far(const Vec3d& centre, const Vec3d& normal)
    {
        if (normal != Vec3d(0.0)) // else without a view, and perhaps where a point is
            far.push_back(cluster(centre, normal));
    }
    void add_near(const TriangleCorners& corners, const Dipole& dipole)
    {
        NearTriangle& triangle = near.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            for (int axis = 0; axis < 3; ++axis)
                triangle.corners[k][std::size_t(axis)] = float(corners[k][axis] - middle[axis]);
        triangle.from_afar = cluster(dipole.centre, dipole.area_normal);
        triangle.squared_far = float(dipole.far * dipole.far);
    }
};

void WindingNumber::look_around(std::uint32_t first, Surroundings& from) const
{
    std::array<std::uint32_t, 64> stack{first};
    std::size_t height = 1;
    while (height > 0) {
        const std::uint32_t index = stack[--height];
        const Node& node = nodes_[index];
        if (from.is_beyond(kFar * node.radius, node.centre)) {
            from.add_far(node.centre, node.area_normal);
        } else if (node.right == 0) {
            for (std::uint32_t t = node.begin; t < node.end; ++t)
                if (const Dipole& dipole = dipoles_[t]; from.is_beyond(dipole.far, dipole.centre))
                    from.add_far(dipole.centre, dipole.area_normal);
                else
                    from.add_near(triangles_[t], dipole);
        } else {
            // Halving by number keeps the tree at most 32 levels deep, and each level leaves one
            // node on the stack.
            stack[height++] = node.right;
            stack[height++] = index + 1;
        }
    }
}

void WindingNumber::around(const Vec3d* points, std::size_t count, float* turns) const
{
    static const std::vector<std::uint32_t> root{0}, none;
    around(nodes_.empty() ? none : root, points, count, turns);
}

void WindingNumber::around(const std::vector<std::uint32_t>& nodes, const Vec3d* points,
                           std::size_t count, float* turns) const
{
    if (count == 0)
        return;
    Vec3d low = points[0], high = points[0];
    for (std::size_t i = 1; i < count; ++i) {
        low = openvdb::math::minComponent(low, points[i]);
        high = openvdb::math::maxComponent(high, points[i]);
    }
    Surroundings from{0.5 * (low + high), 0.5 * (high - low).length(), {}, {}};
    from.far.reserve(kUsualList);
    from.near.reserve(kUsualList);
    for (const std::uint32_t node : nodes)
        look_around(node, from);
    for (std::size_t first = 0; first < count; first += kLanes) {
        const std::size_t some = std::min(kLanes, count - first);
        EightPoints eight;
        for (std::size_t i = 0; i < kLanes; ++i) {
            const Vec3d p = points[first + std::min(i, some - 1)] - from.middle;
            eight.x[i] = float(p[0]), eight.y[i] = float(p[1]), eight.z[i] = float(p[2]);
        }
        alignas(kLanesAlignment) std::array<float, kLanes> result;
        turns_around(from.far.data(), from.far.size(), from.near.data(), from.near.size(), eight,
                     result);
        std::copy_n(result.begin(), some, turns + first);
    }
}

} // namespace vdb_shell

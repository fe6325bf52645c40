// SPDX-License-Identifier: Apache-2.0
#include "support/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace vdb_shell::test
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

namespace
{

/// Points merged by equal float32 position.
class Builder
{
public:
    std::uint32_t point(const Vec3d& p)
    {
        const Vec3s rounded(p);
        const auto [entry, fresh] = index_.try_emplace(
            {rounded[0], rounded[1], rounded[2]}, static_cast<std::uint32_t>(mesh.points.size()));
        if (fresh)
            mesh.points.push_back(rounded);
        return entry->second;
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        mesh.triangles.emplace_back(a, b, c);
    }
    void quad(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d)
    {
        const std::uint32_t ia = point(a), ib = point(b), ic = point(c), id = point(d);
        triangle(ia, ib, ic);
        triangle(ia, ic, id);
    }
    TriangleMesh mesh;

private:
    std::map<std::array<float, 3>, std::uint32_t> index_;
};

} // namespace

TriangleMesh unit_tetrahedron()
{
    return {{Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0), Vec3s(0, 0, 1)},
            {Vec3I(0, 2, 1), Vec3I(0, 1, 3), Vec3I(0, 3, 2), Vec3I(1, 2, 3)}};
}

TriangleMesh box(const Vec3d& low, const Vec3d& high)
{
    return gridded_box(low, high, 1);
}

TriangleMesh gridded_box(const Vec3d& low, const Vec3d& high, int n)
{
    Builder builder;
    const Vec3d size = high - low;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int side = 0; side < 2; ++side) {
            auto corner = [&](int i, int j) {
                Vec3d p = low;
                p[axis] = side ? high[axis] : low[axis];
                p[u] += size[u] * i / n;
                p[v] += size[v] * j / n;
                return p;
            };
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    if (side)
                        builder.quad(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                     corner(i, j + 1));
                    else
                        builder.quad(corner(i, j), corner(i, j + 1), corner(i + 1, j + 1),
                                     corner(i + 1, j));
                }
        }
    }
    return builder.mesh;
}

TriangleMesh icosphere(double radius, int subdivisions)
{
    const double g = (1 + std::sqrt(5.0)) / 2;
    std::vector<Vec3d> points{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                              {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                              {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    std::vector<Vec3I> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                 {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                 {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                 {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int level = 0; level < subdivisions; ++level) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [entry, fresh] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(points.size()));
            if (fresh)
                points.push_back(points[a] + points[b]);
            return entry->second;
        };
        std::vector<Vec3I> finer;
        for (const Vec3I& t : triangles) {
            const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]),
                                ca = middle(t[2], t[0]);
            finer.insert(finer.end(), {Vec3I(t[0], ab, ca), Vec3I(t[1], bc, ab),
                                       Vec3I(t[2], ca, bc), Vec3I(ab, bc, ca)});
        }
        triangles = std::move(finer);
        for (Vec3d& p : points)
            p.normalize();
    }
    TriangleMesh mesh;
    for (Vec3d p : points) {
        p.normalize();
        mesh.points.emplace_back(p * radius);
    }
    mesh.triangles = triangles;
    return mesh;
}

TriangleMesh torus(double major, double minor, int around, int across)
{
    TriangleMesh mesh;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * M_PI * i / around, v = 2 * M_PI * j / across;
            const double r = major + minor * std::cos(v);
            mesh.points.emplace_back(Vec3d(r * std::cos(u), r * std::sin(u), minor * std::sin(v)));
        }
    auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>((i % around) * across + j % across);
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            mesh.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    return mesh;
}

TriangleMesh notched_cube()
{
    TriangleMesh cube;
    const auto index_of = [&](const Vec3s& p) {
        const auto at = std::find(cube.points.begin(), cube.points.end(), p);
        if (at != cube.points.end())
            return openvdb::Index32(at - cube.points.begin());
        cube.points.push_back(p);
        return openvdb::Index32(cube.points.size() - 1);
    };
    const float h = 1 + 0x1p-20f;
    // Across z: the face with a notch, the whole one, the notch's own; the others by turning axes.
    const std::vector<Vec3s> corners{{0, 0, 2}, {2, 0, 2}, {2, h, 2}, {h, h, 2}, {h, 2, 2},
                                     {0, 2, 2}, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                     {h, h, h}, {2, h, h}, {2, 2, h}, {h, 2, h}};
    using Triangles = std::vector<std::array<std::size_t, 3>>;
    const Triangles around_the_notch{{0, 1, 3}, {1, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    const Triangles across_the_middle{{5, 0, 1}, {5, 1, 3}, {1, 2, 3}, {3, 4, 5}};
    for (int turn = 0; turn < 3; ++turn) {
        Triangles triangles = turn == 0 ? around_the_notch : across_the_middle;
        for (const auto& t : Triangles{{6, 8, 7}, {6, 9, 8}, {10, 11, 12}, {10, 12, 13}})
            triangles.push_back(t);
        for (const auto& t : triangles) {
            Vec3I corner;
            for (int k = 0; k < 3; ++k) {
                const Vec3s& p = corners[t[std::size_t(k)]];
                corner[k] = index_of({p[turn], p[(turn + 1) % 3], p[(turn + 2) % 3]});
            }
            cube.triangles.push_back(corner);
        }
    }
    return cube;
}

TriangleMesh needled_plate(int points_per_corner)
{
    constexpr double kHalf = 50, kRadius = 3, kThickness = 3;
    TriangleMesh mesh;
    for (const double z : {0.0, kThickness})
        for (int corner = 0; corner < 4; ++corner)
            for (int i = 0; i < points_per_corner; ++i) {
                const double angle = M_PI / 2 * (corner + double(i) / (points_per_corner - 1));
                const double x = corner == 0 || corner == 3 ? 1 : -1, y = corner < 2 ? 1 : -1;
                mesh.points.emplace_back(Vec3d(x * (kHalf - kRadius) + kRadius * std::cos(angle),
                                               y * (kHalf - kRadius) + kRadius * std::sin(angle),
                                               z));
            }
    const auto k = static_cast<std::uint32_t>(points_per_corner), n = 4 * k;
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        mesh.triangles.emplace_back(i, j, j + n);
        mesh.triangles.emplace_back(i, j + n, i + n);
    }
    const auto add_to_faces = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        mesh.triangles.emplace_back(a + n, b + n, c + n);
        mesh.triangles.emplace_back(c, b, a);
    };
    for (std::uint32_t corner = 0; corner < 4; ++corner)
        for (std::uint32_t i = corner * k; i + 1 < (corner + 1) * k; ++i)
            add_to_faces(i, i + 1, (corner + 1) % 4 * k);
    add_to_faces(0, k, 2 * k);
    add_to_faces(0, 2 * k, 3 * k);
    return mesh;
}

TriangleMesh extruded(const std::vector<openvdb::Vec2d>& polygon,
                      const std::vector<double>& heights)
{
    TriangleMesh mesh;
    Vec3d middle(0.0);
    for (const double z : heights)
        for (const auto& p : polygon)
            mesh.points.emplace_back(Vec3d(p[0], p[1], z));
    for (const auto& p : polygon)
        middle += Vec3d(p[0], p[1], 0) / double(polygon.size());
    const auto n = static_cast<std::uint32_t>(polygon.size());
    const auto rows = static_cast<std::uint32_t>(heights.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t j = (i + 1) % n;
        for (std::uint32_t r = 0; r + 1 < rows; ++r) {
            const std::uint32_t a = r * n + i, b = r * n + j;
            mesh.triangles.emplace_back(a, b, b + n);
            mesh.triangles.emplace_back(a, b + n, a + n);
        }
        mesh.triangles.emplace_back(j, i, rows * n);
        mesh.triangles.emplace_back((rows - 1) * n + i, (rows - 1) * n + j, rows * n + 1);
    }
    mesh.points.emplace_back(middle + Vec3d(0, 0, heights.front()));
    mesh.points.emplace_back(middle + Vec3d(0, 0, heights.back()));
    return mesh;
}

TriangleMesh turned(TriangleMesh mesh, const Vec3d& axis, double angle_radians)
{
    const Vec3d k = axis.unit();
    const double c = std::cos(angle_radians), s = std::sin(angle_radians);
    for (Vec3s& point : mesh.points) {
        const Vec3d p(point);
        point = Vec3s(c * p + s * k.cross(p) + (1 - c) * k.dot(p) * k);
    }
    return mesh;
}

TriangleMesh translated(TriangleMesh mesh, const Vec3d& by)
{
    for (Vec3s& p : mesh.points)
        p = Vec3s(Vec3d(p) + by);
    return mesh;
}

TriangleMesh reversed(TriangleMesh mesh)
{
    for (Vec3I& t : mesh.triangles)
        std::swap(t[1], t[2]);
    return mesh;
}

TriangleMesh joined(TriangleMesh first, const TriangleMesh& second)
{
    const auto shift = static_cast<std::uint32_t>(first.points.size());
    first.points.insert(first.points.end(), second.points.begin(), second.points.end());
    for (const Vec3I& t : second.triangles)
        first.triangles.emplace_back(t[0] + shift, t[1] + shift, t[2] + shift);
    return first;
}

TriangleMesh without_triangle(TriangleMesh mesh, std::size_t triangle)
{
    mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(triangle));
    return mesh;
}

} // namespace vdb_shell::test

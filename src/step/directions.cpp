// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/step/directions.h"

#include "core/parallel.h"
#include "field/field_sampler.h"
#include "mesh/topology.h"
#include "vdb_shell/core/error.h"

#include <cassert>
#include <cmath>
#include <sstream>

namespace vdb_shell
{

using openvdb::Vec3d;

namespace
{

// Below this, a sum of unit vectors (or a gradient of slope one) is rounding, not a direction.
constexpr double kNoDirection = 1e-9;

Vec3d unit_or_zero(const Vec3d& v, double scale)
{
    const double length = v.length();
    return length > kNoDirection * scale ? v / length : Vec3d(0.0);
}

Vec3d corner(const TriangleMesh& mesh, std::uint32_t triangle, int i)
{
    return Vec3d(mesh.points[mesh.triangles[triangle][i]]);
}

/// Unit normals, zero for triangles without area. Edges of float32 points are exact enough in
/// double that their cross product vanishes only where the area does.
std::vector<Vec3d> triangle_normals(const TriangleMesh& mesh)
{
    std::vector<Vec3d> normals(mesh.triangles.size());
    for_each_index(normals.size(), [&](std::size_t i) {
        const auto t = static_cast<std::uint32_t>(i);
        const Vec3d a = corner(mesh, t, 0);
        const Vec3d cross = (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a);
        const double length = cross.length();
        normals[i] = length > 0 ? cross / length : Vec3d(0.0);
    });
    return normals;
}

double angle_at(const TriangleMesh& mesh, std::uint32_t triangle, std::size_t vertex)
{
    int i = 0;
    while (mesh.triangles[triangle][i] != vertex)
        ++i;
    const Vec3d p = corner(mesh, triangle, i);
    const Vec3d u = corner(mesh, triangle, (i + 1) % 3) - p;
    const Vec3d v = corner(mesh, triangle, (i + 2) % 3) - p;
    return std::atan2(u.cross(v).length(), u.dot(v));
}

// splitmix64 (Steele, Lea, Flood 2014): a counter in, 64 good bits out, the same everywhere.
std::uint64_t mix(std::uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

double signed_unit(std::uint64_t bits)
{
    return static_cast<double>(bits >> 11) * 0x1p-52 - 1.0;
}

struct Disk {
    double x, y;
};

/// A point of the unit disk for a vertex, by rejection: no trigonometry, so no difference between
/// mathematics libraries.
Disk disk_point(std::uint64_t seed, std::size_t vertex)
{
    const std::uint64_t stream = mix(mix(seed) ^ vertex);
    for (std::uint64_t draw = 0;; draw += 2) {
        const Disk p{signed_unit(mix(stream + draw)), signed_unit(mix(stream + draw + 1))};
        if (p.x * p.x + p.y * p.y <= 1)
            return p;
    }
}

Vec3d tilted(const Vec3d& direction, const Disk& offset, double tangent)
{
    // Any frame does; the axis along which the direction is shortest keeps it well conditioned.
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(direction[i]) < std::abs(direction[axis]))
            axis = i;
    Vec3d other(0.0);
    other[axis] = 1;
    const Vec3d u = direction.cross(other).unit();
    const Vec3d v = direction.cross(u);
    return (direction + tangent * (offset.x * u + offset.y * v)).unit();
}

void check_options(const DirectionOptions& options)
{
    const double most = options.perturbation_radians;
    if (most >= 0 && most < 1.5)
        return;
    std::ostringstream message;
    message << "directions: perturbation_radians is " << most << ", must be in [0, 1.5)";
    throw InvalidOption(message.str());
}

} // namespace

std::vector<Vec3d> pseudo_normals(const TriangleMesh& mesh)
{
    const VertexTriangles vertex_triangles =
        triangles_around_vertices(mesh.points.size(), mesh.triangles);
    const std::vector<Vec3d> normals = triangle_normals(mesh);
    std::vector<Vec3d> result(mesh.points.size());
    for_each_index(result.size(), [&](std::size_t v) {
        Vec3d sum(0.0);
        double angles = 0;
        for (const std::uint32_t t : vertex_triangles.around(v)) {
            const double angle = angle_at(mesh, t, v);
            sum += angle * normals[t];
            angles += angle;
        }
        result[v] = unit_or_zero(sum, angles);
    });
    return result;
}

std::vector<double> visibility_of(const TriangleMesh& mesh, const std::vector<Vec3d>& outward)
{
    assert(outward.size() == mesh.points.size());
    const VertexTriangles vertex_triangles =
        triangles_around_vertices(mesh.points.size(), mesh.triangles);
    const std::vector<Vec3d> normals = triangle_normals(mesh);
    std::vector<double> result(outward.size());
    for_each_index(result.size(), [&](std::size_t v) {
        if (outward[v].lengthSqr() == 0)
            return;
        double least = 1;
        for (const std::uint32_t t : vertex_triangles.around(v))
            if (normals[t].lengthSqr() > 0)
                least = std::min(least, outward[v].dot(normals[t]));
        result[v] = least;
    });
    return result;
}

Directions compute_directions(const TriangleMesh& mesh, const openvdb::FloatGrid& level_set,
                              const DirectionOptions& options)
{
    check_options(options);
    std::vector<Vec3d> outward;
    if (options.source == DirectionSource::pseudo_normal) {
        outward = pseudo_normals(mesh);
    } else {
        outward.resize(mesh.points.size());
        for_each_range(outward.size(), [&](std::size_t begin, std::size_t end) {
            FieldSampler field(level_set);
            for (std::size_t v = begin; v < end; ++v)
                outward[v] = unit_or_zero(field.at(Vec3d(mesh.points[v])).gradient, 1.0);
        });
    }
    if (options.perturbation_radians > 0) {
        const double tangent = std::tan(options.perturbation_radians);
        for_each_index(outward.size(), [&](std::size_t v) {
            if (outward[v].lengthSqr() > 0)
                outward[v] = tilted(outward[v], disk_point(options.seed, v), tangent);
        });
    }
    Directions directions;
    directions.visibility = visibility_of(mesh, outward);
    directions.inward = std::move(outward);
    for (Vec3d& d : directions.inward)
        d = -d;
    return directions;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes: a mesh. Gives: an order for it in which neighbours stand near each other. Files come in
// any order: a decimated scan has its vertices as good as at random, and growth then waits for
// memory for half of its time. The curve is that of Morton 1966, "A computer oriented geodetic data
// base and a new technique in file sequencing": the bits of the three coordinates in turn.

#include "mesh/curve_order.h"

#include "core/bucket_sort.h"
#include "core/parallel.h"
#include "core/parallel_sort.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <utility>

namespace vdb_shell
{
namespace
{

/// Three of them make a key of 63 bits.
constexpr std::uint64_t kBits = 21;

/// The low 21 bits, each followed by two that are 0.
std::uint64_t spread(std::uint64_t x)
{
    constexpr std::uint64_t kMasks[] = {0x1f00000000ffff, 0x1f0000ff0000ff, 0x100f00f00f00f00f,
                                        0x10c30c30c30c30c3, 0x1249249249249249};
    unsigned shift = 32;
    for (const std::uint64_t mask : kMasks) {
        x = (x | x << shift) & mask;
        shift /= 2;
    }
    return x;
}

std::vector<std::uint32_t> vertices_along_curve(const TriangleMesh& mesh)
{
    const Bounds bounds = bounds_of(mesh.points);
    const openvdb::Vec3d size = bounds.high - bounds.low;
    const double longest = std::max({size[0], size[1], size[2]});
    const double scale = longest > 0 ? double((1ULL << kBits) - 1) / longest : 0;
    // With the index no two keys are the same, so the order does not depend on how they are sorted.
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(mesh.points.size());
    for_each_index(keys.size(), [&](std::size_t v) {
        std::uint64_t key = 0;
        for (int k = 0; k < 3; ++k) {
            const double at = scale * (double(mesh.points[v][k]) - bounds.low[k]);
            key |= spread(static_cast<std::uint64_t>(at)) << unsigned(k);
        }
        keys[v] = {key, static_cast<std::uint32_t>(v)};
    });
    parallel_sort(keys.begin(), keys.end(), std::less<>());
    std::vector<std::uint32_t> vertices(keys.size());
    std::transform(keys.begin(), keys.end(), vertices.begin(),
                   [](const auto& key) { return key.second; });
    return vertices;
}

/// How far apart the corners of a triangle stand, the sum over all. `place`: of each vertex.
template <class Place>
std::uint64_t distance_of_corners(const std::vector<openvdb::Vec3I>& triangles, const Place& place)
{
    std::uint64_t sum = 0;
    for (const openvdb::Vec3I& t : triangles) {
        const std::uint32_t a = place(t[0]), b = place(t[1]), c = place(t[2]);
        sum += std::max({a, b, c}) - std::min({a, b, c});
    }
    return sum;
}

} // namespace

std::vector<std::uint32_t> places_of(const std::vector<std::uint32_t>& order)
{
    std::vector<std::uint32_t> places(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        places[order[i]] = static_cast<std::uint32_t>(i);
    return places;
}

MeshOrder curve_order(const TriangleMesh& mesh, std::size_t least_triangles)
{
    MeshOrder order;
    if (mesh.triangles.size() < least_triangles)
        return order;
    order.vertices = vertices_along_curve(mesh);
    const std::vector<std::uint32_t> place = places_of(order.vertices);
    const auto on_curve = [&](std::uint32_t v) { return place[v]; };
    if (distance_of_corners(mesh.triangles, on_curve) >=
        distance_of_corners(mesh.triangles, [](std::uint32_t v) { return v; }))
        return {};
    std::vector<std::uint32_t> triangles(mesh.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0U);
    order.triangles = bucket_sort<std::uint32_t>(
        std::array{std::move(triangles)}, mesh.points.size(),
        [&](std::uint32_t t) {
            const openvdb::Vec3I& corners = mesh.triangles[t];
            return std::min({place[corners[0]], place[corners[1]], place[corners[2]]});
        },
        std::less<>());
    return order;
}

TriangleMesh in_order(const TriangleMesh& mesh, const MeshOrder& order)
{
    if (order.own())
        return mesh;
    TriangleMesh ordered{values_at(mesh.points, order.vertices),
                         values_at(mesh.triangles, order.triangles)};
    const std::vector<std::uint32_t> place = places_of(order.vertices);
    for_each_index(ordered.triangles.size(), [&](std::size_t t) {
        for (int k = 0; k < 3; ++k)
            ordered.triangles[t][k] = place[ordered.triangles[t][k]];
    });
    return ordered;
}

} // namespace vdb_shell

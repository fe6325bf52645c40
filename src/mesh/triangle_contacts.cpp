// SPDX-License-Identifier: Apache-2.0

// Tests pairs of triangles of one surface for contacts, exactly. Most pairs whose boxes overlap
// share a corner, and these are where doubles decide least, as neighbours are nearly coplanar. So
// the fan of each vertex is tested first, once for all pairs in it: if it is embedded for certain,
// no two of its triangles meet in more than their common corners and edges (docs/theory.md,
// "Fans"). Other pairs get the exact test. The fan only saves time, so the answer is the same with
// or without it.

#include "mesh/triangle_contacts.h"

#include "core/exact.h"
#include "core/fan.h"
#include "core/orient3d_filter.h"
#include "core/parallel.h"
#include "core/unit_vector.h"
#include "mesh/topology.h"

#include <array>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;

/// Whether doubles show it for certain; false tells nothing.
bool surely_embedded(const std::vector<openvdb::Vec3s>& points, std::size_t apex,
                     const VertexTriangles::Range& rim)
{
    // An open fan has no rim here. Its pairs are tested one by one.
    if (rim.size() < 3)
        return false;
    const auto point = [&](std::size_t i) { return Vec3d(points[rim.first[i]]); };
    const Vec3d origin(points[apex]);
    return rim.size() > Fan::kMost ? large_fan_surely_embedded(origin, rim.size(), point)
                                   : Fan(origin, rim.size(), point).surely_embedded();
}

/// Of two triangles that have one corner in common: whether a plane through it surely has the
/// others of one on one side and those of the other on the other. The plane halves the angle
/// between the middles; any that does so proves it, so its own rounding does not matter.
bool surely_apart_at(const Vec3d& apex, const std::array<Vec3d, 2>& first,
                     const std::array<Vec3d, 2>& second)
{
    const std::array<Vec3d, 2> own{first[0] - apex, first[1] - apex},
        other{second[0] - apex, second[1] - apex};
    const Vec3d across = unit_vector(own[0] + own[1]) - unit_vector(other[0] + other[1]);
    // One rounding of each difference, one of each product, two of sums: four times 1.1e-16.
    constexpr double kError = 6e-16;
    const auto side = [&](const Vec3d& spoke) {
        const double x = across[0] * spoke[0], y = across[1] * spoke[1], z = across[2] * spoke[2];
        return exact::certain_sign(x + y + z, std::abs(x) + std::abs(y) + std::abs(z), kError);
    };
    return side(own[0]) > 0 && side(own[1]) > 0 && side(other[0]) < 0 && side(other[1]) < 0;
}

/// The same by index; false where they do not have just one corner in common.
bool surely_apart(const std::vector<Vec3s>& points, const openvdb::Vec3I& a,
                  const openvdb::Vec3I& b)
{
    int shared = 0, in_a = 0, in_b = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (a[i] == b[j])
                ++shared, in_a = i, in_b = j;
    const auto others = [&](const openvdb::Vec3I& t, int k) {
        return std::array<Vec3d, 2>{Vec3d(points[t[(k + 1) % 3]]), Vec3d(points[t[(k + 2) % 3]])};
    };
    return shared == 1 && surely_apart_at(Vec3d(points[a[in_a]]), others(a, in_a), others(b, in_b));
}

} // namespace

TriangleContacts::TriangleContacts(const std::vector<openvdb::Vec3s>& points,
                                   const std::vector<openvdb::Vec3I>& triangles)
    : points_(points), triangles_(triangles), embedded_(points.size())
{
    const Rims rims = rims_around_vertices(points.size(), triangles);
    for_each_index(embedded_.size(),
                   [&](std::size_t v) { embedded_[v] = surely_embedded(points, v, rims.of(v)); });
}

bool TriangleContacts::touch(std::uint32_t first, std::uint32_t second) const
{
    const openvdb::Vec3I &a = triangles_[first], &b = triangles_[second];
    for (int k = 0; k < 3; ++k)
        // One embedded fan that holds both is enough, also when they share an edge: the claim is
        // about all that the two have in common.
        if (embedded_[a[k]] && (b[0] == a[k] || b[1] == a[k] || b[2] == a[k]))
            return false;
    return !surely_apart(points_, a, b) && exact::triangles_touch(points_, a, b);
}

} // namespace vdb_shell

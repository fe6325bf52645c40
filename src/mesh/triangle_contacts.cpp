// SPDX-License-Identifier: Apache-2.0
#include "mesh/triangle_contacts.h"

#include "core/exact.h"
#include "core/fan.h"
#include "core/parallel.h"
#include "mesh/topology.h"

namespace vdb_shell
{
namespace
{

bool surely_embedded(const std::vector<openvdb::Vec3s>& points, std::size_t apex,
                     const VertexTriangles::Range& rim)
{
    if (rim.size() < 3 || rim.size() > Fan::kMost)
        return false;
    const Fan fan(openvdb::Vec3d(points[apex]), rim.size(),
                  [&](std::size_t i) { return openvdb::Vec3d(points[rim.first[i]]); });
    return fan.surely_embedded();
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
        if (embedded_[a[k]] && (b[0] == a[k] || b[1] == a[k] || b[2] == a[k]))
            return false;
    return exact::triangles_touch(points_, a, b);
}

} // namespace vdb_shell

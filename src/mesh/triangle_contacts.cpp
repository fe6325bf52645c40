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
#include "core/parallel.h"
#include "mesh/topology.h"

namespace vdb_shell
{
namespace
{

/// Whether doubles show it for certain; false tells nothing.
bool surely_embedded(const std::vector<openvdb::Vec3s>& points, std::size_t apex,
                     const VertexTriangles::Range& rim)
{
    // An open fan has no rim here, and a large one does not fit into the fan's arrays. Their pairs
    // are tested one by one.
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
        // One embedded fan that holds both is enough, also when they share an edge: the claim is
        // about all that the two have in common.
        if (embedded_[a[k]] && (b[0] == a[k] || b[1] == a[k] || b[2] == a[k]))
            return false;
    return exact::triangles_touch(points_, a, b);
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/exact.h"
#include "support/shapes.h"
#include "vdb_shell/obstacles/cores.h"
#include "vdb_shell/shell/tessellate.h"

#include <algorithm>
#include <array>
#include <cstddef>

// Surfaces with cores, and a search for tets that meet a core which shares no code with the stages:
// all tets against all triangles.

namespace vdb_shell::test
{

/// A sphere pulled apart along z: radius 1, from -2.5 to 2.5.
inline TriangleMesh capsule(int subdivisions = 3)
{
    TriangleMesh mesh = icosphere(1, subdivisions);
    for (openvdb::Vec3s& p : mesh.points)
        if (p[2] != 0)
            p[2] += p[2] > 0 ? 1.5f : -1.5f;
    return mesh;
}

inline CoreMesh ball(double radius, const openvdb::Vec3d& at = openvdb::Vec3d(0),
                     int subdivisions = 2)
{
    return {"ball", translated(icosphere(radius, subdivisions), at)};
}

inline bool boxes_apart(const exact::Tet& tet, const exact::Triangle& triangle)
{
    for (int k = 0; k < 3; ++k) {
        const auto by = [k](const openvdb::Vec3s& a, const openvdb::Vec3s& b) {
            return a[k] < b[k];
        };
        const auto [tet_low, tet_high] = std::minmax_element(tet.begin(), tet.end(), by);
        const auto [low, high] = std::minmax_element(triangle.begin(), triangle.end(), by);
        if ((*tet_high)[k] < (*low)[k] || (*high)[k] < (*tet_low)[k])
            return true;
    }
    return false;
}

/// Closed sets. Precondition: the tet is positive.
inline bool meet(const exact::Tet& t, const exact::Triangle& triangle)
{
    if (boxes_apart(t, triangle))
        return false;
    for (const openvdb::Vec3s& p : triangle)
        if (exact::orient3d(p, t[1], t[2], t[3]) >= 0 &&
            exact::orient3d(t[0], p, t[2], t[3]) >= 0 &&
            exact::orient3d(t[0], t[1], p, t[3]) >= 0 && exact::orient3d(t[0], t[1], t[2], p) >= 0)
            return true;
    for (std::size_t k = 0; k < 4; ++k)
        if (exact::triangles_touch(exact::Triangle{t[(k + 1) % 4], t[(k + 2) % 4], t[(k + 3) % 4]},
                                   triangle))
            return true;
    return false;
}

/// Pairs of a tet and a triangle that have a common point.
inline std::size_t tets_that_meet(const TetMesh& tets, const TriangleMesh& core)
{
    std::size_t found = 0;
    for (const openvdb::Vec4I& t : tets.tets) {
        const exact::Tet tet{tets.points[t[0]], tets.points[t[1]], tets.points[t[2]],
                             tets.points[t[3]]};
        for (const openvdb::Vec3I& c : core.triangles)
            found += meet(tet, {core.points[c[0]], core.points[c[1]], core.points[c[2]]});
    }
    return found;
}

} // namespace vdb_shell::test

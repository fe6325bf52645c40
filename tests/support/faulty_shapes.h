// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/shapes.h"

#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

// Surfaces with known faults.

namespace vdb_shell::test
{

using Voxel = std::array<int, 3>;

/// The boundary of a set of unit cubes, outward, points welded: edges and corners at which cubes
/// meet only there are not manifold.
inline TriangleMesh voxel_surface(const std::set<Voxel>& voxels)
{
    TriangleMesh mesh;
    std::map<Voxel, std::uint32_t> index;
    const auto point = [&](const Voxel& p) {
        const auto [entry, fresh] =
            index.try_emplace(p, static_cast<std::uint32_t>(mesh.points.size()));
        if (fresh)
            mesh.points.emplace_back(float(p[0]), float(p[1]), float(p[2]));
        return entry->second;
    };
    for (const Voxel& voxel : voxels)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                Voxel beyond = voxel;
                beyond[axis] += side ? 1 : -1;
                if (voxels.count(beyond))
                    continue;
                std::array<std::uint32_t, 4> corner{};
                for (std::size_t k = 0; k < 4; ++k) {
                    Voxel p = voxel;
                    p[axis] += side;
                    p[(axis + 1) % 3] += k == 1 || k == 2;
                    p[(axis + 2) % 3] += k >= 2;
                    corner[side ? k : 3 - k] = point(p);
                }
                mesh.triangles.emplace_back(corner[0], corner[1], corner[2]);
                mesh.triangles.emplace_back(corner[0], corner[2], corner[3]);
            }
    return mesh;
}

/// A band of `around` x `across` quads, closed after half a turn: one-sided, one boundary of
/// 2 * around edges.
inline TriangleMesh moebius_strip(int around, int across)
{
    TriangleMesh mesh;
    const auto index = [&](int i, int j) {
        return static_cast<std::uint32_t>(i == around ? across - j : i * (across + 1) + j);
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j <= across; ++j) {
            const double u = 2 * M_PI * i / around, v = double(j) / across - 0.5;
            const double r = 2 + v * std::cos(u / 2);
            mesh.points.emplace_back(
                openvdb::Vec3d(r * std::cos(u), r * std::sin(u), v * std::sin(u / 2)));
        }
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            mesh.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    return mesh;
}

/// The figure-eight immersion of the Klein bottle: closed, one-sided, crosses itself.
inline TriangleMesh klein_bottle(int around, int across)
{
    TriangleMesh mesh;
    const auto index = [&](int i, int j) {
        // After one turn the figure eight has made half a turn: its parameter runs backwards.
        const int wrapped = i == around ? (across + across - j) % across : j % across;
        return static_cast<std::uint32_t>((i % around) * across + wrapped);
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double u = 2 * M_PI * i / around, v = 2 * M_PI * (j + 0.0) / across;
            const double x = std::sin(v), y = std::sin(2 * v);
            const double r = 3 + std::cos(u / 2) * x - std::sin(u / 2) * y;
            mesh.points.emplace_back(openvdb::Vec3d(r * std::cos(u), r * std::sin(u),
                                                    std::sin(u / 2) * x + std::cos(u / 2) * y));
        }
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            mesh.triangles.emplace_back(index(i, j), index(i + 1, j), index(i + 1, j + 1));
            mesh.triangles.emplace_back(index(i, j), index(i + 1, j + 1), index(i, j + 1));
        }
    return mesh;
}

/// A sphere and its mirror image in its point `touching`, which they share.
inline TriangleMesh touching_spheres(int subdivisions, std::uint32_t touching)
{
    TriangleMesh mesh = icosphere(1.0, subdivisions);
    const auto shift = static_cast<std::uint32_t>(mesh.points.size());
    const std::size_t triangles = mesh.triangles.size();
    const openvdb::Vec3s centre = mesh.points[touching];
    for (std::uint32_t v = 0; v < shift; ++v)
        mesh.points.push_back(centre + (centre - openvdb::Vec3s(mesh.points[v])));
    for (std::size_t t = 0; t < triangles; ++t) {
        openvdb::Vec3I corner = mesh.triangles[t];
        for (int k = 0; k < 3; ++k)
            corner[k] = corner[k] == touching ? touching : corner[k] + shift;
        // A point reflection turns the sphere inside out.
        mesh.triangles.emplace_back(corner[0], corner[2], corner[1]);
    }
    // The image of the common point is in no triangle.
    mesh.points[shift + touching] = mesh.points[shift + (touching == 0 ? 1 : 0)];
    return mesh;
}

/// Without the triangles whose corners all satisfy the condition.
template <typename Condition> TriangleMesh without(TriangleMesh mesh, const Condition& condition)
{
    std::vector<openvdb::Vec3I> kept;
    for (const openvdb::Vec3I& t : mesh.triangles)
        if (!(condition(mesh.points[t[0]]) && condition(mesh.points[t[1]]) &&
              condition(mesh.points[t[2]])))
            kept.push_back(t);
    mesh.triangles = kept;
    return mesh;
}

} // namespace vdb_shell::test

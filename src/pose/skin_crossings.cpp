// SPDX-License-Identifier: Apache-2.0

// Takes a posed skin and where the shell's points are carried. Gives the triangles whose prisms
// cannot be free of contacts because the skin crosses itself there, as it does in armpits. Behind
// them the solid is covered twice, which the winding number of the skin tells.

#include "pose/skin_crossings.h"

#include "core/parallel.h"
#include "field/winding_number.h"
#include "mesh/surface_defects.h"

#include <array>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// Vertices whose pillar leaves what the skin encloses once. Winding numbers of points near the
/// skin are off by up to 0.02, so half a turn tells for certain.
std::vector<std::uint8_t> covered_twice(const RestShell::Parts& parts, const PoseState& state,
                                        const std::vector<Vec3s>& skin)
{
    std::vector<TriangleCorners> corners;
    for (const Vec3I& t : parts.stack.triangles())
        corners.push_back({Vec3d(skin[t[0]]), Vec3d(skin[t[1]]), Vec3d(skin[t[2]])});
    const WindingNumber winding(std::move(corners));
    std::vector<std::uint8_t> twice(skin.size(), 0);
    for_each_index(
        skin.size(),
        [&](std::size_t v) {
            const std::size_t place = (parts.stack.surfaces() - 1) * skin.size() + v;
            const std::uint32_t point = parts.point_of_place[parts.first_place[place]];
            if (point == RestShell::Parts::kFree)
                return;
            // Along the pillar; its ends can lie on the skin.
            std::array<Vec3d, 3> at;
            for (std::size_t i = 0; i < at.size(); ++i)
                at[i] =
                    Vec3d(skin[v]) + (double(i) + 0.5) / 3 * (state.place[point] - Vec3d(skin[v]));
            std::array<float, 3> turns{};
            winding.around(at.data(), at.size(), turns.data());
            for (const float turn : turns)
                twice[v] |= std::abs(turn - 1.0f) > 0.5f;
        },
        16);
    return twice;
}

} // namespace

SkinCrossings find_skin_crossings(const RestShell::Parts& parts, const PoseState& state,
                                  const std::vector<Vec3s>& skin, Interrupter* interrupter)
{
    const std::vector<Vec3I>& triangles = parts.stack.triangles();
    const TriangleMesh mesh{skin, triangles};
    const std::vector<TrianglePair> pairs =
        find_self_intersections(mesh, find_degenerate(mesh), interrupter);
    SkinCrossings found;
    found.pairs = pairs.size();
    if (pairs.empty())
        return found;
    std::vector<std::uint8_t> vertex = covered_twice(parts, state, skin);
    for (const auto& pair : pairs)
        for (const std::uint32_t t : pair)
            for (int k = 0; k < 3; ++k)
                vertex[triangles[t][k]] = 1;
    found.region.resize(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        found.region[t] =
            vertex[triangles[t][0]] || vertex[triangles[t][1]] || vertex[triangles[t][2]];
    return found;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/exact.h"
#include "core/parallel.h"
#include "pose/point_energy.h"

#include <openvdb/Types.h>

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Points as they will be stored: the skin's as given, others rounded to float32.
inline std::vector<openvdb::Vec3s> stored_points(const RestShell::Parts& parts,
                                                 const PoseState& state,
                                                 const std::vector<openvdb::Vec3s>& skin)
{
    std::vector<openvdb::Vec3s> points;
    points.reserve(state.place.size());
    for (std::size_t p = 0; p < state.place.size(); ++p)
        points.push_back(parts.skin_vertex[p] == RestShell::Parts::kFree
                             ? openvdb::Vec3s(state.place[p])
                             : skin[parts.skin_vertex[p]]);
    return points;
}

/// Tets that are not positive, ascending. Exact.
inline std::vector<std::uint32_t> inverted_tets(const RestShell::Parts& parts,
                                                const std::vector<openvdb::Vec3s>& points)
{
    std::vector<std::uint8_t> bad(parts.all.size());
    for_each_index(parts.all.size(), [&](std::size_t t) {
        const openvdb::Vec4I& tet = parts.all[t];
        bad[t] =
            exact::orient3d(points[tet[0]], points[tet[1]], points[tet[2]], points[tet[3]]) <= 0;
    });
    std::vector<std::uint32_t> list;
    for (std::size_t t = 0; t < bad.size(); ++t)
        if (bad[t])
            list.push_back(static_cast<std::uint32_t>(t));
    return list;
}

} // namespace vdb_shell

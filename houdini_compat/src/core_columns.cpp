// SPDX-License-Identifier: Apache-2.0

// Where pillars ended at cores, as point attributes, and read back. `core` and `core_triangle` are
// names and not amounts; `core_uvw` has no meaning that a transform could change.

#include "core_columns.h"

#include <cstdint>
#include <utility>

namespace vdb_shell::houdini
{
namespace
{

constexpr const char* kCore = "core";
constexpr const char* kTriangle = "core_triangle";
constexpr const char* kUvw = "core_uvw";
constexpr const char* kDistance = "core_distance";

} // namespace

void add_core_attributes(const ShellPoints& points, const std::vector<CoreFoot>& feet,
                         HoudiniGeometry& geometry)
{
    if (feet.empty())
        return;
    std::vector<std::int32_t> core, triangle;
    std::vector<float> uvw, distance;
    for (const CoreFoot& foot : feet_by_id(points, feet)) {
        core.push_back(foot.core);
        triangle.push_back(foot.triangle);
        uvw.insert(uvw.end(), {foot.uvw[0], foot.uvw[1], foot.uvw[2]});
        distance.push_back(foot.distance);
    }
    geometry.point_attributes.push_back({kCore, 1, kIndex, std::move(core)});
    geometry.point_attributes.push_back({kTriangle, 1, kIndex, std::move(triangle)});
    geometry.point_attributes.push_back({kUvw, 3, "", std::move(uvw)});
    geometry.point_attributes.push_back({kDistance, 1, "", std::move(distance)});
}

std::vector<CoreFoot> read_core_attributes(const HoudiniGeometry& geometry, const Columns& columns,
                                           const ShellStack& stack, const std::string& name)
{
    if (!find(geometry.point_attributes, kCore))
        return {};
    const auto &core = columns.integers(kCore), &triangle = columns.integers(kTriangle);
    const std::vector<openvdb::Vec3s> uvw = columns.vectors(kUvw);
    const auto& distance = columns.get<std::vector<float>>(kDistance, 1);
    std::vector<CoreFoot> by_id;
    for (std::size_t i = 0; i < core.size(); ++i)
        by_id.push_back({core[i], triangle[i], uvw[i], distance[i]});
    return feet_by_vertex(number_points(stack, {}), by_id, name);
}

} // namespace vdb_shell::houdini

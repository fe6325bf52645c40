// SPDX-License-Identifier: Apache-2.0

// The surface before remeshing: points behind all others, each bound to three points of the
// outermost surface by weights, and back.

#include "input_columns.h"

#include "added_elements.h"
#include "shell_columns.h"
#include "shell_names.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace vdb_shell::houdini
{
namespace
{

constexpr const char* kCorners = "input_corners";
constexpr const char* kWeights = "input_weights";

} // namespace

void append_input_points(const InputPoints& input, HoudiniGeometry& geometry)
{
    const std::size_t count = input.points.size();
    geometry.point_attributes.push_back(
        {kCorners, 3, "nonarithmetic_integer", std::vector<std::int32_t>(3 * geometry.points, -1)});
    geometry.point_attributes.push_back(
        {kWeights, 3, "", std::vector<float>(3 * geometry.points, 0.0f)});
    std::vector<std::int32_t> corners;
    for (const openvdb::Vec3I& c : input.corners)
        for (int k = 0; k < 3; ++k)
            corners.push_back(static_cast<std::int32_t>(c[k]));
    const std::vector<float> position = as_floats(input.points);
    append_values(geometry.point_attributes, count,
                  {{"P", position},
                   {kRest, position},
                   {kOpposite, position},
                   {kCorners, std::move(corners)},
                   {kWeights, as_floats(input.weights)}});
    append_group(geometry.point_groups, geometry.points, count, kInputPoints);
    geometry.points += count;
}

InputPoints read_input_points(const HoudiniGeometry& geometry, std::size_t count,
                              std::size_t vertices, const std::string& name)
{
    const Columns points(geometry.point_attributes, "point attribute", name);
    InputPoints input;
    input.points = last_of(points.vectors("P"), count);
    input.weights = last_of(points.vectors(kWeights), count);
    const std::vector<std::int32_t> corners = last_of(points.integers(kCorners, 3), 3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        input.corners.emplace_back(0U);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t corner = corners[3 * i + k];
            if (corner < 0 || static_cast<std::size_t>(corner) >= vertices)
                points.fail(kCorners,
                            "has " + std::to_string(corner) + " of " + std::to_string(vertices));
            input.corners[i][static_cast<int>(k)] = static_cast<std::uint32_t>(corner);
        }
    }
    return input;
}

} // namespace vdb_shell::houdini

// SPDX-License-Identifier: Apache-2.0

// Takes the map of a remeshing; gives the columns that files have of it.

#include "vdb_shell/write/input_points.h"

#include "vdb_shell/core/error.h"

#include <cstdint>
#include <limits>

namespace vdb_shell
{

InputPoints input_points_of(const RemeshMap& map)
{
    InputPoints input;
    input.points = map.input_points;
    for (const SurfacePoint& place : map.input_on_result) {
        input.corners.push_back(place.corners);
        input.weights.emplace_back(float(place.weights[0]), float(place.weights[1]),
                                   float(place.weights[2]));
    }
    return input;
}

/// Asked before writing, as the reader refuses what does not hold: no file is made that cannot be
/// read.
void require_consistent(const InputPoints& input, std::size_t vertices)
{
    const auto refuse = [](const std::string& what) {
        throw InvalidOption("the shell cannot be written: of the surface before remeshing " + what);
    };
    if (input.points.size() > std::size_t(std::numeric_limits<std::int32_t>::max()))
        refuse("there are more points than 32 bits number");
    if (input.corners.size() != input.points.size() || input.weights.size() != input.points.size())
        refuse("points, corners and weights are not equally many");
    for (std::size_t i = 0; i < input.points.size(); ++i) {
        for (int k = 0; k < 3; ++k)
            if (input.corners[i][k] >= vertices)
                refuse("a corner of point " + std::to_string(i) + " is out of range");
        if (!input.points[i].isFinite() || !input.weights[i].isFinite())
            refuse("point " + std::to_string(i) + " is not finite");
    }
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// The surface before remeshing to a grid of points and back, bit for bit. As in core_grids.cpp a
// point carries its id and its exact position in `rest`.

#include "write/input_points_grid.h"

#include "write/point_grid_builder.h"
#include "write/point_grid_reader.h"

namespace vdb_shell
{

openvdb::points::PointDataGrid::Ptr make_input_points_grid(const InputPoints& input)
{
    PointGridBuilder builder(kInputPointsGrid, input.points);
    builder.add<std::int32_t>("id", [](std::size_t i) { return i; });
    // P of an OpenVDB point is relative to its voxel and need not give the same float again.
    builder.add("rest", input.points);
    builder.add_tuples("corner", 3,
                       [&](std::size_t k) { return input.corners[k / 3][int(k % 3)]; });
    builder.add("weights", input.weights);
    return builder.take();
}

InputPoints read_input_points_grid(const openvdb::points::PointDataGrid& grid, std::int64_t count,
                                   std::size_t vertices, const std::string& name)
{
    const PointGridReader reader(grid, count, name);
    InputPoints input;
    reader.positions("rest", input.points);
    // Three floats that have to be finite, as a position's have.
    reader.positions("weights", input.weights);
    input.corners.resize(input.points.size());
    reader.indices("corner", 3, vertices,
                   [&](std::size_t id, openvdb::Index k, std::uint32_t value) {
                       input.corners[id][int(k)] = value;
                   });
    return input;
}

} // namespace vdb_shell

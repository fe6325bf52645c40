// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "certify/cell_grid.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

enum class CellKind : std::uint8_t { outside, inside, surface };

/// A triangle's extent, to tell at a glance whether a vertical ray may meet it.
struct Shadow {
    float low_x, high_x, low_y, high_y, high_z;
    std::uint32_t triangle;
};

/// Which cells lie inside the surface, which outside, and which the surface may pass through.
struct SolidCells {
    std::vector<CellKind> kind;
    /// Triangles over or under each column of cells: those of column c stand at
    /// [column_offset[c], column_offset[c+1]).
    std::vector<std::uint32_t> column_offset;
    std::vector<Shadow> column_shadow;
};

/// Precondition: the surface lies inside the grid.
SolidCells classify_cells(const CellGrid& grid, const TriangleMesh& surface);

/// Whether the point is inside the closed surface: exact, by the crossings of the upward ray; any
/// winding number but zero is inside. A point on the surface is not. Precondition: the point lies
/// in a cell of the column.
bool inside_solid(const SolidCells& cells, const TriangleMesh& surface, std::uint32_t column,
                  const openvdb::Vec3s& point);

} // namespace vdb_shell

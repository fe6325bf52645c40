// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Voxels on lines along z that lie in a tet, eight lines at a time, in index space.

namespace vdb_shell
{

/// Voxels along an edge of a leaf of OpenVDB's trees.
inline constexpr int kLeafSize = 8;

/// A tet seen along z, in index space.
struct TetShadow {
    /// From its end of the smaller x on; one that is parallel to y has no slope.
    struct Edge {
        double x, y, end_x, slope;
    };
    struct Corner {
        double x, y;
    };
    std::array<Edge, 6> edge;
    std::array<Corner, 4> corner;
    double slack = 0; ///< voxels by which the shadow is taken to be larger
};

/// Rows of voxels along y that lines along z through the tet may come from, for x, x + 1 and so on:
/// `first` above `last` where there is none.
struct Rows {
    std::array<std::int32_t, kLeafSize> first, last;
};

/// The rows of eight x from this one on. Precondition: coordinates below 2^30.
void find_rows(const TetShadow& shadow, int x, Rows& rows);

/// Where lines along z enter and leave a tet: between the highest of the floors and the lowest of
/// the ceilings, where all sides are positive.
struct TetLines {
    /// An affine function of the way from the tet's first corner.
    struct Affine {
        double at, by_x, by_y;
    };
    std::array<Affine, 4> floor, ceiling, side;
    std::size_t floors = 0, ceilings = 0, sides = 0;
    double origin_x = 0, origin_y = 0; ///< the tet's first corner
    double slack = 0;                  ///< added to the sides
    int low_z = 0, high_z = 0;         ///< all voxels of the tet lie between
};

/// Which voxels of each of the eight lines over x and y, y + 1 and so on are inside, `first` above
/// `last` where none is.
struct LineEnds {
    std::array<std::int32_t, kLeafSize> first, last;
};

/// The eight lines over x that begin at y.
void find_line_ends(const TetLines& tet, int x, int y, LineEnds& ends);

/// Voxels `begin` to `end` of the eight of a leaf's row, the first of them at z.
struct DepthRow {
    float* value;
    double depth; ///< at z = 0, but for DepthAlongZ
    int z, begin, end;
};

/// Depth as a function of z: value + (row's depth + slope * (z - origin)), clamped to [least,
/// most].
struct DepthAlongZ {
    double value, slope, origin;
    double least, most;
};

/// Writes the depths into the rows, in order. The voxels of a row that do not lie between begin and
/// end keep what they have.
void fill_depth_rows(const DepthRow* rows, std::size_t count, const DepthAlongZ& depth);

} // namespace vdb_shell

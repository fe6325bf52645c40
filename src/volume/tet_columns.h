// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "vdb_shell/shell/tessellate.h"
#include "volume/depth_lines.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

// Tets over the voxels whose centres lie in them. It goes by columns: each tet is listed in the
// columns of leaves (8 by 8 lines along z) that it may meet, the list is sorted by column and tet,
// and each column is filled by one thread. Where tets overlap the smallest index decides, so a grid
// has the same bits for any number of threads. Everything is in double and in index space. Leaves
// are filled directly, because OpenVDB's accessors would look up the leaf for each voxel.

namespace vdb_shell
{

/// Where voxels are: their size, and the centre of voxel (0, 0, 0).
struct VoxelLattice {
    // Not explicit: most lattices begin at the origin.
    VoxelLattice(double size, const openvdb::Vec3d& centre = openvdb::Vec3d(0.0))
        : voxel_size(size), origin(centre)
    {
    }
    double voxel_size;
    openvdb::Vec3d origin;
};

inline openvdb::math::Transform::Ptr transform_of(const VoxelLattice& lattice)
{
    auto transform = openvdb::math::Transform::createLinearTransform(lattice.voxel_size);
    if (lattice.origin != openvdb::Vec3d(0.0))
        transform->postTranslate(lattice.origin);
    return transform;
}

/// An affine function of index space, value at the tet's first corner and slope.
struct Affine {
    double value = 0;
    openvdb::Vec3d slope{0.0};
};

/// A tet in index space: barycentric coordinates as functions of place.
struct IndexTet {
    std::array<openvdb::Vec3d, 4> corner; ///< the first is the origin of the functions
    std::array<Affine, 4> barycentric;
    Affine value;             ///< of what the points have; 0 where they have nothing
    openvdb::Coord low, high; ///< voxel centres inside lie between, inclusive
    bool flat = false;
};

/// Of the values of all points: rounding must not lead out of it.
struct ValueRange {
    double least = 0, most = 0;
};

/// The part of a tet over one column of leaves.
struct TetInColumn {
    struct Line {
        int row, first, last; ///< x and y as a number of eight times eight, voxels inside
        double value;         ///< slope of the value times way from the tet's origin, of x and y
    };
    std::array<Line, std::size_t(kLeafSize* kLeafSize)> lines;
    std::size_t count = 0;
};

/// One tet in one column of leaves; sorted by column, then tet.
struct TetJob {
    std::int32_t x, y; ///< leaf coordinates
    std::uint32_t tet;
    bool same_column(const TetJob& other) const { return x == other.x && y == other.y; }
    bool operator<(const TetJob& other) const
    {
        return std::tie(x, y, tet) < std::tie(other.x, other.y, other.tet);
    }
};

/// What is to be done, sorted by column. Tets in index space are made again for each job: keeping
/// them would take more memory than all else, and reading them as long.
struct TetColumns {
    const TetMesh& mesh;
    const double* value;                ///< by point, or none
    std::vector<openvdb::Vec3d> points; ///< of the mesh, in index space
    std::vector<TetJob> jobs;
    std::vector<std::size_t> starts; ///< of each column's jobs, and the end of all
    ValueRange range;
};

/// The first and the last voxel along z whose centre may lie in the tet.
std::array<int, 2> heights_of(const TetColumns& columns, const TetJob& job);
IndexTet tet_of(const TetColumns& columns, const TetJob& job);

/// `value`: by point, or empty; it and the mesh have to stay. `wanted`: by tet, whether it counts;
/// empty: all do. Throws InvalidOption, as shell_depth_grid does, its message opened by `name`.
TetColumns tet_columns(const TetMesh& mesh, const std::vector<double>& value,
                       const VoxelLattice& lattice, const char* name,
                       const std::vector<std::uint8_t>& wanted = {});

/// The lines of a column of leaves that run through the tet.
void find_lines(const IndexTet& tet, int leaf_x, int leaf_y, TetInColumn& part);

/// A column of leaves under construction, from the lowest that one of its tets may meet.
template <typename Leaf> struct LeafColumn {
    int x = 0, y = 0, low_z = 0; ///< of the lowest one's origin
    typename Leaf::ValueType background{};
    std::vector<std::unique_ptr<Leaf>> leaf;
};

/// For each row of eight voxels of a leaf that the tet runs through calls row(values, line, z,
/// begin, end): the voxels from begin to end of the eight, the first of which is at z. It
/// overwrites what is there, so it has to be called with the tets in descending order: then the
/// smallest index stays. Going up and testing whether a voxel is set would read the mask of each
/// row first.
template <typename Leaf, typename Row>
void for_rows(LeafColumn<Leaf>& column, const TetInColumn& part, const Row& row)
{
    for (std::size_t i = 0; i < part.count; ++i) {
        const TetInColumn::Line& line = part.lines[i];
        // Clearing the low bits rounds down for negative coordinates too, which a division would
        // not do. Line and leaf agree because OpenVDB's leaves begin at multiples of eight.
        for (int z = line.first & ~(kLeafSize - 1); z <= line.last; z += kLeafSize) {
            std::unique_ptr<Leaf>& leaf = column.leaf[std::size_t(z - column.low_z) / kLeafSize];
            if (!leaf)
                leaf = std::make_unique<Leaf>(openvdb::Coord(column.x, column.y, z),
                                              column.background, false);
            const int begin = std::max(line.first - z, 0),
                      end = std::min(line.last - z + 1, kLeafSize);
            row(leaf->buffer().data() + std::ptrdiff_t(line.row) * kLeafSize, line, z, begin, end);
            // In OpenVDB's leaves z runs fastest. So the voxels of one line are eight values in a
            // row, and their mask is one byte of it.
            auto& bits =
                leaf->getValueMask().template getWord<std::uint8_t>(openvdb::Index(line.row));
            bits = std::uint8_t(bits | (0xffu >> (kLeafSize - (end - begin))) << begin);
        }
    }
}

/// The leaves of a column. fill(column, job, tet, lines) writes a tet's voxels, by for_rows.
template <typename Leaf, typename Fill>
LeafColumn<Leaf> fill_column(const TetColumns& tets, std::size_t index,
                             const typename Leaf::ValueType& background, const Fill& fill)
{
    const TetJob* const first = tets.jobs.data() + tets.starts[index];
    const TetJob* last = tets.jobs.data() + tets.starts[index + 1];
    int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
    for (const TetJob* job = first; job != last; ++job) {
        const auto [from, to] = heights_of(tets, *job);
        low = std::min(low, from);
        high = std::max(high, to);
    }
    LeafColumn<Leaf> column{
        first->x * kLeafSize, first->y * kLeafSize, low & ~(kLeafSize - 1), background, {}};
    // Leaves are made when the first voxel needs them, so gaps in a column cost one pointer each.
    column.leaf.resize(std::size_t(high - column.low_z) / kLeafSize + 1);
    while (last-- != first) {
        TetInColumn part;
        const IndexTet tet = tet_of(tets, *last);
        find_lines(tet, column.x, column.y, part);
        fill(column, *last, tet, part);
    }
    return column;
}

/// All columns into a tree, by one thread: changing the upper nodes of a tree is not safe for
/// several, and the order of the columns makes the tree the same each time.
template <typename Tree, typename Fill>
void fill_columns(const TetColumns& tets, Tree& tree, const StageProgress& progress,
                  const Fill& fill)
{
    using Leaf = typename Tree::LeafNodeType;
    const std::size_t columns = tets.starts.size() - 1;
    std::vector<LeafColumn<Leaf>> filled(columns);
    // Columns are moved into the tree after each fifth of them, which bounds what exists beside the
    // tree, and lets the user stop in between.
    constexpr std::size_t kBatches = 5;
    for (std::size_t batch = 0; batch < kBatches; ++batch) {
        progress.stop_if_interrupted(int(100 * batch / kBatches));
        const std::size_t begin = columns * batch / kBatches;
        const std::size_t end = columns * (batch + 1) / kBatches;
        for_each_index(
            end - begin,
            [&](std::size_t i) {
                filled[begin + i] = fill_column<Leaf>(tets, begin + i, tree.background(), fill);
            },
            1);
        for (std::size_t column = begin; column < end; ++column)
            for (std::unique_ptr<Leaf>& leaf : LeafColumn<Leaf>(std::move(filled[column])).leaf)
                if (leaf)
                    tree.addLeaf(leaf.release());
    }
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes tets and a value at each of their points, gives a float grid over the voxels whose centres
// lie in a tet. It goes by columns: each tet is listed in the columns of leaves (8 by 8 lines along
// z) that it may meet, the list is sorted by column and tet, and each column is filled by one
// thread. Where tets overlap the smallest index decides, so the grid has the same bits for any
// number of threads. Everything is in double and in index space. Leaves are filled directly,
// because OpenVDB's accessors would look up the leaf for each voxel.

#include "write/tet_values_grid.h"

#include "core/bucket_sort.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "vdb_shell/core/error.h"
#include "write/depth_lines.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <tuple>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Coord;
using openvdb::Vec3d;
using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kLeafBits = 3;
static_assert(kLeafSize == 1 << kLeafBits);
/// Added to the barycentric coordinates, which have no unit. Without it a voxel centre on a face
/// could fall between the two tets of that face by rounding, and leave a hole in the grid. It is
/// far above the rounding error of doubles and far below what shows in a voxel.
constexpr double kSlack = 1e-9;
/// Voxel coordinates below 2^30 leave room in 32 bits for the box of a tet, for rounding to leaves,
/// and for the one voxel that depth_lines.cpp goes beyond the box.
constexpr double kLargestCoordinate = double(1 << 30);

/// An affine function of index space, value at the tet's first corner and slope.
struct Affine {
    double value = 0;
    Vec3d slope{0.0};
};

/// A tet in index space: barycentric coordinates as functions of place.
struct IndexTet {
    Vec3d origin{0.0};
    std::array<Affine, 4> barycentric;
    Affine depth;
    Coord low, high; ///< voxel centres inside lie between, inclusive
    bool flat = false;
};

/// Barycentric coordinates come from the cross products over the determinant (Cramer's rule). An
/// inverted tet needs no case of its own: numerator and denominator change their signs together.
IndexTet index_tet(const TetMesh& mesh, std::size_t t, double voxel_size,
                   const std::vector<double>& value)
{
    IndexTet tet;
    std::array<Vec3d, 4> corner;
    Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
    for (std::size_t i = 0; i < 4; ++i) {
        corner[i] = Vec3d(mesh.points[mesh.tets[t][int(i)]]) / voxel_size;
        low = openvdb::math::minComponent(low, corner[i]);
        high = openvdb::math::maxComponent(high, corner[i]);
    }
    for (int axis = 0; axis < 3; ++axis) {
        tet.low[axis] = int(std::ceil(low[axis]));
        tet.high[axis] = int(std::floor(high[axis]));
    }
    tet.origin = corner[0];
    const Vec3d b = corner[1] - corner[0], c = corner[2] - corner[0], d = corner[3] - corner[0];
    const double det = b.dot(c.cross(d));
    // Flat tets have no interior, so they are left out. So are those whose determinant is so small
    // that the slopes overflow.
    tet.flat = det == 0.0;
    if (tet.flat)
        return tet;
    const std::array<Vec3d, 3> slopes{c.cross(d) / det, d.cross(b) / det, b.cross(c) / det};
    tet.barycentric[0] = {1.0, -(slopes[0] + slopes[1] + slopes[2])};
    for (const Vec3d& slope : slopes)
        tet.flat = tet.flat || !std::isfinite(slope.lengthSqr());
    for (std::size_t i = 0; i < 4; ++i) {
        if (i > 0)
            tet.barycentric[i] = {0.0, slopes[i - 1]};
        // It is linear in the tet, so it is the mean of the corners' values weighted by their
        // barycentric coordinates.
        const double corner_value = value[mesh.tets[t][int(i)]];
        tet.depth.value += corner_value * tet.barycentric[i].value;
        tet.depth.slope += corner_value * tet.barycentric[i].slope;
    }
    return tet;
}

/// Each face bounds z from below or from above, by the sign of its coordinate's slope along z; a
/// face that is parallel to z bounds x and y only. Dividing by the slope here saves a division for
/// each line.
TetLines lines_through(const IndexTet& tet)
{
    TetLines lines;
    lines.origin_x = tet.origin[0], lines.origin_y = tet.origin[1];
    lines.slack = kSlack;
    lines.low_z = tet.low.z(), lines.high_z = tet.high.z();
    for (const Affine& weight : tet.barycentric) {
        const double slope = weight.slope[2];
        if (slope == 0.0)
            lines.side[lines.sides++] = {weight.value, weight.slope[0], weight.slope[1]};
        else
            (slope > 0.0 ? lines.floor[lines.floors++] : lines.ceiling[lines.ceilings++]) = {
                tet.origin[2] - (weight.value + kSlack) / slope, -weight.slope[0] / slope,
                -weight.slope[1] / slope};
    }
    return lines;
}

/// Of the values of all points: rounding must not lead out of it.
struct Range {
    double least = 0, most = 0;
};

/// A column of leaves under construction, from the lowest that one of its tets may meet.
struct LeafColumn {
    int x = 0, y = 0, low_z = 0; ///< of the lowest one's origin
    std::vector<std::unique_ptr<Leaf>> leaf;
};

/// The part of a tet over one column of leaves.
struct TetInColumn {
    struct Line {
        int row, first, last; ///< x and y as a number of eight times eight, voxels inside
        double depth;         ///< slope of depth times way from the tet's origin, of x and y
    };
    std::array<Line, std::size_t(kLeafSize* kLeafSize)> lines;
    std::size_t count = 0;
};

void find_lines(const IndexTet& tet, int leaf_x, int leaf_y, TetInColumn& part)
{
    const int x_end = std::min(tet.high.x(), leaf_x + kLeafSize - 1);
    const int y_begin = std::max(tet.low.y(), leaf_y);
    const int y_end = std::min(tet.high.y(), leaf_y + kLeafSize - 1);
    const int x_begin = std::max(tet.low.x(), leaf_x);
    if (x_begin > x_end)
        return;
    // The lines begin at the leaf's own y, so the groups of eight are the same for all tets of a
    // column. Those outside of the tet's box are computed as well and left out below.
    std::array<LineEnds, std::size_t(kLeafSize)> ends_over;
    find_line_ends(lines_through(tet), x_begin, std::size_t(x_end - x_begin) + 1, leaf_y,
                   ends_over.data());
    for (int x = x_begin; x <= x_end; ++x) {
        const LineEnds& ends = ends_over[std::size_t(x - x_begin)];
        for (int y = y_begin; y <= y_end; ++y) {
            const auto k = std::size_t(y - leaf_y);
            if (ends.first[k] > ends.last[k])
                continue;
            const double depth =
                tet.depth.slope[0] * (x - tet.origin[0]) + tet.depth.slope[1] * (y - tet.origin[1]);
            part.lines[part.count++] = {(x - leaf_x) * kLeafSize + y - leaf_y, ends.first[k],
                                        ends.last[k], depth};
        }
    }
}

/// Overwrites what is there, so it has to be called with the tets in descending order: then the
/// smallest index stays. Going up and testing whether a voxel is set would read the mask of each
/// row first.
void fill_lines(LeafColumn& column, const IndexTet& tet, const TetInColumn& part,
                const Range& range, std::vector<DepthRow>& rows)
{
    rows.clear();
    for (std::size_t i = 0; i < part.count; ++i) {
        const TetInColumn::Line& line = part.lines[i];
        // Clearing the low bits rounds down for negative coordinates too, which a division would
        // not do. Line and leaf agree because OpenVDB's leaves begin at multiples of eight.
        for (int z = line.first & ~(kLeafSize - 1); z <= line.last; z += kLeafSize) {
            std::unique_ptr<Leaf>& leaf = column.leaf[std::size_t(z - column.low_z) / kLeafSize];
            if (!leaf)
                leaf = std::make_unique<Leaf>(Coord(column.x, column.y, z), 0.0f, false);
            const int begin = std::max(line.first - z, 0),
                      end = std::min(line.last - z + 1, kLeafSize);
            rows.push_back({leaf->buffer().data() + std::ptrdiff_t(line.row) * kLeafSize,
                            line.depth, z, begin, end});
            // In OpenVDB's leaves z runs fastest. So the voxels of one line are eight values in a
            // row, and their mask is one byte of it.
            auto& bits = leaf->getValueMask().getWord<std::uint8_t>(openvdb::Index(line.row));
            bits = std::uint8_t(bits | (0xffu >> (kLeafSize - (end - begin))) << begin);
        }
    }
    fill_depth_rows(rows.data(), rows.size(),
                    {tet.depth.value, tet.depth.slope[2], tet.origin[2], range.least, range.most});
}

/// One tet in one column of leaves; sorted by column, then tet.
struct Job {
    std::int32_t x, y; ///< leaf coordinates
    std::uint32_t tet;
    bool same_column(const Job& other) const { return x == other.x && y == other.y; }
    bool operator<(const Job& other) const
    {
        return std::tie(x, y, tet) < std::tie(other.x, other.y, other.tet);
    }
};

/// Whether a line of the column of leaves may meet the tet. Each half-space bounds the heights from
/// one side, and it is taken at the place of the column where it allows most. So the answer errs
/// towards yes, which costs time only; a wrong no would leave a hole.
bool may_meet(const IndexTet& tet, int leaf_x, int leaf_y)
{
    // Far above the rounding error of heights and weights.
    constexpr double kHeightSlack = 1e-6, kRounding = 1e-13;
    const double x_low = std::max(tet.low.x(), leaf_x) - tet.origin[0];
    const double x_high = std::min(tet.high.x(), leaf_x + kLeafSize - 1) - tet.origin[0];
    const double y_low = std::max(tet.low.y(), leaf_y) - tet.origin[1];
    const double y_high = std::min(tet.high.y(), leaf_y + kLeafSize - 1) - tet.origin[1];
    const double size = (tet.high - tet.low).asVec3d().length() + 1.0;
    double low = tet.low.z() - tet.origin[2], high = tet.high.z() - tet.origin[2];
    for (const Affine& weight : tet.barycentric) {
        const Vec3d& slope = weight.slope;
        const double slack =
            2 * kSlack +
            kRounding * size * (std::abs(slope[0]) + std::abs(slope[1]) + std::abs(slope[2]));
        // A linear function has its maximum over a rectangle in a corner, and the signs of its
        // slopes say in which.
        const double best = weight.value + slope[0] * (slope[0] > 0.0 ? x_high : x_low) +
                            slope[1] * (slope[1] > 0.0 ? y_high : y_low) + slack;
        if (slope[2] > 0.0)
            low = std::max(low, -best / slope[2] - kHeightSlack);
        else if (slope[2] < 0.0)
            high = std::min(high, -best / slope[2] + kHeightSlack);
        else if (best < 0.0)
            return false;
    }
    return low <= high;
}

void add_jobs(const IndexTet& tet, std::uint32_t index, std::vector<Job>& jobs)
{
    if (tet.flat || tet.low.x() > tet.high.x() || tet.low.y() > tet.high.y() ||
        tet.low.z() > tet.high.z())
        return;
    // The shift rounds towards minus infinity, as leaf coordinates need.
    for (int x = tet.low.x() >> kLeafBits; x <= tet.high.x() >> kLeafBits; ++x)
        for (int y = tet.low.y() >> kLeafBits; y <= tet.high.y() >> kLeafBits; ++y)
            if (may_meet(tet, x * kLeafSize, y * kLeafSize))
                jobs.push_back({x, y, index});
}

constexpr std::size_t kTetsInPart = 256;

/// Tets in parts of a fixed size, and the jobs of each part. The size does not depend on the number
/// of threads, so the jobs come in the same order whichever thread does which part.
struct Parts {
    std::vector<std::vector<IndexTet>> tets;
    std::vector<std::vector<Job>> jobs;
    Range range;

    const IndexTet& tet_of(const Job& job) const
    {
        return tets[job.tet / kTetsInPart][job.tet % kTetsInPart];
    }
};

Parts make_parts(const TetMesh& mesh, double voxel_size, const std::vector<double>& value)
{
    const std::size_t count = (mesh.tets.size() + kTetsInPart - 1) / kTetsInPart;
    Parts parts{
        std::vector<std::vector<IndexTet>>(count), std::vector<std::vector<Job>>(count), {}};
    if (!value.empty()) {
        const auto ends = std::minmax_element(value.begin(), value.end());
        parts.range = {*ends.first, *ends.second};
    }
    for_each_index(
        count,
        [&](std::size_t i) {
            const std::size_t end = std::min((i + 1) * kTetsInPart, mesh.tets.size());
            for (std::size_t t = i * kTetsInPart; t < end; ++t) {
                parts.tets[i].push_back(index_tet(mesh, t, voxel_size, value));
                add_jobs(parts.tets[i].back(), std::uint32_t(t), parts.jobs[i]);
            }
        },
        1);
    return parts;
}

/// Where each column's jobs begin, and the end of all.
std::vector<std::size_t> column_starts(const std::vector<Job>& jobs)
{
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < jobs.size(); ++i)
        if (i == 0 || !jobs[i].same_column(jobs[i - 1]))
            starts.push_back(i);
    starts.push_back(jobs.size());
    return starts;
}

/// The leaves of a column, from all its jobs.
LeafColumn fill_column(const Parts& parts, const Job* first, const Job* last)
{
    int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
    for (const Job* job = first; job != last; ++job) {
        low = std::min(low, parts.tet_of(*job).low.z());
        high = std::max(high, parts.tet_of(*job).high.z());
    }
    LeafColumn column{first->x * kLeafSize, first->y * kLeafSize, low & ~(kLeafSize - 1), {}};
    // Leaves are made when the first voxel needs them, so gaps in a column cost one pointer each.
    column.leaf.resize(std::size_t(high - column.low_z) / kLeafSize + 1);
    std::vector<DepthRow> rows;
    while (last-- != first) {
        TetInColumn part;
        find_lines(parts.tet_of(*last), column.x, column.y, part);
        fill_lines(column, parts.tet_of(*last), part, parts.range, rows);
    }
    return column;
}

void require_voxels_in_range(const TetMesh& mesh, double voxel_size)
{
    if (!(voxel_size > 0.0) || !std::isfinite(voxel_size))
        throw InvalidOption("depth grid: voxel size " + std::to_string(voxel_size) +
                            " is not positive and finite");
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(mesh.points[i][axis] / voxel_size) < kLargestCoordinate))
                throw InvalidOption("depth grid: point " + std::to_string(i) + ", coordinate " +
                                    std::to_string(mesh.points[i][axis]) +
                                    ": too far from the origin for voxel size " +
                                    std::to_string(voxel_size));
}

openvdb::FloatGrid::Ptr empty_grid(double voxel_size)
{
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_size));
    return grid;
}

/// By one thread: changing the upper nodes of a tree is not safe for several, and the order of the
/// columns makes the tree the same each time.
void add_leaves(LeafColumn column, openvdb::FloatGrid& grid)
{
    for (std::unique_ptr<Leaf>& leaf : column.leaf)
        if (leaf)
            grid.tree().addLeaf(leaf.release());
}

} // namespace

openvdb::FloatGrid::Ptr tet_values_grid(const TetMesh& tets, const std::vector<double>& value,
                                        double voxel_size, const StageProgress& progress)
{
    require_voxels_in_range(tets, voxel_size);
    auto grid = empty_grid(voxel_size);
    const Parts parts = make_parts(tets, voxel_size, value);
    const auto jobs = bucket_sort_by_column<Job>(
        parts.jobs,
        [](const Job& job) {
            return std::array<std::int64_t, 2>{job.x, job.y};
        },
        std::less<>());
    const std::vector<std::size_t> starts = column_starts(jobs);
    const std::size_t columns = starts.size() - 1;
    std::vector<LeafColumn> filled(columns);

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
                const std::size_t column = begin + i;
                filled[column] = fill_column(parts, jobs.data() + starts[column],
                                             jobs.data() + starts[column + 1]);
            },
            1);
        for (std::size_t column = begin; column < end; ++column)
            add_leaves(std::move(filled[column]), *grid);
    }
    return grid;
}

} // namespace vdb_shell

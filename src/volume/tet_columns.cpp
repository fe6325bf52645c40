// SPDX-License-Identifier: Apache-2.0

#include "volume/tet_columns.h"

#include "core/bucket_sort.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option_value.h"

#include <cmath>
#include <functional>
#include <string>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

constexpr int kLeafBits = 3;
static_assert(kLeafSize == 1 << kLeafBits);
/// Added to the barycentric coordinates, which have no unit. Without it a voxel centre on a face
/// could fall between the two tets of that face by rounding, and leave a hole in the grid. It is
/// far above the rounding error of doubles and far below what shows in a voxel.
constexpr double kBarycentricSlack = 1e-9;
/// Voxel coordinates below 2^30 leave room in 32 bits for the box of a tet, for rounding to leaves,
/// and for the one voxel that depth_lines.cpp goes beyond the box.
constexpr double kLargestCoordinate = double(1 << 30);

/// Barycentric coordinates come from the cross products over the determinant (Cramer's rule). An
/// inverted tet needs no case of its own: numerator and denominator change their signs together.
IndexTet index_tet(const TetMesh& mesh, std::size_t t, const VoxelLattice& lattice,
                   const std::vector<double>& value)
{
    IndexTet tet;
    std::array<Vec3d, 4> corner;
    Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
    for (std::size_t i = 0; i < 4; ++i) {
        corner[i] =
            (Vec3d(mesh.points[mesh.tets[t][int(i)]]) - lattice.origin) / lattice.voxel_size;
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
        if (value.empty())
            continue;
        // It is linear in the tet, so it is the mean of the corners' values weighted by their
        // barycentric coordinates.
        const double corner_value = value[mesh.tets[t][int(i)]];
        tet.value.value += corner_value * tet.barycentric[i].value;
        tet.value.slope += corner_value * tet.barycentric[i].slope;
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
    lines.slack = kBarycentricSlack;
    lines.low_z = tet.low.z(), lines.high_z = tet.high.z();
    for (const Affine& weight : tet.barycentric) {
        const double slope = weight.slope[2];
        if (slope == 0.0)
            lines.side[lines.sides++] = {weight.value, weight.slope[0], weight.slope[1]};
        else
            (slope > 0.0 ? lines.floor[lines.floors++] : lines.ceiling[lines.ceilings++]) = {
                tet.origin[2] - (weight.value + kBarycentricSlack) / slope,
                -weight.slope[0] / slope, -weight.slope[1] / slope};
    }
    return lines;
}

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
            2 * kBarycentricSlack +
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

void add_jobs(const IndexTet& tet, std::uint32_t index, std::vector<TetJob>& jobs)
{
    // A tet between voxel centres has an empty box and no job. In a coarse grid these are most.
    if (tet.flat || tet.low.x() > tet.high.x() || tet.low.y() > tet.high.y() ||
        tet.low.z() > tet.high.z())
        return;
    // The shift rounds towards minus infinity, as leaf coordinates need.
    for (int x = tet.low.x() >> kLeafBits; x <= tet.high.x() >> kLeafBits; ++x)
        for (int y = tet.low.y() >> kLeafBits; y <= tet.high.y() >> kLeafBits; ++y)
            if (may_meet(tet, x * kLeafSize, y * kLeafSize))
                jobs.push_back({x, y, index});
}

void require_voxels_in_range(const TetMesh& mesh, const VoxelLattice& lattice,
                             const std::string& name)
{
    const double voxel_size = lattice.voxel_size;
    if (!(voxel_size > 0.0) || !std::isfinite(voxel_size))
        throw InvalidOption(name + ": voxel size " + text_of(voxel_size) +
                            " is not positive and finite");
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs((mesh.points[i][axis] - lattice.origin[axis]) / voxel_size) <
                  kLargestCoordinate))
                throw InvalidOption(name + ": point " + std::to_string(i) + ", coordinate " +
                                    text_of(double(mesh.points[i][axis])) +
                                    ": too far from the origin for voxel size " +
                                    text_of(voxel_size));
}

/// The jobs of each part come in the same order whichever thread does which part.
std::vector<std::vector<TetJob>> list_jobs(const TetMesh& mesh, const std::vector<double>& value,
                                           const VoxelLattice& lattice,
                                           const std::vector<std::uint8_t>& wanted,
                                           std::vector<std::vector<IndexTet>>& tets)
{
    std::vector<std::vector<TetJob>> jobs(tets.size());
    for_each_index(
        tets.size(),
        [&](std::size_t i) {
            const std::size_t end = std::min((i + 1) * kTetsInPart, mesh.tets.size());
            for (std::size_t t = i * kTetsInPart; t < end; ++t) {
                tets[i].push_back(index_tet(mesh, t, lattice, value));
                if (wanted.empty() || wanted[t])
                    add_jobs(tets[i].back(), std::uint32_t(t), jobs[i]);
            }
        },
        1);
    return jobs;
}

/// One more than columns: each column ends where the next one starts.
std::vector<std::size_t> column_starts(const std::vector<TetJob>& jobs)
{
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < jobs.size(); ++i)
        if (i == 0 || !jobs[i].same_column(jobs[i - 1]))
            starts.push_back(i);
    starts.push_back(jobs.size());
    return starts;
}

} // namespace

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
            const double value =
                tet.value.slope[0] * (x - tet.origin[0]) + tet.value.slope[1] * (y - tet.origin[1]);
            part.lines[part.count++] = {(x - leaf_x) * kLeafSize + y - leaf_y, ends.first[k],
                                        ends.last[k], value};
        }
    }
}

TetColumns tet_columns(const TetMesh& mesh, const std::vector<double>& value,
                       const VoxelLattice& lattice, const char* name,
                       const std::vector<std::uint8_t>& wanted)
{
    require_voxels_in_range(mesh, lattice, name);
    TetColumns columns;
    columns.tets.resize((mesh.tets.size() + kTetsInPart - 1) / kTetsInPart);
    if (!value.empty()) {
        const auto ends = std::minmax_element(value.begin(), value.end());
        columns.range = {*ends.first, *ends.second};
    }
    columns.jobs = bucket_sort_by_column<TetJob>(
        list_jobs(mesh, value, lattice, wanted, columns.tets),
        [](const TetJob& job) {
            return std::array<std::int64_t, 2>{job.x, job.y};
        },
        std::less<>());
    columns.starts = column_starts(columns.jobs);
    return columns;
}

} // namespace vdb_shell

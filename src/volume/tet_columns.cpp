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

/// Corners in index space, and the voxel centres that lie between them.
IndexTet boxed_tet(const TetColumns& columns, std::size_t t)
{
    IndexTet tet;
    Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
    for (std::size_t i = 0; i < 4; ++i) {
        tet.corner[i] = columns.points[columns.mesh.tets[t][int(i)]];
        low = openvdb::math::minComponent(low, tet.corner[i]);
        high = openvdb::math::maxComponent(high, tet.corner[i]);
    }
    for (int axis = 0; axis < 3; ++axis) {
        tet.low[axis] = int(std::ceil(low[axis]));
        tet.high[axis] = int(std::floor(high[axis]));
    }
    return tet;
}

/// A tet between voxel centres has none. In a coarse grid these are most.
bool has_centres_between(const IndexTet& tet)
{
    return tet.low.x() <= tet.high.x() && tet.low.y() <= tet.high.y() &&
           tet.low.z() <= tet.high.z();
}

/// Barycentric coordinates come from the cross products over the determinant (Cramer's rule). An
/// inverted tet needs no case of its own: numerator and denominator change their signs together.
void set_coordinates(IndexTet& tet)
{
    const auto& [a, p, q, r] = tet.corner;
    const Vec3d b = p - a, c = q - a, d = r - a;
    const double det = b.dot(c.cross(d));
    // Flat tets have no interior, so they are left out. So are those whose determinant is so small
    // that the slopes overflow.
    tet.flat = det == 0.0;
    if (tet.flat)
        return;
    const std::array<Vec3d, 3> slopes{c.cross(d) / det, d.cross(b) / det, b.cross(c) / det};
    tet.barycentric[0] = {1.0, -(slopes[0] + slopes[1] + slopes[2])};
    for (std::size_t i = 0; i < 3; ++i) {
        tet.barycentric[i + 1] = {0.0, slopes[i]};
        tet.flat = tet.flat || !std::isfinite(slopes[i].lengthSqr());
    }
}

/// The value is linear in the tet, so it is the mean of the corners' values weighted by their
/// barycentric coordinates.
void set_value(IndexTet& tet, const openvdb::Vec4I& points, const double* value)
{
    for (std::size_t i = 0; i < 4; ++i) {
        const double corner_value = value[points[int(i)]];
        tet.value.value += corner_value * tet.barycentric[i].value;
        tet.value.slope += corner_value * tet.barycentric[i].slope;
    }
}

TetShadow shadow_of(const IndexTet& tet)
{
    TetShadow shadow;
    // Far above the rounding of places and the slack of coordinates, which moves a face by no more
    // than that share of the tet.
    shadow.slack = 1e-6 * (1.0 + (tet.high - tet.low).asVec3d().length());
    std::size_t edges = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        shadow.corner[i] = {tet.corner[i][0], tet.corner[i][1]};
        for (std::size_t j = 0; j < i; ++j) {
            const bool ascending = tet.corner[i][0] < tet.corner[j][0];
            const Vec3d &p = tet.corner[ascending ? i : j], &q = tet.corner[ascending ? j : i];
            const double width = q[0] - p[0];
            shadow.edge[edges++] = {p[0], p[1], q[0], width > 0 ? (q[1] - p[1]) / width : 0.0};
        }
    }
    return shadow;
}

/// Each face bounds z from below or from above, by the sign of its coordinate's slope along z; a
/// face that is parallel to z bounds x and y only. Dividing by the slope here saves a division for
/// each line.
TetLines lines_through(const IndexTet& tet)
{
    TetLines lines;
    lines.origin_x = tet.corner[0][0], lines.origin_y = tet.corner[0][1];
    lines.slack = kBarycentricSlack;
    lines.low_z = tet.low.z(), lines.high_z = tet.high.z();
    for (const Affine& weight : tet.barycentric) {
        const double slope = weight.slope[2];
        if (slope == 0.0)
            lines.side[lines.sides++] = {weight.value, weight.slope[0], weight.slope[1]};
        else
            (slope > 0.0 ? lines.floor[lines.floors++] : lines.ceiling[lines.ceilings++]) = {
                tet.corner[0][2] - (weight.value + kBarycentricSlack) / slope,
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
    const Vec3d& origin = tet.corner[0];
    const double x_low = std::max(tet.low.x(), leaf_x) - origin[0];
    const double x_high = std::min(tet.high.x(), leaf_x + kLeafSize - 1) - origin[0];
    const double y_low = std::max(tet.low.y(), leaf_y) - origin[1];
    const double y_high = std::min(tet.high.y(), leaf_y + kLeafSize - 1) - origin[1];
    const double size = (tet.high - tet.low).asVec3d().length() + 1.0;
    double low = tet.low.z() - origin[2], high = tet.high.z() - origin[2];
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
    const TetShadow shadow = shadow_of(tet);
    // The shift rounds towards minus infinity, as leaf coordinates need.
    for (int leaf_x = tet.low.x() >> kLeafBits; leaf_x <= tet.high.x() >> kLeafBits; ++leaf_x) {
        const int origin = leaf_x * kLeafSize;
        Rows rows;
        find_rows(shadow, origin, rows);
        int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
        const int end = std::min(tet.high.x() - origin, kLeafSize - 1);
        for (int x = std::max(tet.low.x() - origin, 0); x <= end; ++x) {
            const int from = rows.first[std::size_t(x)], to = rows.last[std::size_t(x)];
            if (from > to)
                continue;
            first = std::min(first, from);
            last = std::max(last, to);
        }
        // Long thin tets pass between most lines, and then nothing is asked of their half-spaces.
        if (first > last)
            continue;
        for (int leaf_y = first >> kLeafBits; leaf_y <= last >> kLeafBits; ++leaf_y)
            if (may_meet(tet, leaf_x * kLeafSize, leaf_y * kLeafSize))
                jobs.push_back({leaf_x, leaf_y, index});
    }
}

std::vector<Vec3d> points_in_voxels(const TetMesh& mesh, const VoxelLattice& lattice,
                                    const std::string& name)
{
    const double voxel_size = lattice.voxel_size;
    if (!(voxel_size > 0.0) || !std::isfinite(voxel_size))
        throw InvalidOption(name + ": voxel size " + text_of(voxel_size) +
                            " is not positive and finite");
    std::vector<Vec3d> points(mesh.points.size());
    for_each_index(
        points.size(),
        [&](std::size_t i) { points[i] = (Vec3d(mesh.points[i]) - lattice.origin) / voxel_size; },
        1024);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(points[i][axis]) < kLargestCoordinate))
                throw InvalidOption(name + ": point " + std::to_string(i) + ", coordinate " +
                                    text_of(double(mesh.points[i][axis])) +
                                    ": too far from the origin for voxel size " +
                                    text_of(voxel_size));
    return points;
}

/// In parts of a fixed size, so that the jobs of each come in the same order whichever thread does
/// which part.
std::vector<std::vector<TetJob>> list_jobs(const TetColumns& columns,
                                           const std::vector<std::uint8_t>& wanted)
{
    constexpr std::size_t kTetsInPart = 256;
    const std::size_t count = columns.mesh.tets.size();
    std::vector<std::vector<TetJob>> jobs((count + kTetsInPart - 1) / kTetsInPart);
    for_each_index(
        jobs.size(),
        [&](std::size_t i) {
            const std::size_t end = std::min((i + 1) * kTetsInPart, count);
            for (std::size_t t = i * kTetsInPart; t < end; ++t) {
                if (!wanted.empty() && !wanted[t])
                    continue;
                IndexTet tet = boxed_tet(columns, t);
                if (!has_centres_between(tet))
                    continue;
                set_coordinates(tet);
                if (!tet.flat)
                    add_jobs(tet, std::uint32_t(t), jobs[i]);
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

std::array<int, 2> heights_of(const TetColumns& columns, const TetJob& job)
{
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int i = 0; i < 4; ++i) {
        const double z = columns.points[columns.mesh.tets[job.tet][i]][2];
        low = std::min(low, z);
        high = std::max(high, z);
    }
    return {int(std::ceil(low)), int(std::floor(high))};
}

IndexTet tet_of(const TetColumns& columns, const TetJob& job)
{
    IndexTet tet = boxed_tet(columns, job.tet);
    set_coordinates(tet);
    if (columns.value)
        set_value(tet, columns.mesh.tets[job.tet], columns.value);
    return tet;
}

void find_lines(const IndexTet& tet, int leaf_x, int leaf_y, TetInColumn& part)
{
    const int x_begin = std::max(tet.low.x(), leaf_x);
    const int x_end = std::min(tet.high.x(), leaf_x + kLeafSize - 1);
    const TetLines through = lines_through(tet);
    Rows rows;
    find_rows(shadow_of(tet), leaf_x, rows);
    for (int x = x_begin; x <= x_end; ++x) {
        const auto row = std::size_t(x - leaf_x);
        const int y_begin = std::max({tet.low.y(), leaf_y, rows.first[row]});
        const int y_end = std::min({tet.high.y(), leaf_y + kLeafSize - 1, rows.last[row]});
        if (y_begin > y_end)
            continue;
        // The lines begin at the leaf's own y, so the groups of eight are the same for all tets of
        // a column. Those outside of the tet's shadow are computed as well and left out.
        LineEnds ends;
        find_line_ends(through, x, leaf_y, ends);
        for (int y = y_begin; y <= y_end; ++y) {
            const auto k = std::size_t(y - leaf_y);
            if (ends.first[k] > ends.last[k])
                continue;
            const double value = tet.value.slope[0] * (x - tet.corner[0][0]) +
                                 tet.value.slope[1] * (y - tet.corner[0][1]);
            part.lines[part.count++] = {(x - leaf_x) * kLeafSize + y - leaf_y, ends.first[k],
                                        ends.last[k], value};
        }
    }
}

TetColumns tet_columns(const TetMesh& mesh, const std::vector<double>& value,
                       const VoxelLattice& lattice, const char* name,
                       const std::vector<std::uint8_t>& wanted)
{
    TetColumns columns{
        mesh, value.empty() ? nullptr : value.data(), points_in_voxels(mesh, lattice, name), {}, {},
        {}};
    if (!value.empty()) {
        const auto ends = std::minmax_element(value.begin(), value.end());
        columns.range = {*ends.first, *ends.second};
    }
    columns.jobs = bucket_sort_by_column<TetJob>(
        list_jobs(columns, wanted),
        [](const TetJob& job) {
            return std::array<std::int64_t, 2>{job.x, job.y};
        },
        std::less<>());
    columns.starts = column_starts(columns.jobs);
    return columns;
}

} // namespace vdb_shell

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
IndexTet boxed_tet(const TetMesh& mesh, std::size_t t, const VoxelLattice& lattice)
{
    IndexTet tet;
    Vec3d low(std::numeric_limits<double>::infinity()), high = -low;
    for (std::size_t i = 0; i < 4; ++i) {
        tet.corner[i] =
            (Vec3d(mesh.points[mesh.tets[t][int(i)]]) - lattice.origin) / lattice.voxel_size;
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

/// The rows of voxels along y that lines along z through a tet may come from.
class Shadow
{
public:
    explicit Shadow(const IndexTet& tet) : corner_(tet.corner)
    {
        // Far above the rounding of places and the slack of coordinates, which moves a face by no
        // more than that share of the tet.
        slack_ = 1e-6 * (1.0 + (tet.high - tet.low).asVec3d().length());
    }

    /// First and last y at this x; none where the first is above the last.
    std::array<int, 2> rows_at(int x) const
    {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        const auto add = [&](double y) { low = std::min(low, y), high = std::max(high, y); };
        // The shadow is convex, so it lies between the places where edges pass x.
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const Vec3d &p = corner_[i], &q = corner_[j];
                const double to_p = p[0] - x, to_q = q[0] - x;
                if (std::abs(to_p) <= slack_)
                    add(p[1]);
                if (std::abs(to_q) <= slack_)
                    add(q[1]);
                if ((to_p < 0) != (to_q < 0))
                    add(p[1] + (q[1] - p[1]) * (to_p / (to_p - to_q)));
            }
        if (low > high)
            return {0, -1};
        return {int(std::ceil(low - slack_)), int(std::floor(high + slack_))};
    }

private:
    const std::array<Vec3d, 4>& corner_;
    double slack_;
};

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
    const Shadow shadow(tet);
    // The shift rounds towards minus infinity, as leaf coordinates need.
    for (int leaf_x = tet.low.x() >> kLeafBits; leaf_x <= tet.high.x() >> kLeafBits; ++leaf_x) {
        int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
        const int end = std::min(tet.high.x(), leaf_x * kLeafSize + kLeafSize - 1);
        for (int x = std::max(tet.low.x(), leaf_x * kLeafSize); x <= end; ++x) {
            const auto [from, to] = shadow.rows_at(x);
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
                IndexTet tet = boxed_tet(columns.mesh, t, columns.lattice);
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
    const IndexTet tet = boxed_tet(columns.mesh, job.tet, columns.lattice);
    return {tet.low.z(), tet.high.z()};
}

IndexTet tet_of(const TetColumns& columns, const TetJob& job)
{
    IndexTet tet = boxed_tet(columns.mesh, job.tet, columns.lattice);
    set_coordinates(tet);
    if (columns.value)
        set_value(tet, columns.mesh.tets[job.tet], columns.value);
    return tet;
}

void find_lines(const IndexTet& tet, int leaf_x, int leaf_y, TetInColumn& part)
{
    const int x_begin = std::max(tet.low.x(), leaf_x);
    const int x_end = std::min(tet.high.x(), leaf_x + kLeafSize - 1);
    const Shadow shadow(tet);
    const TetLines through = lines_through(tet);
    for (int x = x_begin; x <= x_end; ++x) {
        const auto [from, to] = shadow.rows_at(x);
        const int y_begin = std::max({tet.low.y(), leaf_y, from});
        const int y_end = std::min({tet.high.y(), leaf_y + kLeafSize - 1, to});
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
    require_voxels_in_range(mesh, lattice, name);
    TetColumns columns{mesh, value.empty() ? nullptr : value.data(), lattice, {}, {}, {}};
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

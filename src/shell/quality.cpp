// SPDX-License-Identifier: Apache-2.0

// Takes: tets in float32. Gives: order statistics of six measures of their shape, computed in
// doubles. Nothing is decided by them: an angle or a ratio near its limit is a matter of opinion,
// and whether a tet is inverted is for the exact signs (certify/tet_signs.h). The mean ratio is
// that of Liu and Joe, "On the shape of tetrahedra from bisection", 1994; the aspect is the usual
// one turned over, so that a flat tet gets nought and not infinity. Every tet writes its own place
// in a list and sums run in index order, so no bit depends on the number of threads. Time is linear
// in the number of tets.

#include "vdb_shell/shell/quality.h"

#include "core/parallel.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Corners = std::array<Vec3d, 4>;

constexpr std::size_t kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d)
{
    return (b - a).cross(c - a).dot(d - a);
}

/// The angle at an edge between the two faces that meet there, 0 to pi whatever the orientation.
struct Dihedral {
    double sine, cosine; ///< times any length
    /// Falls from 1 to -1 while the angle grows from 0 to pi, and needs no arctangent: six angles
    /// of each tet are compared by it, and only the two extreme ones are computed. Without sine and
    /// cosine (a face without area) the rank is that of the angle 0, which is what angle() gives
    /// there too.
    double rank() const
    {
        const double both = sine + std::abs(cosine);
        return both > 0 ? cosine / both : 1.0;
    }
    double angle() const { return std::atan2(sine, cosine); }
};

/// Normals of the faces, as long as twice their areas.
std::array<Vec3d, 4> face_normals(const Corners& p)
{
    std::array<Vec3d, 4> normal;
    for (std::size_t i = 0; i < 4; ++i) {
        const openvdb::Vec3I face = tet_face({0, 1, 2, 3}, i);
        normal[i] = (p[face[1]] - p[face[0]]).cross(p[face[2]] - p[face[0]]);
    }
    return normal;
}

/// Between two faces of a tet.
Dihedral dihedral(const Vec3d& first, const Vec3d& second)
{
    // The areas of both faces are factors of the sine and of the cosine alike, so nothing is
    // normalised, and there is nothing to divide by where a face has no area. The length of a cross
    // product is never negative, which is why the angle does not tell the orientation.
    return {first.cross(second).length(), -first.dot(second)};
}

struct DihedralRange {
    double min, max;
};
DihedralRange dihedral_range(const std::array<Vec3d, 4>& normal)
{
    std::array<Dihedral, 6> at;
    std::array<double, 6> rank;
    for (std::size_t e = 0; e < 6; ++e) {
        at[e] = dihedral(normal[kEdges[e][0]], normal[kEdges[e][1]]);
        rank[e] = at[e].rank();
    }
    const auto [most, least] = std::minmax_element(rank.begin(), rank.end());
    return {at[std::size_t(least - rank.begin())].angle(),
            at[std::size_t(most - rank.begin())].angle()};
}

struct EdgeRange {
    double shortest = std::numeric_limits<double>::infinity(), longest = 0;
};
EdgeRange edge_range(const Corners& p)
{
    EdgeRange squared;
    for (const auto& edge : kEdges) {
        const double length = (p[edge[1]] - p[edge[0]]).lengthSqr();
        squared.shortest = std::min(squared.shortest, length);
        squared.longest = std::max(squared.longest, length);
    }
    return {std::sqrt(squared.shortest), std::sqrt(squared.longest)};
}

/// A spread is of finite values.
Spread spread_of_finite(std::vector<double> values)
{
    values.erase(std::remove_if(values.begin(), values.end(),
                                [](double value) { return !std::isfinite(value); }),
                 values.end());
    return spread_of(std::move(values));
}

double height_ratio(const Corners& p, const std::array<Vec3d, 4>& normal, double longest_edge)
{
    double largest_double_area = 0;
    for (const Vec3d& n : normal)
        largest_double_area = std::max(largest_double_area, n.length());
    if (largest_double_area == 0)
        return 0;
    // Each face times its height gives the same volume, so the largest face has the smallest
    // height.
    const double smallest_height =
        std::abs(six_volumes(p[0], p[1], p[2], p[3])) / largest_double_area;
    constexpr double kRegular = 0.81649658092772603; // height of the regular tet of edge 1
    return smallest_height / (longest_edge * kRegular);
}

} // namespace

Spread spread_of(std::vector<double> values)
{
    if (values.empty())
        return {};
    Spread spread;
    for (const double value : values)
        spread.mean += value;
    spread.mean /= static_cast<double>(values.size());
    // Nearest rank: the result is always one of the values, so nothing is interpolated and rounding
    // cannot differ between machines.
    const auto last = static_cast<double>(values.size() - 1);
    auto from = values.begin();
    // Shares have to come in ascending order: after each call no value before `from` is larger than
    // any behind it, so the next call partitions the remaining part only, and all six together take
    // linear time on average.
    auto at = [&](double share) {
        const auto place =
            values.begin() + static_cast<std::ptrdiff_t>(std::floor(share * last + 0.5));
        std::nth_element(from, place, values.end());
        from = place;
        return *place;
    };
    spread.min = at(0.0);
    spread.p1 = at(0.01);
    spread.p5 = at(0.05);
    spread.median = at(0.5);
    spread.p95 = at(0.95);
    spread.max = at(1.0);
    return spread;
}

double mean_ratio(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d)
{
    const double half_six_volumes = 0.5 * six_volumes(a, b, c, d);
    const double squared_edges = (b - a).lengthSqr() + (c - a).lengthSqr() + (d - a).lengthSqr() +
                                 (c - b).lengthSqr() + (d - b).lengthSqr() + (d - c).lengthSqr();
    if (squared_edges == 0)
        return 0;
    // The root of a negative volume is negative and its square is not, so the sign is put back
    // afterwards: an inverted tet has the value of its mirror image with a minus.
    const double root = std::cbrt(half_six_volumes);
    return std::copysign(12 * root * root, half_six_volumes) / squared_edges;
}

TetShape shape_of(const std::array<Vec3d, 4>& p)
{
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const double ratio = mean_ratio(p[0], p[1], p[2], p[3]);
    const std::array<Vec3d, 4> normal = face_normals(p);
    const DihedralRange range = dihedral_range(normal);
    const EdgeRange edges = edge_range(p);
    return {ratio,
            range.min,
            range.max,
            height_ratio(p, normal, edges.longest),
            ratio > 0 ? 3 / ratio : kInfinity,
            edges.shortest > 0 ? edges.longest / edges.shortest : kInfinity};
}

TetShape shape_of(const TetMesh& mesh, std::size_t t)
{
    Corners p;
    for (int corner = 0; corner < 4; ++corner)
        p[static_cast<std::size_t>(corner)] = Vec3d(mesh.points[mesh.tets[t][corner]]);
    return shape_of(p);
}

QualityReport measure_quality(const TetMesh& mesh)
{
    const std::size_t count = mesh.tets.size();
    std::vector<TetShape> shape(count);
    for_each_index(count, [&](std::size_t i) { shape[i] = shape_of(mesh, i); });
    const auto all = [&](double TetShape::*figure) {
        std::vector<double> values(count);
        std::transform(shape.begin(), shape.end(), values.begin(),
                       [figure](const TetShape& s) { return s.*figure; });
        return values;
    };
    QualityReport report;
    report.mean_ratio = spread_of(all(&TetShape::mean_ratio));
    report.min_dihedral_radians = spread_of(all(&TetShape::min_dihedral_radians));
    report.max_dihedral_radians = spread_of(all(&TetShape::max_dihedral_radians));
    report.aspect = spread_of(all(&TetShape::aspect));
    report.amips = spread_of_finite(all(&TetShape::amips));
    report.edge_ratio = spread_of_finite(all(&TetShape::edge_ratio));
    for (const TetShape& s : shape) {
        report.slivers += s.min_dihedral_radians < kSliverRadians;
        report.sofa_bad += s.sofa_bad();
    }
    return report;
}

} // namespace vdb_shell

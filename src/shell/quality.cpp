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
#include "core/raw_vector.h"
#include "shell/tet_faces.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Corners = std::array<Vec3d, 4>;

constexpr std::size_t kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

Corners corners_in_double(const TetMesh& mesh, std::size_t t)
{
    Corners p;
    for (int corner = 0; corner < 4; ++corner)
        p[static_cast<std::size_t>(corner)] = Vec3d(mesh.points[mesh.tets[t][corner]]);
    return p;
}

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

/// Leaves the values in another order.
Spread spread_between(double* begin, double* end)
{
    if (begin == end)
        return {};
    Spread spread;
    spread.min = spread.max = *begin;
    for (const double* value = begin; value != end; ++value) {
        spread.mean += *value;
        spread.min = std::min(spread.min, *value);
        spread.max = std::max(spread.max, *value);
    }
    spread.mean /= static_cast<double>(end - begin);
    // Nearest rank: the result is always one of the values, so nothing is interpolated and rounding
    // cannot differ between machines.
    const auto place = [&](double share) {
        return begin + static_cast<std::ptrdiff_t>(
                           std::floor(share * static_cast<double>(end - begin - 1) + 0.5));
    };
    // The median first: what stands before it or behind it then is all that the others are sought
    // in.
    double *const p1 = place(0.01), *const p5 = place(0.05), *const median = place(0.5),
                  *const p95 = place(0.95);
    std::nth_element(begin, median, end);
    spread.median = *median;
    std::nth_element(begin, p5, median);
    spread.p5 = *p5;
    std::nth_element(begin, p1, p5);
    spread.p1 = *p1;
    std::nth_element(median, p95, end);
    spread.p95 = *p95;
    return spread;
}

} // namespace

Spread spread_of(std::vector<double> values)
{
    return spread_between(values.data(), values.data() + values.size());
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

double mean_ratio(const TetMesh& mesh, std::size_t t)
{
    const Corners p = corners_in_double(mesh, t);
    return mean_ratio(p[0], p[1], p[2], p[3]);
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
    return shape_of(corners_in_double(mesh, t));
}

QualityReport measure_quality(const TetMesh& mesh)
{
    struct Figure {
        double TetShape::*of_tet;
        Spread QualityReport::*spread;
        RawVector<double> values; ///< by tet
    };
    std::array<Figure, 6> figures{
        {{&TetShape::mean_ratio, &QualityReport::mean_ratio, {}},
         {&TetShape::min_dihedral_radians, &QualityReport::min_dihedral_radians, {}},
         {&TetShape::max_dihedral_radians, &QualityReport::max_dihedral_radians, {}},
         {&TetShape::aspect, &QualityReport::aspect, {}},
         {&TetShape::amips, &QualityReport::amips, {}},
         {&TetShape::edge_ratio, &QualityReport::edge_ratio, {}}}};
    const std::size_t count = mesh.tets.size();
    for (Figure& figure : figures)
        figure.values.resize(count);
    std::atomic<std::size_t> slivers{0}, sofa_bad{0};
    for_each_range(
        count,
        [&](std::size_t begin, std::size_t end) {
            std::size_t slivers_here = 0, sofa_bad_here = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const TetShape shape = shape_of(mesh, i);
                for (Figure& figure : figures)
                    figure.values[i] = shape.*figure.of_tet;
                slivers_here += shape.min_dihedral_radians < kSliverRadians;
                sofa_bad_here += shape.sofa_bad();
            }
            slivers += slivers_here;
            sofa_bad += sofa_bad_here;
        },
        1024);
    QualityReport report;
    for_each_index(
        figures.size(),
        [&](std::size_t f) {
            // A spread is of finite values.
            double *const begin = figures[f].values.data(), *const end = std::remove_if(
                                                                begin, begin + count,
                                                                [](double value) {
                                                                    return !std::isfinite(value);
                                                                });
            report.*figures[f].spread = spread_between(begin, end);
        },
        1);
    report.slivers = slivers;
    report.sofa_bad = sofa_bad;
    return report;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
// Mean ratio: Liu, Joe, "On the shape of tetrahedra from bisection", 1994.
#include "vdb_shell/shell/quality.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using Corners = std::array<Vec3d, 4>;

constexpr std::size_t kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr std::size_t kOpposite[6][2] = {{2, 3}, {1, 3}, {1, 2}, {0, 3}, {0, 2}, {0, 1}};

double six_volumes(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d)
{
    return (b - a).cross(c - a).dot(d - a);
}

/// The angle at an edge between the two faces that meet there, 0 to pi whatever the orientation.
struct Dihedral {
    double sine, cosine; ///< times any length
    /// Falls where the angle grows, and is sooner found.
    double rank() const
    {
        const double both = sine + std::abs(cosine);
        return both > 0 ? cosine / both : 1.0;
    }
    double angle() const { return std::atan2(sine, cosine); }
};

Dihedral dihedral(const Vec3d& from, const Vec3d& to, const Vec3d& left, const Vec3d& right)
{
    const Vec3d edge = to - from;
    const Vec3d first = edge.cross(left - from), second = edge.cross(right - from);
    return {first.cross(second).length(), first.dot(second)};
}

struct DihedralRange {
    double min, max;
};
DihedralRange dihedral_range(const Corners& p)
{
    std::array<Dihedral, 6> at;
    std::array<double, 6> rank;
    for (std::size_t e = 0; e < 6; ++e) {
        at[e] = dihedral(p[kEdges[e][0]], p[kEdges[e][1]], p[kOpposite[e][0]], p[kOpposite[e][1]]);
        rank[e] = at[e].rank();
    }
    const auto [most, least] = std::minmax_element(rank.begin(), rank.end());
    return {at[std::size_t(least - rank.begin())].angle(),
            at[std::size_t(most - rank.begin())].angle()};
}

double height_ratio(const Corners& p)
{
    double longest = 0, largest_double_area = 0;
    for (const auto& edge : kEdges)
        longest = std::max(longest, (p[edge[1]] - p[edge[0]]).length());
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3d& q = p[(i + 1) % 4];
        const Vec3d normal = (p[(i + 2) % 4] - q).cross(p[(i + 3) % 4] - q);
        largest_double_area = std::max(largest_double_area, normal.length());
    }
    if (largest_double_area == 0)
        return 0;
    const double smallest_height =
        std::abs(six_volumes(p[0], p[1], p[2], p[3])) / largest_double_area;
    constexpr double kRegular = 0.81649658092772603; // height of the regular tet of edge 1
    return smallest_height / (longest * kRegular);
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
    const auto last = static_cast<double>(values.size() - 1);
    auto from = values.begin();
    // Shares in ascending order: what lies before the one looked for is settled.
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
    const double root = std::cbrt(half_six_volumes);
    return std::copysign(12 * root * root, half_six_volumes) / squared_edges;
}

QualityReport measure_quality(const TetMesh& mesh)
{
    const std::size_t count = mesh.tets.size();
    std::vector<double> ratio(count), smallest(count), largest(count), aspect(count);
    for_each_index(count, [&](std::size_t i) {
        Corners p;
        for (int corner = 0; corner < 4; ++corner)
            p[static_cast<std::size_t>(corner)] = Vec3d(mesh.points[mesh.tets[i][corner]]);
        ratio[i] = mean_ratio(p[0], p[1], p[2], p[3]);
        const DihedralRange range = dihedral_range(p);
        smallest[i] = range.min;
        largest[i] = range.max;
        aspect[i] = height_ratio(p);
    });
    return {spread_of(std::move(ratio)), spread_of(std::move(smallest)),
            spread_of(std::move(largest)), spread_of(std::move(aspect))};
}

} // namespace vdb_shell

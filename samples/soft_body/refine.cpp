// SPDX-License-Identifier: Apache-2.0

// Takes a solid and leaves the same one with eight times the tets. Functions that are linear in
// each coarse tet are so in each fine one, which multigrid builds upon.

#include "refine.h"

#include <Eigen/Geometry>

#include <algorithm>

namespace soft_body
{
namespace
{

using Edge = std::array<int, 2>;

// Edges of a tet in the order of its midpoints 4 to 9 below.
constexpr int kEdges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr int kCorners[4][4] = {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}};
// A diagonal of the octahedron, then the four midpoints around it.
constexpr int kDiagonals[3][6] = {{4, 9, 5, 6, 8, 7}, {5, 8, 4, 6, 9, 7}, {6, 7, 4, 5, 9, 8}};

Edge edge(const Tet& tet, int k)
{
    const int a = tet[std::size_t(kEdges[k][0])], b = tet[std::size_t(kEdges[k][1])];
    return {std::min(a, b), std::max(a, b)};
}

std::vector<Edge> all_edges(const std::vector<Tet>& tets)
{
    std::vector<Edge> edges;
    edges.reserve(6 * tets.size());
    for (const Tet& tet : tets)
        for (int k = 0; k < 6; ++k)
            edges.push_back(edge(tet, k));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

void add_positive(Solid& solid, Tet tet)
{
    const Points& p = solid.points;
    const Eigen::Vector3d a = p.col(tet[0]);
    if ((p.col(tet[1]) - a).cross(p.col(tet[2]) - a).dot(p.col(tet[3]) - a) < 0)
        std::swap(tet[2], tet[3]);
    solid.tets.push_back(tet);
}

void add_eight(Solid& fine, const std::array<int, 10>& at)
{
    const auto corner = [&](int k) { return at[std::size_t(k)]; };
    for (const auto& t : kCorners)
        add_positive(fine, {corner(t[0]), corner(t[1]), corner(t[2]), corner(t[3])});
    const auto length = [&](const int* d) {
        return (fine.points.col(corner(d[0])) - fine.points.col(corner(d[1]))).squaredNorm();
    };
    const int* shortest = kDiagonals[0];
    for (const auto& d : kDiagonals)
        if (length(d) < length(shortest))
            shortest = d;
    for (int k = 0; k < 4; ++k)
        add_positive(fine, {corner(shortest[0]), corner(shortest[1]), corner(shortest[2 + k]),
                            corner(shortest[2 + (k + 1) % 4])});
}

} // namespace

Refined refine(const Solid& coarse)
{
    Refined fine;
    fine.parents = all_edges(coarse.tets);
    const auto old = coarse.points.cols();
    fine.solid.points.resize(3, old + Eigen::Index(fine.parents.size()));
    fine.solid.points.leftCols(old) = coarse.points;
    for (std::size_t i = 0; i < fine.parents.size(); ++i)
        fine.solid.points.col(old + Eigen::Index(i)) =
            (coarse.points.col(fine.parents[i][0]) + coarse.points.col(fine.parents[i][1])) / 2;
    fine.solid.tets.reserve(8 * coarse.tets.size());
    for (const Tet& tet : coarse.tets) {
        std::array<int, 10> at{tet[0], tet[1], tet[2], tet[3]};
        for (int k = 0; k < 6; ++k) {
            const auto found =
                std::lower_bound(fine.parents.begin(), fine.parents.end(), edge(tet, k));
            at[std::size_t(k) + 4] = int(old) + int(found - fine.parents.begin());
        }
        add_eight(fine.solid, at);
    }
    return fine;
}

} // namespace soft_body

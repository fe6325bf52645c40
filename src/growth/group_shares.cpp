// SPDX-License-Identifier: Apache-2.0

// Takes: a coarser surface, and for each vertex of the finer one a point on it. Gives: for each
// vertex of the coarser surface the finer ones around it, with the values of its hat function.

#include "growth/group_shares.h"

#include "core/parallel_sort.h"

namespace vdb_shell::growth
{

std::vector<GroupShare> group_shares(const TriangleMesh& coarse,
                                     const std::vector<CoarsePoint>& points)
{
    // With less a vertex hardly moves, but costs as much.
    constexpr double kLeastWeight = 0.05;
    std::vector<GroupShare> shares;
    for (std::size_t v = 0; v < points.size(); ++v)
        for (std::size_t k = 0; k < 3; ++k)
            if (points[v].weight[k] > kLeastWeight)
                shares.push_back(
                    {static_cast<int>(coarse.triangles[points[v].triangle][static_cast<int>(k)]),
                     static_cast<int>(v), points[v].weight[k]});
    parallel_sort(shares.begin(), shares.end(), [](const GroupShare& x, const GroupShare& y) {
        return x.group != y.group ? x.group < y.group : x.vertex < y.vertex;
    });
    return shares;
}

} // namespace vdb_shell::growth

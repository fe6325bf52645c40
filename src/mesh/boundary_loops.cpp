// SPDX-License-Identifier: Apache-2.0

// Parts the boundary edges of any surface, however bad, into walks. Each edge is in exactly one
// walk, and a closed walk passes no point twice, so that it can be the rim of one hole. The idea is
// the one by which a graph of even degrees falls into cycles: go on along unused edges, and cut a
// loop off as soon as a point comes again. The result depends on the edges only, since the smallest
// neighbour is always the next. Trap: a point is looked for along the whole path, so one loop of n
// edges takes a time that grows with the square of n.

#include "mesh/boundary_loops.h"

#include <algorithm>
#include <map>

namespace vdb_shell
{
namespace
{

/// The edges that no walk has taken yet, around each point, ascending.
class OpenEdges
{
public:
    explicit OpenEdges(const std::vector<Edge>& edges)
    {
        for (const Edge& edge : edges) {
            neighbours_[edge[0]].push_back(edge[1]);
            neighbours_[edge[1]].push_back(edge[0]);
        }
        for (auto& [point, others] : neighbours_)
            std::sort(others.begin(), others.end());
    }

    std::size_t count(std::uint32_t point) const { return neighbours_.at(point).size(); }

    /// Uses up the edge to the smallest neighbour and returns that.
    std::uint32_t take_smallest(std::uint32_t point)
    {
        const std::uint32_t other = neighbours_.at(point).front();
        take(point, other);
        take(other, point);
        return other;
    }

private:
    void take(std::uint32_t from, std::uint32_t to)
    {
        std::vector<std::uint32_t>& others = neighbours_.at(from);
        others.erase(std::find(others.begin(), others.end(), to));
    }

    std::map<std::uint32_t, std::vector<std::uint32_t>> neighbours_;
};

/// Walks on from `start` until there is no way on; every loop that closes on the way is cut off.
void walk_from(std::uint32_t start, OpenEdges& open, std::vector<BoundaryWalk>& walks)
{
    std::vector<std::uint32_t> path{start};
    while (open.count(path.back()) > 0) {
        const std::uint32_t next = open.take_smallest(path.back());
        const auto seen = std::find(path.begin(), path.end(), next);
        if (seen == path.end()) {
            path.push_back(next);
            continue;
        }
        // The point where the loop closes stays on the path, because the walk goes on from it.
        walks.push_back({{seen, path.end()}, true});
        path.erase(seen + 1, path.end());
    }
    if (path.size() > 1)
        walks.push_back({path, false});
}

} // namespace

std::vector<BoundaryWalk> boundary_walks(const std::vector<Edge>& boundary_edges)
{
    OpenEdges open(boundary_edges);
    std::vector<BoundaryWalk> walks;
    // Each closed loop takes two edges at each of its points. So a point with an odd number of
    // edges is the end of a walk that cannot close, and such walks start there first. After them
    // all numbers are even, and every walk that starts comes back.
    for (const bool odd_only : {true, false})
        for (const Edge& edge : boundary_edges)
            for (const std::uint32_t point : edge)
                while (open.count(point) > 0 && (!odd_only || open.count(point) % 2 == 1))
                    walk_from(point, open, walks);
    return walks;
}

} // namespace vdb_shell

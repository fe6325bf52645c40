// SPDX-License-Identifier: Apache-2.0

// Parts the boundary edges of any surface, however bad, into walks. Each edge is in exactly one
// walk, and a closed walk passes no point twice, so that it can be the rim of one hole. The idea is
// the one by which a graph of even degrees falls into cycles: go on along unused edges, and cut a
// loop off as soon as a point comes again. The result depends on the edges only, since the smallest
// neighbour is always the next. Each point knows its place on the path and the first of its edges
// that may be unused, so after the sort the time is linear, however long a loop is and however many
// edges a point has.

#include "mesh/boundary_loops.h"

#include "core/sort_unique.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace vdb_shell
{
namespace
{

/// The edges that no walk has taken yet, around each point, ascending. Points are numbered anew,
/// without gaps and in their order.
class OpenEdges
{
public:
    explicit OpenEdges(const std::vector<Edge>& edges)
    {
        for (const Edge& edge : edges)
            points_.insert(points_.end(), edge.begin(), edge.end());
        sort_unique(points_);
        for (std::uint32_t e = 0; e < edges.size(); ++e) {
            const std::uint32_t a = number_of(edges[e][0]), b = number_of(edges[e][1]);
            ways_.push_back({a, b, e});
            ways_.push_back({b, a, e});
        }
        std::sort(ways_.begin(), ways_.end(), [](const Way& x, const Way& y) {
            return std::tie(x.from, x.to, x.edge) < std::tie(y.from, y.to, y.edge);
        });
        taken_.resize(edges.size());
        count_.resize(points_.size());
        next_.resize(points_.size());
        for (std::size_t i = ways_.size(); i-- > 0;) {
            ++count_[ways_[i].from];
            next_[ways_[i].from] = i;
        }
    }

    std::size_t points() const { return points_.size(); }
    std::uint32_t point(std::uint32_t number) const { return points_[number]; }
    std::uint32_t number_of(std::uint32_t point) const
    {
        const auto at = std::lower_bound(points_.begin(), points_.end(), point);
        return static_cast<std::uint32_t>(at - points_.begin());
    }
    std::size_t count(std::uint32_t number) const { return count_[number]; }

    /// Uses up the edge to the smallest neighbour and returns that. Precondition: there is one.
    std::uint32_t take_smallest(std::uint32_t number)
    {
        std::size_t& next = next_[number];
        while (taken_[ways_[next].edge])
            ++next;
        const Way& way = ways_[next];
        taken_[way.edge] = 1;
        --count_[way.from];
        --count_[way.to];
        return way.to;
    }

private:
    struct Way {
        std::uint32_t from, to, edge;
    };
    std::vector<std::uint32_t> points_;
    std::vector<Way> ways_; ///< each edge both ways
    std::vector<char> taken_;
    std::vector<std::size_t> count_, next_; ///< by point: unused edges; the first way that may be
};

/// A path on which each point's place is known.
class Path
{
public:
    static constexpr std::size_t kNowhere = SIZE_MAX;

    explicit Path(std::size_t points) : place_(points, kNowhere) {}
    std::size_t size() const { return numbers_.size(); }
    std::uint32_t back() const { return numbers_.back(); }
    std::size_t place(std::uint32_t number) const { return place_[number]; }
    void add(std::uint32_t number)
    {
        place_[number] = numbers_.size();
        numbers_.push_back(number);
    }
    void shorten(std::size_t size)
    {
        for (; numbers_.size() > size; numbers_.pop_back())
            place_[numbers_.back()] = kNowhere;
    }
    BoundaryWalk walk_from(std::size_t place, bool closed, const OpenEdges& open) const
    {
        BoundaryWalk walk{{}, closed};
        for (std::size_t i = place; i < numbers_.size(); ++i)
            walk.points.push_back(open.point(numbers_[i]));
        return walk;
    }

private:
    std::vector<std::uint32_t> numbers_;
    std::vector<std::size_t> place_;
};

/// Walks on from `start` until there is no way on; every loop that closes on the way is cut off.
/// The path is empty before and after.
void walk_from(std::uint32_t start, OpenEdges& open, Path& path, std::vector<BoundaryWalk>& walks)
{
    path.add(start);
    while (open.count(path.back()) > 0) {
        const std::uint32_t next = open.take_smallest(path.back());
        const std::size_t place = path.place(next);
        if (place == Path::kNowhere) {
            path.add(next);
            continue;
        }
        // The point where the loop closes stays on the path, because the walk goes on from it.
        walks.push_back(path.walk_from(place, true, open));
        path.shorten(place + 1);
    }
    if (path.size() > 1)
        walks.push_back(path.walk_from(0, false, open));
    path.shorten(0);
}

} // namespace

std::vector<BoundaryWalk> boundary_walks(const std::vector<Edge>& boundary_edges)
{
    OpenEdges open(boundary_edges);
    Path path(open.points());
    std::vector<BoundaryWalk> walks;
    // Each closed loop takes two edges at each of its points. So a point with an odd number of
    // edges is the end of a walk that cannot close, and such walks start there first. After them
    // all numbers are even, and every walk that starts comes back.
    for (const bool odd_only : {true, false})
        for (const Edge& edge : boundary_edges)
            for (const std::uint32_t point : edge) {
                const std::uint32_t number = open.number_of(point);
                while (open.count(number) > 0 && (!odd_only || open.count(number) % 2 == 1))
                    walk_from(number, open, path, walks);
            }
    return walks;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes triangles of which some have the same three points, whichever way they run, and leaves at
// most one of each. Whether one stays is a question of parity: an edge of a closed surface has an
// even number of triangles. One repeat by itself cannot tell where its neighbours are repeats too,
// so repeats that hang together by edges of no other triangle are one region, which stays or goes
// as a whole: the edges at its rim decide by majority. So a partition that two closed bodies have
// in common goes. A region without a rim is closed by itself, as all of a body whose faces are
// there twice: it stays, but for an interface in the inside of a solid, whose two sides cancel. All
// edges are counted before anything goes, so the result does not depend on any order.

#include "repair/working_surface.h"

#include "core/box_pairs.h"
#include "core/box_tree.h"
#include "core/disjoint_sets.h"
#include "core/exact.h"
#include "mesh/surface_defects.h"
#include "mesh/triangle_area.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>
#include <utility>

namespace vdb_shell::repair
{
namespace
{

using Corners = std::array<std::uint32_t, 3>;
using Indices = std::vector<std::uint32_t>;

Corners sorted_corners(const openvdb::Vec3I& triangle)
{
    Corners corners{triangle[0], triangle[1], triangle[2]};
    std::sort(corners.begin(), corners.end());
    return corners;
}

/// Triangles of the same three points.
struct Group {
    Corners corners;
    Indices triangles; ///< ascending
};

std::vector<Group> groups_of(const std::vector<openvdb::Vec3I>& triangles)
{
    std::vector<std::pair<Corners, std::uint32_t>> sorted;
    sorted.reserve(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        sorted.emplace_back(sorted_corners(triangles[t]), t);
    std::sort(sorted.begin(), sorted.end());
    std::vector<Group> groups;
    for (const auto& [corners, t] : sorted) {
        if (groups.empty() || groups.back().corners != corners)
            groups.push_back({corners, {}});
        groups.back().triangles.push_back(t);
    }
    return groups;
}

struct GroupEdge {
    Edge edge;
    std::uint32_t group;
};

/// The edges of all groups, those of one edge together.
std::vector<GroupEdge> edges_of(const std::vector<Group>& groups)
{
    std::vector<GroupEdge> edges;
    edges.reserve(3 * groups.size());
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
        const Corners& c = groups[g].corners;
        for (const Edge& edge : {Edge{c[0], c[1]}, Edge{c[1], c[2]}, Edge{c[0], c[2]}})
            edges.push_back({edge, g});
    }
    std::sort(edges.begin(), edges.end(), [](const GroupEdge& a, const GroupEdge& b) {
        return std::tie(a.edge, a.group) < std::tie(b.edge, b.group);
    });
    return edges;
}

template <typename Look> void for_each_edge(const std::vector<GroupEdge>& edges, const Look& look)
{
    for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].edge == edges[begin].edge)
            ++end;
        look(begin, end);
    }
}

/// What is known of the repeats: by group its region, the smallest group of it.
class Regions
{
public:
    Regions(const TriangleMesh& mesh, const std::vector<Group>& groups)
        : mesh_(mesh), groups_(groups), edges_(edges_of(groups)), region_(groups.size())
    {
        DisjointSets classes(groups.size());
        for_each_edge(edges_, [&](std::size_t begin, std::size_t end) {
            if (end - begin == 2 && repeated(edges_[begin].group) &&
                repeated(edges_[begin + 1].group))
                classes.join(edges_[begin].group, edges_[begin + 1].group);
        });
        for (std::uint32_t g = 0; g < groups_.size(); ++g)
            region_[g] = classes.root_of(g);
    }

    /// By region whether one of each triangle stays.
    std::vector<char> wanted() const
    {
        const std::vector<std::int64_t> votes = count_votes();
        std::vector<char> stays(groups_.size());
        std::vector<double> area(groups_.size());
        double all = 0;
        for (std::uint32_t g = 0; g < groups_.size(); ++g) {
            const double one = triangle_area(mesh_.points, triangle(g));
            area[region_[g]] += one;
            all += one;
        }
        const std::vector<char> open = open_regions();
        const std::vector<openvdb::Vec3I> solid = odd_triangles();
        BoxTree boxes;
        boxes.build(triangle_boxes(mesh_.points, solid));
        for (std::uint32_t g = 0; g < groups_.size(); ++g) {
            if (region_[g] != g || !repeated(g))
                continue;
            // A rim at which nothing else is may be that of a surface with holes, or that of a
            // loose scrap, which no fill could close.
            constexpr double kScrap = 0.25;
            if (votes[g] != 0)
                stays[g] = votes[g] > 0;
            else
                stays[g] = (!open[g] || area[g] >= kScrap * all) &&
                           !(cancels(g) && is_inside(g, solid, boxes));
        }
        return stays;
    }

    std::uint32_t region(std::uint32_t group) const { return region_[group]; }

private:
    bool repeated(std::uint32_t g) const { return groups_[g].triangles.size() > 1; }
    const openvdb::Vec3I& triangle(std::uint32_t g) const
    {
        return mesh_.triangles[groups_[g].triangles.front()];
    }
    /// By region: the edges that need it to be even, less those that are even without it. An edge
    /// where a region has an even number of triangles, or nothing else is, tells nothing.
    std::vector<std::int64_t> count_votes() const
    {
        std::vector<std::int64_t> votes(groups_.size());
        std::vector<std::array<std::size_t, 2>> here; // region, and its triangles there
        for_each_edge(edges_, [&](std::size_t begin, std::size_t end) {
            here.clear();
            std::size_t all = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint32_t g = edges_[i].group;
                here.push_back({region_[g], groups_[g].triangles.size()});
                all += here.back()[1];
            }
            std::sort(here.begin(), here.end());
            for (std::size_t i = 0, next = 0; i < here.size(); i = next) {
                std::size_t own = 0;
                for (; next < here.size() && here[next][0] == here[i][0]; ++next)
                    own += here[next][1];
                if (repeated(static_cast<std::uint32_t>(here[i][0])) && (next - i) % 2 == 1 &&
                    all > own)
                    votes[here[i][0]] += (all - own) % 2 == 1 ? 1 : -1;
            }
        });
        return votes;
    }

    std::vector<char> open_regions() const
    {
        std::vector<char> open(groups_.size());
        for_each_edge(edges_, [&](std::size_t begin, std::size_t end) {
            if (end - begin == 1)
                open[region_[edges_[begin].group]] = 1;
        });
        return open;
    }

    /// What bounds solids for certain: triangles that are there an odd number of times.
    std::vector<openvdb::Vec3I> odd_triangles() const
    {
        std::vector<openvdb::Vec3I> odd;
        for (std::uint32_t g = 0; g < groups_.size(); ++g)
            if (groups_[g].triangles.size() % 2 == 1)
                odd.push_back(triangle(g));
        return odd;
    }

    /// Whether as many copies run one way as the other.
    bool cancels(std::uint32_t g) const
    {
        int sum = 0;
        for (const std::uint32_t t : groups_[g].triangles) {
            const openvdb::Vec3I& c = mesh_.triangles[t];
            sum += (c[0] < c[1]) + (c[1] < c[2]) + (c[2] < c[0]) == 2 ? 1 : -1;
        }
        return sum == 0;
    }

    /// Whether a ray upward from a corner of a region crosses an odd number of the triangles.
    bool is_inside(std::uint32_t g, const std::vector<openvdb::Vec3I>& solid,
                   const BoxTree& boxes) const
    {
        const openvdb::Vec3s& point = mesh_.points[triangle(g)[0]];
        FloatBox above = FloatBox::around(point);
        above.add(openvdb::Vec3s(point[0], point[1], std::numeric_limits<float>::max()));
        bool inside = false;
        boxes.for_each_overlap(above, [&](int i) {
            const openvdb::Vec3I& t = solid[std::size_t(i)];
            bool on_surface = false;
            inside ^= exact::crossing_above(point, mesh_.points[t[0]], mesh_.points[t[1]],
                                            mesh_.points[t[2]], on_surface) != 0;
        });
        return inside;
    }

    const TriangleMesh& mesh_;
    const std::vector<Group>& groups_;
    std::vector<GroupEdge> edges_;
    Indices region_;
};

} // namespace

void drop_duplicates(WorkingSurface& surface, RepairReport& report)
{
    const std::vector<Group> groups = groups_of(surface.mesh.triangles);
    if (groups.size() == surface.mesh.triangles.size())
        return;
    const Regions regions(surface.mesh, groups);
    const std::vector<char> stays = regions.wanted();
    std::vector<char> drop(surface.mesh.triangles.size());
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
        const Indices& same = groups[g].triangles;
        if (same.size() == 1)
            continue;
        for (std::size_t i = stays[regions.region(g)] ? 1 : 0; i < same.size(); ++i)
            drop[same[i]] = 1;
    }
    for (std::uint32_t t = 0; t < drop.size(); ++t)
        if (drop[t])
            add_to(report.duplicates, surface.source[t]);
    drop_triangles(surface, drop);
}

} // namespace vdb_shell::repair

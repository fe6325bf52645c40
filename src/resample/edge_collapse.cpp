// SPDX-License-Identifier: Apache-2.0

// Takes a closed surface and leaves a closed one of some of its vertices, in their places. Each
// vertex knows the cheapest of its allowed collapses; a round sorts these and does the cheapest of
// them that do not touch one done before, so that what was found in parallel holds when it is done
// in sequence. Costs are those of Garland and Heckbert 1997, "Surface simplification using quadric
// error metrics", on the edge's own ends. The distance is bounded as in Klein, Liebich and Strasser
// 1996, "Mesh reduction with error control": by points of the input that each triangle keeps for
// those that it has replaced. The trap is that triangles which are no neighbours are not compared,
// so the result may cross itself.

#include "resample/edge_collapse.h"

#include "core/parallel.h"
#include "core/parallel_sort.h"
#include "core/propose_in_blocks.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/topology.h"
#include "mesh/triangle_corners.h"
#include "resample/quadric.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

// A triangle may turn by 40 degrees in one collapse, of which this is the cosine; more is the
// beginning of a fold.
constexpr double kLeastCosine = 0.766;

struct Collapse {
    double cost = std::numeric_limits<double>::infinity();
    std::uint32_t onto = 0;
};

Vec3d cross_of(const Vec3d& a, const Vec3d& b, const Vec3d& c)
{
    return (b - a).cross(c - a);
}

/// Longest edge over height, squared.
double squared_aspect(const Vec3d& a, const Vec3d& b, const Vec3d& c, double squared_cross)
{
    const double longest =
        std::max({(b - a).lengthSqr(), (c - b).lengthSqr(), (a - c).lengthSqr()});
    return squared_cross > 0 ? longest * longest / squared_cross
                             : std::numeric_limits<double>::infinity();
}

class Collapser
{
public:
    Collapser(const TriangleMesh& mesh, const CollapseLimits& limits)
        : limits_(limits), points_(mesh.points.size()), triangles_(mesh.triangles),
          quadric_(mesh.points.size()), best_(mesh.points.size()), touched_(mesh.points.size(), 1)
    {
        // Relative to a point of the surface: the terms of a quadric are squares of coordinates,
        // which would cancel far from the origin.
        const Vec3d origin = mesh.points.empty() ? Vec3d(0.0) : Vec3d(mesh.points.front());
        for_each_index(points_.size(),
                       [&](std::size_t v) { points_[v] = Vec3d(mesh.points[v]) - origin; });
        around_ = triangles_around_vertices(points_.size(), triangles_);
        for_each_index(points_.size(), [&](std::size_t v) { add_planes(v); });
        if (bounds_distance())
            place_samples();
    }

    void run()
    {
        const auto has_more = [&] { return triangles_.size() > limits_.fewest_triangles; };
        bool more = has_more();
        while (more) {
            more = round() && has_more();
            if (more)
                around_ = triangles_around_vertices(points_.size(), triangles_);
        }
    }

    const std::vector<Vec3I>& triangles() const { return triangles_; }

private:
    /// Adds the planes of the triangles around a vertex to its quadric.
    void add_planes(std::size_t v)
    {
        for (const std::uint32_t triangle : around_.around(v)) {
            const Vec3I& t = triangles_[triangle];
            const Vec3d cross = cross_of(points_[t[0]], points_[t[1]], points_[t[2]]);
            const double length = cross.length();
            if (length > 0)
                quadric_[v].add_plane(cross / length, -cross.dot(points_[t[0]]) / length,
                                      0.5 * length);
        }
    }

    /// The vertices, by their own numbers; after them, if wanted, the middles of triangles and
    /// edges, each with a triangle that it lies on.
    void place_samples()
    {
        samples_ = points_;
        samples_of_.resize(triangles_.size());
        for (std::size_t t = 0; t < triangles_.size() && limits_.between_vertices; ++t) {
            const Vec3I& c = triangles_[t];
            const auto add = [&](const Vec3d& p) {
                samples_of_[t].push_back(static_cast<std::uint32_t>(samples_.size()));
                samples_.push_back(p);
            };
            add((points_[c[0]] + points_[c[1]] + points_[c[2]]) / 3.0);
            for (int k = 0; k < 3; ++k)
                if (c[k] < c[(k + 1) % 3])
                    add(0.5 * (points_[c[k]] + points_[c[(k + 1) % 3]]));
        }
    }

    bool bounds_distance() const { return std::isfinite(limits_.distance); }
    bool is_fixed(std::size_t v) const { return !limits_.fixed.empty() && limits_.fixed[v]; }

    /// Does one round; false where nothing is left to collapse. A vertex is looked at anew only
    /// where a collapse of the round before changed a triangle of it or of its target. Elsewhere
    /// its choice is allowed as before, for the tests read nothing beyond those triangles, though a
    /// cheaper one may have become possible. Each index writes its own slot, and the collapses
    /// themselves are done in one order, so threads do not matter.
    bool round()
    {
        for_each_range(points_.size(), [&](std::size_t begin, std::size_t end) {
            Scratch scratch;
            for (std::size_t v = begin; v < end; ++v)
                if (is_touched(static_cast<std::uint32_t>(v)))
                    best_[v] = best_collapse(static_cast<std::uint32_t>(v), scratch);
        });
        std::fill(touched_.begin(), touched_.end(), 0);
        // On a closed surface each collapse removes two triangles.
        const std::size_t done =
            collapse_in_order(cheapest(), (triangles_.size() - limits_.fewest_triangles + 1) / 2);
        drop_collapsed();
        return done > 0;
    }

    /// Does as many of these as are wanted, but for those that touch one done before; how many. All
    /// threads list what the collapses of a block would touch, one chooses, and all do what is
    /// chosen: that has no triangle and no target in common.
    std::size_t collapse_in_order(const std::vector<std::uint32_t>& order, std::size_t wanted)
    {
        constexpr std::size_t kBlock = 4096;
        std::vector<std::vector<std::uint32_t>> stars(std::min(kBlock, order.size()));
        std::vector<std::uint32_t> chosen;
        std::size_t done = 0;
        const auto do_chosen = [&] {
            for_each_index(chosen.size(), [&](std::size_t i) { collapse(chosen[i]); });
            chosen.clear();
        };
        propose_in_blocks(
            order.size(), kBlock, do_chosen,
            [&](std::size_t i, std::size_t slot) {
                const std::uint32_t v = order[i];
                stars[slot].clear();
                if (done == wanted || is_touched(v))
                    return;
                for (const std::uint32_t t : around_.around(v))
                    for (int k = 0; k < 3; ++k)
                        stars[slot].push_back(triangles_[t][k]);
            },
            [&](std::size_t i, std::size_t slot) {
                if (done == wanted || is_touched(order[i]))
                    return;
                for (const std::uint32_t w : stars[slot])
                    touched_[w] = 1;
                chosen.push_back(order[i]);
                ++done;
            });
        do_chosen();
        return done;
    }

    /// Whether another collapse has touched what that of the vertex needs.
    bool is_touched(std::uint32_t v) const { return touched_[v] || touched_[best_[v].onto]; }

    void drop_collapsed()
    {
        constexpr std::size_t kBlock = std::size_t(1) << 14;
        const auto stays = [&](std::size_t t) { return triangles_[t][0] != triangles_[t][1]; };
        const auto for_each_block = [&](const auto& visit) {
            for_each_index((triangles_.size() + kBlock - 1) / kBlock,
                           [&](std::size_t block) {
                               visit(block, block * kBlock,
                                     std::min(triangles_.size(), (block + 1) * kBlock));
                           },
                           1);
        };
        // By block, where what is left of it begins.
        std::vector<std::size_t> begin(triangles_.size() / kBlock + 2, 0);
        for_each_block([&](std::size_t block, std::size_t first, std::size_t last) {
            for (std::size_t t = first; t < last; ++t)
                begin[block + 1] += stays(t);
        });
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<Vec3I> triangles(begin.back());
        std::vector<std::vector<std::uint32_t>> samples_of(bounds_distance() ? begin.back() : 0);
        for_each_block([&](std::size_t block, std::size_t first, std::size_t last) {
            std::size_t left = begin[block];
            for (std::size_t t = first; t < last; ++t) {
                if (!stays(t))
                    continue;
                if (bounds_distance())
                    samples_of[left] = std::move(samples_of_[t]);
                triangles[left++] = triangles_[t];
            }
        });
        triangles_ = std::move(triangles);
        samples_of_ = std::move(samples_of);
    }

    /// Vertices in the order of what their collapses cost, as many as a round may take. A closed
    /// surface has about half as many vertices as triangles. Equal costs go by index, so that the
    /// order is total and the selection is the same for any standard library.
    std::vector<std::uint32_t> cheapest() const
    {
        std::vector<std::uint32_t> order;
        for (std::size_t v = 0; v < best_.size(); ++v)
            if (std::isfinite(best_[v].cost))
                order.push_back(static_cast<std::uint32_t>(v));
        const auto before = [&](std::uint32_t v, std::uint32_t w) {
            return best_[v].cost != best_[w].cost ? best_[v].cost < best_[w].cost : v < w;
        };
        const auto least =
            std::ptrdiff_t(limits_.share_of_round * double(triangles_.size()) / 2) + 1;
        if (std::ptrdiff_t(order.size()) > least) {
            std::nth_element(order.begin(), order.begin() + least, order.end(), before);
            order.resize(std::size_t(least));
        }
        parallel_sort(order.begin(), order.end(), before);
        return order;
    }

    void collapse(std::uint32_t v)
    {
        const std::uint32_t u = best_[v].onto;
        for (const std::uint32_t t : around_.around(v)) {
            Vec3I& corners = triangles_[t];
            if (corners[0] == u || corners[1] == u || corners[2] == u)
                corners = Vec3I(u); // to be removed
            else
                for (int k = 0; k < 3; ++k)
                    corners[k] = corners[k] == v ? u : corners[k];
        }
        if (bounds_distance())
            reassign_samples(v);
        // The sum of both quadrics goes on counting every plane that the vertex has stood for;
        // planes of triangles with both ends count more than once, as in the source of the method.
        quadric_[u] += quadric_[v];
        best_[v] = {};
    }

    /// After v has gone: it and the samples of its triangles go to the nearest of the triangles
    /// that are left around it, because later collapses test the samples of the triangles around
    /// their vertex only.
    void reassign_samples(std::uint32_t v)
    {
        std::vector<std::uint32_t> samples{v};
        Fan fan;
        std::vector<std::uint32_t> left;
        for (const std::uint32_t t : around_.around(v)) {
            samples.insert(samples.end(), samples_of_[t].begin(), samples_of_[t].end());
            samples_of_[t].clear();
            const Vec3I& c = triangles_[t];
            if (c[0] == c[1])
                continue;
            left.push_back(t);
            fan.push_back({points_[c[0]], points_[c[1]], points_[c[2]]});
        }
        for (const std::uint32_t w : samples) {
            std::size_t nearest = 0;
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < fan.size(); ++i) {
                const double squared = squared_distance(fan[i], samples_[w]);
                if (squared < least)
                    least = squared, nearest = i;
            }
            samples_of_[left[nearest]].push_back(w);
        }
    }

    using Fan = std::vector<std::array<Vec3d, 3>>;

    /// What a thread needs to look at one vertex after another.
    struct Scratch {
        std::vector<std::uint32_t> ring;
        std::vector<Collapse> candidates;
        Fan fan;
    };

    Collapse best_collapse(std::uint32_t v, Scratch& scratch) const
    {
        auto& [ring, candidates, fan] = scratch;
        ring.clear(), candidates.clear();
        if (is_fixed(v))
            return {};
        double worst_aspect = kWorstAspect * kWorstAspect;
        for (const std::uint32_t t : around_.around(v)) {
            const Vec3I& c = triangles_[t];
            // Closed and consistent: each neighbour is once the next corner.
            ring.push_back(corner_after(c, v));
            const Vec3d &p = points_[c[0]], &q = points_[c[1]], &r = points_[c[2]];
            worst_aspect =
                std::max(worst_aspect, squared_aspect(p, q, r, cross_of(p, q, r).lengthSqr()));
        }
        for (const std::uint32_t u : ring) {
            const double error = quadric_[v].at(points_[u]) + quadric_[u].at(points_[u]);
            const double length2 = (points_[u] - points_[v]).lengthSqr();
            if (error > limits_.quadric_error ||
                length2 > limits_.longest_edge * limits_.longest_edge)
                continue;
            candidates.push_back(
                {std::max(0.0, error) + limits_.length_weight * quadric_[v].area * length2, u});
        }
        // Cheapest first, so the dear tests below are made until the first success only.
        std::sort(candidates.begin(), candidates.end(), [](const Collapse& a, const Collapse& b) {
            return a.cost != b.cost ? a.cost < b.cost : a.onto < b.onto;
        });
        for (const Collapse& candidate : candidates)
            if (keeps_shape(v, candidate.onto, worst_aspect) &&
                keeps_manifold(ring, candidate.onto) && keeps_distance(v, candidate.onto, fan))
                return candidate;
        return {};
    }

    bool keeps_shape(std::uint32_t v, std::uint32_t u, double worst_aspect) const
    {
        for (const std::uint32_t t : around_.around(v)) {
            const Vec3I& c = triangles_[t];
            if (c[0] == u || c[1] == u || c[2] == u)
                continue;
            std::array<Vec3d, 3> p{points_[c[0]], points_[c[1]], points_[c[2]]};
            const Vec3d before = cross_of(p[0], p[1], p[2]);
            for (int k = 0; k < 3; ++k)
                if (c[k] == v)
                    p[static_cast<std::size_t>(k)] = points_[u];
            const Vec3d after = cross_of(p[0], p[1], p[2]);
            const double squared = after.lengthSqr(), dot = before.dot(after);
            if (!(dot > 0 &&
                  dot * dot > kLeastCosine * kLeastCosine * before.lengthSqr() * squared))
                return false;
            if (squared_aspect(p[0], p[1], p[2], squared) > worst_aspect)
                return false;
        }
        return true;
    }

    /// The link condition (Dey and others 1999, "Topology preserving edge contraction"): the two
    /// ends have the edge's two opposite corners as common neighbours, and no other. A tetrahedron
    /// satisfies it too and would collapse to nothing, which the degrees exclude.
    bool keeps_manifold(const std::vector<std::uint32_t>& ring, std::uint32_t u) const
    {
        int common = 0, degree = 0;
        for (const std::uint32_t t : around_.around(u)) {
            const std::uint32_t w = corner_after(triangles_[t], u);
            common += std::find(ring.begin(), ring.end(), w) != ring.end();
            ++degree;
        }
        return common == 2 && (degree > 3 || ring.size() > 3);
    }

    /// Whether v and all samples of the triangles around it are near enough to one of the triangles
    /// that the collapse would leave. Samples are those of the input, not of the surface in
    /// between, so errors of collapses do not add up.
    bool keeps_distance(std::uint32_t v, std::uint32_t u, Fan& fan) const
    {
        if (!bounds_distance())
            return true;
        fan.clear();
        for (const std::uint32_t t : around_.around(v)) {
            const Vec3I& c = triangles_[t];
            if (c[0] == u || c[1] == u || c[2] == u)
                continue;
            fan.emplace_back();
            for (int k = 0; k < 3; ++k)
                fan.back()[std::size_t(k)] = points_[c[k] == v ? u : c[k]];
        }
        const double most = limits_.distance * limits_.distance;
        const auto is_near = [&](std::uint32_t w) {
            return std::any_of(fan.begin(), fan.end(), [&](const std::array<Vec3d, 3>& triangle) {
                return squared_distance(triangle, samples_[w]) <= most;
            });
        };
        const auto around = around_.around(v);
        return is_near(v) && std::all_of(around.begin(), around.end(), [&](std::uint32_t t) {
                   return std::all_of(samples_of_[t].begin(), samples_of_[t].end(), is_near);
               });
    }

    const CollapseLimits& limits_;
    std::vector<Vec3d> points_;
    std::vector<Vec3I> triangles_;
    // Kept only where the distance is bounded: points of the input, and by triangle those that have
    // no vertex any more and are nearest to it.
    std::vector<Vec3d> samples_;
    std::vector<std::vector<std::uint32_t>> samples_of_;
    std::vector<Quadric> quadric_;
    std::vector<Collapse> best_;
    std::vector<std::uint8_t> touched_; ///< in this round, at its beginning in the one before
    VertexTriangles around_;
};

} // namespace

Coarsened collapse_edges(const TriangleMesh& mesh, const CollapseLimits& limits)
{
    Collapser collapser(mesh, limits);
    collapser.run();
    Coarsened out;
    std::vector<std::uint32_t> place(mesh.points.size(), 0);
    for (const Vec3I& t : collapser.triangles())
        for (int k = 0; k < 3; ++k)
            place[t[k]] = 1;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == 0)
            continue;
        place[v] = static_cast<std::uint32_t>(out.from.size());
        out.mesh.points.push_back(mesh.points[v]);
        out.from.push_back(static_cast<std::uint32_t>(v));
    }
    for (const Vec3I& t : collapser.triangles())
        out.mesh.triangles.emplace_back(place[t[0]], place[t[1]], place[t[2]]);
    return out;
}

} // namespace vdb_shell

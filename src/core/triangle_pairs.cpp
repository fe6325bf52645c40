// SPDX-License-Identifier: Apache-2.0

// Pairs of triangles that may have a common point. Boxes alone would give nearly all pairs where
// many triangles meet in a corner, or lie long and thin beside one another, although they do not
// touch. So those that meet in a crowded corner are compared as they are seen from there, on a
// sphere: two triangles with one corner in common that have another point in common are seen in one
// direction. Those that meet in a crowded edge are compared as they are seen along it, on a circle,
// for the same reason. Of all others, those in a crowd are halved until the pieces are apart or
// few (core/crowded_pairs.h). Boxes are widened by more than the rounding, so no pair is lost.

#include "core/triangle_pairs.h"

#include "core/bucket_sort.h"
#include "core/crowded_pairs.h"
#include "core/layered_pairs.h"
#include "core/parallel.h"
#include "core/polled_stop.h"
#include "core/triangle_piece.h"
#include "core/unit_vector.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using Pair = std::array<std::uint32_t, 2>;
using Marks = BoxTree::Marks;

constexpr Marks kNoMarks{BoxTree::kNoMark, BoxTree::kNoMark, BoxTree::kNoMark};
// Triangles around one corner, or one edge, above which they are compared as seen from there: many
// more than in the faces of a tet mesh, which have some forty.
constexpr std::size_t kCrowdedCorner = 128;
// Boxes near a group of sixteen above which its triangles are looked at one by one: a good surface
// has some fifty, the faces of a tet mesh some five hundred.
constexpr std::size_t kMostNearGroup = 1024;
// Groups that one thread takes at a time: they share the memory of one list of nearby boxes.
constexpr std::size_t kTriangleGroupsInPart = 16;

/// The directions in which a triangle is seen from one of its corners: the shorter arc between two
/// of length 1. Without them it is everywhere.
struct Arc {
    Vec3d from, to;
    double pad; ///< how far off the directions may be
    std::uint32_t item;
    Marks marks;

    FloatBox box() const
    {
        PaddedBox box;
        box.add(from);
        box.add(to);
        // As far as the arc is from its chord at most, which is in the middle.
        return box.padded(pad + std::max(0.0, 1 - 0.5 * (from + to).length()));
    }
    /// The corners of a triangle around it, for the tangents at its ends meet beyond its middle.
    FlatCorners corners() const
    {
        const Vec3d sum = from + to;
        if (sum.length() > 1e-3)
            return {from, to, sum * (2 / sum.lengthSqr()), from};
        // Around the whole sphere.
        return {Vec3d(2, 2, 2), Vec3d(2, -2, -2), Vec3d(-2, 2, -2), Vec3d(-2, -2, 2)};
    }
    bool surely_apart(const Arc&) const { return false; }
    /// An arc of nearly half a circle has no middle that is certain.
    bool divisible() const
    {
        return (to - from).length() > 1e3 * pad && (from + to).length() > 1e-3;
    }
    Arc halve()
    {
        Arc other = *this;
        to = other.from = (from + to).unit();
        return other;
    }
};
/// Everywhere where one of the directions is none.
Arc arc_between(const Vec3d& from, const Vec3d& to, double pad, std::uint32_t item,
                const Marks& marks)
{
    // The ends of the box around the sphere.
    const Vec3d end(2.0);
    const bool both = from.lengthSqr() > 0 && to.lengthSqr() > 0;
    return both ? Arc{from, to, pad, item, marks} : Arc{-end, end, 0, item, marks};
}
// Directions are rounded some times and middles of middles twenty times, by 2e-16 each.
constexpr double kDirectionPad = 1e-13;

/// How many triangles each point has, or an edge at a point by its other end.
class Crowds
{
public:
    explicit Crowds(std::size_t points) : triangles_(points) {}
    void add(std::uint32_t point) { ++triangles_[point]; }
    bool at(std::uint32_t point) const { return triangles_[point] > kCrowdedCorner; }
    bool any() const
    {
        return std::any_of(triangles_.begin(), triangles_.end(),
                           [](std::uint32_t n) { return n > kCrowdedCorner; });
    }

private:
    std::vector<std::uint32_t> triangles_;
};

class PairsOfTriangles
{
public:
    PairsOfTriangles(const std::vector<Vec3s>& points, const std::vector<Vec3I>& triangles,
                     const KeepPair& keep, const PairBounds& wanted, Interrupter* interrupter,
                     const std::vector<char>& left_out)
        : points_(points), triangles_(triangles), keep_(keep), wanted_(wanted), stop_(interrupter),
          crowds_(points.size())
    {
        asked_.reserve(triangles.size());
        for (std::uint32_t t = 0; t < triangles.size(); ++t)
            if (left_out.empty() || !left_out[t])
                asked_.push_back(t);
        for (const std::uint32_t t : asked_)
            for (int k = 0; k < 3; ++k)
                crowds_.add(triangles[t][k]);
        any_crowd_ = crowds_.any();
    }

    FoundPairs find()
    {
        look_at_groups();
        if (any_crowd_)
            look_from_crowded_corners();
        stop_.throw_if_wanted();
        // The smaller triangle of a pair is a number from 0 without gaps, as a bucket sort wants.
        // The other tells the pairs of a bucket apart, so their order is unique.
        std::vector<Pair> pairs = bucket_sort<Pair>(
            parts_, triangles_.size(), [](const Pair& pair) { return pair[0]; },
            [](const Pair& x, const Pair& y) { return x[1] < y[1]; });
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        return {std::move(pairs), all_.load()};
    }

private:
    Marks marks_of(std::uint32_t t) const
    {
        Marks marks = kNoMarks;
        for (int k = 0; k < 3 && any_crowd_; ++k)
            if (crowds_.at(triangles_[t][k]))
                marks[std::size_t(k)] = triangles_[t][k];
        return marks;
    }
    bool meet_in_a_crowd(std::uint32_t s, std::uint32_t t) const
    {
        return any_crowd_ && BoxTree::have_common(marks_of(s), marks_of(t));
    }
    FloatBox box_of(std::uint32_t t) const { return triangle_box(points_, triangles_[t]); }
    /// Pairs that share no crowded corner.
    void look_at_groups()
    {
        BoxTree tree;
        tree.build(asked_.size(), [&](std::size_t i) { return box_of(asked_[i]); });
        std::vector<char> crowded(asked_.size());
        const std::size_t groups = tree.groups();
        const std::size_t parts = (groups + kTriangleGroupsInPart - 1) / kTriangleGroupsInPart;
        parts_.resize(parts);
        for_each_index(
            parts,
            [&](std::size_t part) {
                BoxTree::Near near;
                const std::size_t end = std::min(groups, (part + 1) * kTriangleGroupsInPart);
                for (std::size_t group = part * kTriangleGroupsInPart;
                     group < end && !stop_.wanted(); ++group)
                    if (!look_at_group(tree, group, near, parts_[part]))
                        tree.for_each_of(group, [&](int i) { crowded[std::size_t(i)] = 1; });
            },
            1);
        look_at_crowded(std::move(tree), crowded);
    }

    bool look_at_group(const BoxTree& tree, std::size_t group, BoxTree::Near& near,
                       std::vector<Pair>& pairs) const
    {
        return tree.for_each_pair_of(
            group, near,
            [&](int i, int j) { keep_pair(asked_[std::size_t(i)], asked_[std::size_t(j)], pairs); },
            kMostNearGroup);
    }

    /// The pairs of triangles of groups that were not looked at: with the other triangles, of which
    /// they missed those behind them in the tree, and among themselves. Lets go of the tree of all.
    void look_at_crowded(BoxTree tree, const std::vector<char>& crowded)
    {
        if (std::find(crowded.begin(), crowded.end(), 1) == crowded.end())
            return;
        std::vector<std::uint32_t> places;
        std::vector<TrianglePiece> pieces;
        for (std::uint32_t i = 0; i < crowded.size(); ++i) {
            if (!crowded[i])
                continue;
            const std::uint32_t t = asked_[i];
            places.push_back(i);
            pieces.emplace_back(points_, triangles_[t], t, marks_of(t));
        }
        // Most meet few others of a crowd, as the spikes of a rough surface do.
        std::vector<std::vector<Pair>> found(places.size());
        std::vector<char> many(places.size());
        for_each_index(places.size(), [&](std::size_t p) {
            const std::uint32_t s = asked_[places[p]];
            std::size_t met = 0;
            tree.for_each_overlap_while(box_of(s), [&](int place) {
                if (crowded[std::size_t(place)])
                    return ++met <= kMostNearGroup;
                keep_pair(s, asked_[std::size_t(place)], found[p]);
                return !stop_.wanted();
            });
            many[p] = met > kMostNearGroup;
        });
        // Of tens of millions of boxes two trees at a time would take gigabytes.
        tree = {};
        if (std::find(many.begin(), many.end(), 1) != many.end())
            look_without_crowded(crowded, places, many, found);
        found.emplace_back();
        list(CrowdedPairs<TrianglePiece>(std::move(pieces), wanted_, stop_), found.back());
        take(found);
    }

    /// The same for triangles that meet many of a crowd, in a tree without these: of n that all
    /// meet there are n^2 pairs.
    void look_without_crowded(const std::vector<char>& crowded,
                              const std::vector<std::uint32_t>& places,
                              const std::vector<char>& many,
                              std::vector<std::vector<Pair>>& found) const
    {
        std::vector<std::uint32_t> others;
        for (std::size_t i = 0; i < crowded.size(); ++i)
            if (!crowded[i])
                others.push_back(asked_[i]);
        BoxTree tree;
        tree.build(others.size(), [&](std::size_t i) { return box_of(others[i]); });
        for_each_index(places.size(), [&](std::size_t p) {
            if (!many[p])
                return;
            const std::uint32_t s = asked_[places[p]];
            found[p].clear();
            tree.for_each_overlap_while(box_of(s), [&](int other) {
                keep_pair(s, others[std::size_t(other)], found[p]);
                return !stop_.wanted();
            });
        });
    }

    /// What `keep` rejects is dropped here, before it takes memory.
    void keep_pair(std::uint32_t s, std::uint32_t t, std::vector<Pair>& pairs) const
    {
        const auto [low, high] = std::minmax(s, t);
        if (!meet_in_a_crowd(low, high) && keep_(low, high))
            pairs.push_back({low, high});
    }

    void take(std::vector<std::vector<Pair>>& found)
    {
        for (std::vector<Pair>& pairs : found)
            if (!pairs.empty())
                parts_.push_back(std::move(pairs));
    }

    void look_from_crowded_corners()
    {
        // Corner, triangle.
        std::vector<Pair> uses;
        for (const std::uint32_t t : asked_)
            for (int k = 0; k < 3; ++k)
                if (crowds_.at(triangles_[t][k]))
                    uses.push_back({triangles_[t][k], t});
        std::sort(uses.begin(), uses.end());
        std::vector<std::size_t> begins;
        for (std::size_t i = 0; i < uses.size(); ++i)
            if (i == 0 || uses[i][0] != uses[i - 1][0])
                begins.push_back(i);
        begins.push_back(uses.size());
        std::vector<std::vector<Pair>> found(begins.size() - 1);
        for_each_index(
            found.size(),
            [&](std::size_t i) {
                look_from_corner(uses.data() + begins[i], uses.data() + begins[i + 1], found[i]);
            },
            1);
        take(found);
    }

    /// The pairs of triangles around one corner.
    void look_from_corner(const Pair* begin, const Pair* end, std::vector<Pair>& pairs) const
    {
        const std::uint32_t apex = (*begin)[0];
        // The other end of an edge, triangle.
        std::vector<Pair> edges;
        for (const Pair* use = begin; use != end; ++use)
            for (const std::uint32_t other : others_of(apex, (*use)[1]))
                edges.push_back({other, (*use)[1]});
        std::sort(edges.begin(), edges.end());
        std::vector<std::uint32_t> crowded;
        for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
            while (next < edges.size() && edges[next][0] == edges[i][0])
                ++next;
            if (next - i <= kCrowdedCorner)
                continue;
            crowded.push_back(edges[i][0]);
            look_along_edge(apex, &edges[i], edges.data() + next, pairs);
        }
        std::vector<Arc> arcs;
        for (const Pair* use = begin; use != end && !stop_.wanted(); ++use) {
            const std::array<std::uint32_t, 2> others = others_of(apex, (*use)[1]);
            Marks marks = kNoMarks;
            for (std::size_t k = 0; k < 2; ++k)
                if (std::binary_search(crowded.begin(), crowded.end(), others[k]))
                    marks[k] = others[k];
            arcs.push_back(arc_between(seen(apex, others[0]), seen(apex, others[1]), kDirectionPad,
                                       (*use)[1], marks));
        }
        list(CrowdedPairs<Arc>(std::move(arcs), wanted_, stop_), pairs);
    }

    /// The pairs of triangles around one edge, of which each has one direction there.
    void look_along_edge(std::uint32_t apex, const Pair* begin, const Pair* end,
                         std::vector<Pair>& pairs) const
    {
        const Vec3d along = seen(apex, (*begin)[0]);
        std::vector<Arc> arcs;
        for (const Pair* use = begin; use != end; ++use) {
            const std::array<std::uint32_t, 2> others = others_of(apex, (*use)[1]);
            const std::uint32_t tip = others[0] == (*begin)[0] ? others[1] : others[0];
            const Vec3d spoke = seen(apex, tip), across = spoke - along * along.dot(spoke);
            // What is left of a spoke that runs nearly along the edge is mostly rounding.
            const double length = across.length();
            const bool certain = along.lengthSqr() > 0 && length > 1e-9;
            const Vec3d direction = certain ? across / length : Vec3d(0.0);
            arcs.push_back(
                arc_between(direction, direction, kDirectionPad / length, (*use)[1], kNoMarks));
        }
        list(CrowdedPairs<Arc>(std::move(arcs), wanted_, stop_), pairs);
    }

    /// Appends the pairs of a crowd.
    template <class Piece> void list(CrowdedPairs<Piece>&& crowd, std::vector<Pair>& pairs) const
    {
        std::vector<Pair> found;
        if (!crowd.list(keep_, found))
            all_ = false;
        pairs.insert(pairs.end(), found.begin(), found.end());
    }

    /// The corners but for one use of the apex.
    std::array<std::uint32_t, 2> others_of(std::uint32_t apex, std::uint32_t t) const
    {
        const Vec3I& c = triangles_[t];
        const int k = c[0] == apex ? 0 : c[1] == apex ? 1 : 2;
        return {c[(k + 1) % 3], c[(k + 2) % 3]};
    }
    /// The direction, of length 1; 0 where there is none.
    Vec3d seen(std::uint32_t from, std::uint32_t point) const
    {
        return unit_vector(Vec3d(points_[point]) - Vec3d(points_[from]));
    }

    const std::vector<Vec3s>& points_;
    const std::vector<Vec3I>& triangles_;
    const KeepPair& keep_;
    const PairBounds& wanted_;
    PolledStop stop_;
    mutable std::atomic<bool> all_{true};
    std::vector<std::uint32_t> asked_; ///< triangles that may be in pairs, ascending
    Crowds crowds_;
    bool any_crowd_ = false;
    std::vector<std::vector<Pair>> parts_;
};

} // namespace

std::vector<std::array<std::uint32_t, 2>> overlapping_triangles(const std::vector<Vec3s>& points,
                                                                const std::vector<Vec3I>& triangles,
                                                                const KeepPair& keep,
                                                                Interrupter* interrupter,
                                                                const std::vector<char>& left_out)
{
    return overlapping_triangles(points, triangles, keep, PairBounds{}, interrupter, left_out)
        .pairs;
}

FoundPairs overlapping_triangles(const std::vector<Vec3s>& points,
                                 const std::vector<Vec3I>& triangles, const KeepPair& keep,
                                 const PairBounds& wanted, Interrupter* interrupter,
                                 const std::vector<char>& left_out)
{
    return PairsOfTriangles(points, triangles, keep, wanted, interrupter, left_out).find();
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes a rim that is too long for the optimal triangulation, whose time grows with the cube of its
// length, and closes it without new points by ear cutting: the corner with the smallest angle whose
// triangle holds no other corner is cut off, again and again. A simple polygon in a plane always
// has such a corner (Meisters 1975, "Polygons have ears"); here the rim is seen along its mean
// normal, and a folded rim need not be simple from there. A corner whose triangle holds another one
// waits for that one and is not looked at before it is gone, and what a triangle holds is sought in
// a tree, so that a rim need not be walked for each cut. All tests are in doubles and prove
// nothing: the caller rounds the fill to float32, tests it exactly against the surface and discards
// it if it crosses.

#include "core/box_tree.h"
#include "core/layered_pairs.h"
#include "core/unit_vector.h"
#include "repair/fill_patch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;

/// Corners as they are seen along a normal, in a tree: those that were put in and not taken out.
class SeenCorners
{
public:
    SeenCorners(const std::vector<Vec3d>& points, const Vec3d& normal)
        : points_(points), in_(points.size(), 1)
    {
        x_ = unit_vector(at_right_angles_to(normal));
        y_ = normal.cross(x_);
        double farthest = 0;
        for (const Vec3d& p : points)
            farthest = std::max(farthest, (p - points[0]).length());
        // Above what the products of the tests round off; a box too large costs a test.
        pad_ = 1e-9 * farthest;
        std::vector<FloatBox> boxes;
        boxes.reserve(points.size());
        for (const Vec3d& p : points)
            boxes.push_back(box_around({p}));
        tree_.build(boxes);
        tree_.index_parents();
    }

    void put(std::uint32_t corner, bool in)
    {
        if (std::exchange(in_[corner], char(in)) == char(in))
            return;
        const float far = std::numeric_limits<float>::infinity();
        const FloatBox none{FourFloats{far, far, far, 0}, FourFloats{-far, -far, -far, 0}};
        tree_.replace(corner, in ? box_around({points_[corner]}) : none);
    }

    /// Calls visit(corner) for those near a triangle until it returns false.
    template <class Visit>
    void for_each_near(std::initializer_list<Vec3d> triangle, const Visit& visit) const
    {
        tree_.for_each_overlap_while(box_around(triangle),
                                     [&](int i) { return visit(static_cast<std::uint32_t>(i)); });
    }

private:
    FloatBox box_around(std::initializer_list<Vec3d> corners) const
    {
        const double far = std::numeric_limits<double>::infinity();
        double low_x = far, low_y = far, high_x = -far, high_y = -far;
        for (const Vec3d& p : corners) {
            const Vec3d from_first = p - points_[0];
            const double x = x_.dot(from_first), y = y_.dot(from_first);
            low_x = std::min(low_x, x - pad_), high_x = std::max(high_x, x + pad_);
            low_y = std::min(low_y, y - pad_), high_y = std::max(high_y, y + pad_);
        }
        return {FourFloats{float_below(low_x), float_below(low_y), 0, 0},
                FourFloats{-float_below(-high_x), -float_below(-high_y), 0, 0}};
    }

    const std::vector<Vec3d>& points_;
    Vec3d x_, y_;
    double pad_ = 0;
    std::vector<char> in_;
    BoxTree tree_;
};

Vec3d mean_normal(const std::vector<Vec3d>& points)
{
    // The sum of these products is twice the area vector of the rim, whatever point they are taken
    // from. A point of the rim is taken so that nothing cancels far from the origin.
    Vec3d normal(0.0);
    for (std::size_t i = 0; i < points.size(); ++i)
        normal += (points[i] - points[0]).cross(points[(i + 1) % points.size()] - points[0]);
    return unit_vector(normal);
}

/// The rim as far as it is left, as a ring.
class Ring
{
public:
    explicit Ring(const Rim& rim)
        : rim_(rim), normal_(mean_normal(rim.points)), reflex_(rim.points, normal_),
          corner_(rim.points.size()), waiting_(rim.points.size())
    {
        const auto n = static_cast<std::uint32_t>(rim.points.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            corner_[i].next = (i + 1) % n;
            corner_[i].before = (i + n - 1) % n;
        }
        for (std::uint32_t i = 0; i < n; ++i)
            enter(i);
    }

    bool cut_all(std::vector<openvdb::Vec3I>& triangles)
    {
        std::uint32_t left_over = 0; // a corner that is left
        for (std::size_t left = rim_.points.size(); left > 3; --left) {
            std::uint32_t i = 0;
            if (!find_ear(i))
                return false;
            const std::uint32_t a = corner_[i].before, b = corner_[i].next;
            triangles.emplace_back(a, i, b);
            // Of all corners only the two beside the ear get another angle.
            for (const std::uint32_t gone : {i, a, b})
                leave(gone);
            put_reflex(i, false);
            corner_[a].next = b;
            corner_[b].before = a;
            enter(a);
            enter(b);
            left_over = a;
        }
        // The last three corners need no test: their edges are rim edges, or were tested when an
        // ear made them. The sharpest comes in the middle.
        const std::uint32_t one = corner_[left_over].before, two = corner_[left_over].next;
        const std::uint32_t last = std::min({key_of(one), key_of(left_over), key_of(two)}).second;
        triangles.emplace_back(corner_[last].before, last, corner_[last].next);
        return true;
    }

private:
    // Angle and corner: corners of equal angle follow each other by index, so the order is always
    // the same.
    using Ear = std::pair<double, std::uint32_t>;
    struct Corner {
        std::uint32_t next, before;
        std::uint32_t entered = 0; ///< how often: what waits for an earlier triangle waits no more
        double angle = 0;
    };

    Ear key_of(std::uint32_t i) const { return {corner_[i].angle, i}; }

    /// An edge that the surface has already between the two corners would get a third triangle by
    /// the cut.
    bool is_new_edge(std::uint32_t i) const
    {
        return rim_.edges.count(std::minmax(corner_[i].before, corner_[i].next)) == 0;
    }

    /// The sharpest corner whose triangle is empty. Of a polygon in a plane there always is one; of
    /// a folded rim, seen along one normal, there may be none, and then any corner has to do.
    bool find_ear(std::uint32_t& ear)
    {
        while (!open_.empty()) {
            ear = open_.begin()->second;
            const std::uint32_t within = corner_within(ear);
            if (within == kNone)
                return true;
            open_.erase(open_.begin());
            waiting_[within].emplace_back(ear, corner_[ear].entered);
        }
        if (ears_.empty())
            return false;
        ear = ears_.begin()->second;
        return true;
    }

    /// Another corner that lies in the triangle, seen along the normal. Only reflex corners are
    /// looked at: where a polygon enters the triangle of a convex corner, one of its corners in
    /// there is reflex.
    std::uint32_t corner_within(std::uint32_t i) const
    {
        const std::uint32_t a = corner_[i].before, b = corner_[i].next;
        const auto left_of = [&](std::uint32_t from, std::uint32_t to, const Vec3d& p) {
            return normal_.dot(
                       (rim_.points[to] - rim_.points[from]).cross(p - rim_.points[from])) >= 0;
        };
        std::uint32_t within = kNone;
        reflex_.for_each_near({rim_.points[a], rim_.points[i], rim_.points[b]},
                              [&](std::uint32_t v) {
                                  const Vec3d& p = rim_.points[v];
                                  if (v != a && v != b && v != i && left_of(a, i, p) &&
                                      left_of(i, b, p) && left_of(b, a, p))
                                      within = v;
                                  return within == kNone;
                              });
        return within;
    }

    void leave(std::uint32_t i)
    {
        ears_.erase(key_of(i));
        open_.erase(key_of(i));
        ++corner_[i].entered;
    }

    /// Computes the angle inside, from 0 to a whole turn; it is under a half turn where the rim
    /// turns left as seen against the normal. A corner that is straight or folded back on itself
    /// counts as a half turn, since its triangle has no area.
    void enter(std::uint32_t i)
    {
        Corner& corner = corner_[i];
        const Vec3d ahead = rim_.points[corner.next] - rim_.points[i];
        const Vec3d back = rim_.points[corner.before] - rim_.points[i];
        const Vec3d cross = ahead.cross(back);
        double angle = std::atan2(normal_.dot(cross), ahead.dot(back));
        if (angle < 0)
            angle += 2 * M_PI;
        corner.angle = cross.lengthSqr() > 0 ? angle : M_PI;
        if (is_new_edge(i)) {
            ears_.insert(key_of(i));
            if (corner.angle < M_PI)
                open_.insert(key_of(i));
        }
        put_reflex(i, corner.angle >= M_PI);
    }

    /// Corners that waited for this one are looked at again where it no longer stands in the way.
    void put_reflex(std::uint32_t i, bool reflex)
    {
        reflex_.put(i, reflex);
        if (reflex)
            return;
        for (const auto& [ear, entered] : std::exchange(waiting_[i], {}))
            if (corner_[ear].entered == entered)
                open_.insert(key_of(ear));
    }

    static constexpr std::uint32_t kNone = UINT32_MAX;

    const Rim& rim_;
    Vec3d normal_;
    SeenCorners reflex_;
    std::vector<Corner> corner_;
    std::set<Ear> ears_; ///< corners that may be cut off
    std::set<Ear> open_; ///< of these the sharp ones of which nothing is known that is within
    /// By corner: those within whose triangle it is, and how often they had been entered.
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> waiting_;
};

} // namespace

Patch cut_rim_ears(const Rim& rim)
{
    Patch patch{rim.points, {}};
    if (!Ring(rim).cut_all(patch.triangles))
        patch.triangles.clear();
    return patch;
}

} // namespace vdb_shell::repair

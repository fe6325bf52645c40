// SPDX-License-Identifier: Apache-2.0

// Takes a rim that is too long for the optimal triangulation, whose time grows with the cube of its
// length, and closes it without new points by ear cutting: the corner with the smallest angle whose
// triangle holds no other corner is cut off, again and again. A simple polygon in a plane always
// has such a corner (Meisters 1975, "Polygons have ears"); here the rim is seen along its mean
// normal, and a folded rim need not be simple from there. All tests are in doubles and prove
// nothing: the caller rounds the fill to float32, tests it exactly against the surface and discards
// it if it crosses.

#include "core/unit_vector.h"
#include "repair/fill_patch.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;

/// The rim as far as it is left, as a ring.
class Ring
{
public:
    explicit Ring(const Rim& rim) : rim_(rim)
    {
        const auto n = static_cast<std::uint32_t>(rim.points.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next_.push_back((i + 1) % n);
            before_.push_back((i + n - 1) % n);
            angle_.push_back(0);
            // The sum of these products is twice the area vector of the rim, whatever point they
            // are taken from. A point of the rim is taken so that nothing cancels far from the
            // origin.
            normal_ +=
                (rim.points[i] - rim.points[0]).cross(rim.points[(i + 1) % n] - rim.points[0]);
        }
        normal_ = unit_vector(normal_);
        for (std::uint32_t i = 0; i < n; ++i)
            enter(i);
    }

    bool cut_all(std::vector<openvdb::Vec3I>& triangles)
    {
        for (std::size_t left = rim_.points.size(); left > 3; --left) {
            const auto ear = find_ear();
            if (ear == ears_.end())
                return false;
            const std::uint32_t i = ear->second, a = before_[i], b = next_[i];
            triangles.emplace_back(a, i, b);
            // Of all corners only the two beside the ear get another angle. They have to leave the
            // set under the old angle, which is a part of the key.
            ears_.erase(ear);
            reflex_.erase(i);
            ears_.erase({angle_[a], a});
            ears_.erase({angle_[b], b});
            next_[a] = b;
            before_[b] = a;
            enter(a);
            enter(b);
        }
        // The last three corners need no test: their edges are rim edges, or were tested when an
        // ear made them.
        const std::uint32_t last = ears_.begin()->second;
        triangles.emplace_back(before_[last], last, next_[last]);
        return true;
    }

private:
    // Angle and corner: corners of equal angle follow each other by index, so the order is always
    // the same.
    using Ear = std::pair<double, std::uint32_t>;

    /// An edge that the surface has already between the two corners would get a third triangle by
    /// the cut.
    bool is_new_edge(const Ear& e) const
    {
        return rim_.edges.count(std::minmax(before_[e.second], next_[e.second])) == 0;
    }

    /// The sharpest corner whose triangle is empty. Of a polygon in a plane there always is one; of
    /// a folded rim, seen along one normal, there may be none, and then any corner has to do.
    std::set<Ear>::iterator find_ear() const
    {
        const auto empty = std::find_if(ears_.begin(), ears_.end(), [&](const Ear& e) {
            return e.first < M_PI && is_new_edge(e) && is_empty(e.second);
        });
        if (empty != ears_.end())
            return empty;
        return std::find_if(ears_.begin(), ears_.end(),
                            [&](const Ear& e) { return is_new_edge(e); });
    }

    /// Whether no other corner lies in the triangle, seen along the normal. Only reflex corners are
    /// looked at: where a polygon enters the triangle of a convex corner, one of its corners in
    /// there is reflex.
    bool is_empty(std::uint32_t i) const
    {
        const std::uint32_t a = before_[i], b = next_[i];
        const auto left_of = [&](std::uint32_t from, std::uint32_t to, const Vec3d& p) {
            return normal_.dot(
                       (rim_.points[to] - rim_.points[from]).cross(p - rim_.points[from])) >= 0;
        };
        return std::none_of(reflex_.begin(), reflex_.end(), [&](std::uint32_t v) {
            const Vec3d& p = rim_.points[v];
            return v != a && v != b && v != i && left_of(a, i, p) && left_of(i, b, p) &&
                   left_of(b, a, p);
        });
    }

    /// Computes the angle inside, from 0 to a whole turn; it is under a half turn where the rim
    /// turns left as seen against the normal. A corner that is straight or folded back on itself
    /// counts as a half turn, since its triangle has no area.
    void enter(std::uint32_t i)
    {
        const Vec3d ahead = rim_.points[next_[i]] - rim_.points[i];
        const Vec3d back = rim_.points[before_[i]] - rim_.points[i];
        const Vec3d cross = ahead.cross(back);
        double angle = std::atan2(normal_.dot(cross), ahead.dot(back));
        if (angle < 0)
            angle += 2 * M_PI;
        angle_[i] = cross.lengthSqr() > 0 ? angle : M_PI;
        ears_.insert({angle_[i], i});
        if (angle_[i] < M_PI)
            reflex_.erase(i);
        else
            reflex_.insert(i);
    }

    const Rim& rim_;
    Vec3d normal_{0.0};
    std::vector<std::uint32_t> next_, before_;
    std::vector<double> angle_;
    std::set<Ear> ears_;
    std::set<std::uint32_t> reflex_;
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

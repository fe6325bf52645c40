// SPDX-License-Identifier: Apache-2.0

// Takes: a group of inner points and the state. Leaves: the group farther in, where the exact tests
// allow a step. The step is a guess: to first order in it the volumes of the tets are affine, so
// the barrier of one vertex serves for the group; what the step would meet gets a plane before it,
// and the step is sought again. Contacts are looked for among what the tree has near the group, and
// among what this cell has moved since the tree was told: the tree is shared, so it stays as it is
// while several cells move.

#include "growth/cell_moves.h"

#include "core/six_volumes.h"
#include "core/sort_unique.h"
#include "growth/move_tests.h"
#include "growth/separation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell::growth
{
GroupField::GroupField(GrowState& state, double least)
    : s(state),
      barrier_weight(s.schedule.groups.barrier_weight * std::abs(volume6(s.a, s.mesh->faces)) /
                     (3.0 * std::max(1, s.mesh->face_count()))),
      least_gain6(least), weight(s.b.size(), 0.0), changed(s.b.size(), 1),
      marked(s.mesh->faces.size(), 0), moved_at(s.mesh->faces.size(), -1)
{
}

GroupOutcome CellMoves::move(const Group& group, std::uint32_t then, std::uint32_t now)
{
    list_faces(group);
    if (!changed_since(then))
        return GroupOutcome::stayed;
    gradient_ = Vec3d(0.0);
    for (const GroupShare& share : group)
        if (!s_.pinned[share.vertex])
            gradient_ += share.weight * inner_volume6_gradient(s_, share.vertex);
    // Six times the area that the group moves, were all of it as flat as can be.
    const double area6 = gradient_.length();
    ball_.radius = s_.schedule.groups.radius * std::sqrt(area6 / 6);
    if (!(area6 * ball_.radius > field_.least_gain6))
        return GroupOutcome::stayed;
    for (const GroupShare& share : group)
        field_.weight[share.vertex] = s_.pinned[share.vertex] ? 0 : share.weight;
    list_bounds();
    step_ = best_step();
    const GroupOutcome outcome = make_step(group, now);
    for (const GroupShare& share : group)
        field_.weight[share.vertex] = 0;
    return outcome;
}

void CellMoves::update_tree()
{
    for (const int f : moved_) {
        s_.inner_tree.replace(std::size_t(f), float_box_of(inner_corners(s_, f)));
        field_.moved_at[f] = -1;
    }
    moved_.clear();
    moved_box_.clear();
}

void CellMoves::list_faces(const Group& group)
{
    faces_.clear();
    // A witness that moves with the group is not where the tree has it.
    search_ = WitnessSearch::trees;
    for (const GroupShare& share : group) {
        if (is_witness(s_, share.vertex))
            search_ = WitnessSearch::one_by_one;
        for (const FaceCorner& at : star(*s_.mesh, share.vertex))
            faces_.push_back(at.face);
    }
    sort_unique(faces_);
}

bool CellMoves::changed_since(std::uint32_t then) const
{
    const std::vector<std::uint32_t>& changed = field_.changed;
    return std::any_of(faces_.begin(), faces_.end(), [&](int f) {
        return changed[s_.mesh->corner(f, 0)] > then || changed[s_.mesh->corner(f, 1)] > then ||
               changed[s_.mesh->corner(f, 2)] > then;
    });
}

/// How far the volumes of the tets let the group go, to first order in its step.
void CellMoves::list_bounds()
{
    // A tet that loses less than this share of its volume on the way is no bound.
    constexpr double kLeastLoss = 1e-3;
    bounds_.clear(Vec3d(0.0), ball_.radius);
    for (const int f : faces_)
        for (const OrientedTet& tet : tested_tets(s_, f)) {
            if (dropped(s_, f, tet.pillar))
                continue;
            TetCorners p;
            for (std::size_t k = 0; k < 4; ++k)
                p[k] = corner_of(s_, f, tet.corner[k]);
            Vec3d slope(0.0);
            for (std::size_t k = 0; k < 4; ++k)
                if (tet.corner[k] >= 3)
                    if (const double w = weight_of(f, tet.corner[k] - 3U); w > 0)
                        slope += w * volume6_gradient(p, k);
            const double volume = six_volumes(p);
            const double steepness = slope.length();
            if (steepness * ball_.radius > kLeastLoss * volume && steepness > 0)
                bounds_.add_unit(Vec3s(slope / steepness), volume / steepness);
        }
}

/// Makes the step, or a shorter one.
GroupOutcome CellMoves::make_step(const Group& group, std::uint32_t now)
{
    const GroupSchedule& schedule = s_.schedule.groups;
    before_.clear();
    for (const GroupShare& share : group)
        before_.push_back(s_.b[share.vertex]);
    double share = 1;
    for (int cut = 0, halving = 0;
         halving < schedule.halvings && gain6(share) > field_.least_gain6;) {
        place(group, share * step_);
        const Box reached = box_of_faces();
        const bool within = domain_.contains(reached.lo) && domain_.contains(reached.hi);
        if (within && allowed(reached)) {
            keep(group, now);
            return GroupOutcome::moved;
        }
        for (std::size_t i = 0; i < before_.size(); ++i)
            s_.b[group.first[i].vertex] = before_[i];
        if (!within)
            return GroupOutcome::left_domain;
        if (cut++ < schedule.cuts && add_planes()) {
            step_ = best_step();
        } else {
            ++halving;
            share *= 0.5;
        }
    }
    return GroupOutcome::stayed;
}

void CellMoves::place(const Group& group, const Vec3d& by)
{
    for (const GroupShare& share : group)
        if (!s_.pinned[share.vertex])
            s_.b[share.vertex] =
                capped(s_, share.vertex, s_.b[share.vertex] + field_.weight[share.vertex] * by);
}

Box CellMoves::box_of_faces() const
{
    Box box;
    for (const int f : faces_)
        box.add(box_of(inner_corners(s_, f)));
    return box;
}

void CellMoves::keep(const Group& group, std::uint32_t now)
{
    ++made_;
    for (const GroupShare& share : group)
        field_.changed[share.vertex] = now;
    for (const int f : faces_) {
        const FloatBox box = float_box_of(inner_corners(s_, f));
        int& at = field_.moved_at[f];
        if (at < 0) {
            at = static_cast<int>(moved_.size());
            moved_.push_back(f);
            moved_box_.push_back(box);
        } else {
            moved_box_[std::size_t(at)] = box;
        }
    }
}

/// What comes in the way is left in hits_.
bool CellMoves::allowed(const Box& reached)
{
    hits_.clear();
    for (const int f : faces_)
        if (!prism_valid(s_, f) || holds_component(s_, f, search_))
            return false;
    for (const int f : faces_)
        field_.marked[f] = 1;
    list_near(float_box(reached));
    for (const int f : faces_)
        field_.marked[f] = 0;
    list_hits();
    return hits_.empty() && clear_among();
}

/// All other triangles near the group, once for all of its own.
void CellMoves::list_near(const FloatBox& reached)
{
    near_inner_.clear();
    s_.inner_tree.for_each_overlap(reached, [&](int g) {
        if (!field_.marked[g] && field_.moved_at[g] < 0)
            near_inner_.add(float_box_of(inner_corners(s_, g)), g);
    });
    for (std::size_t i = 0; i < moved_.size(); ++i)
        if (!field_.marked[moved_[i]] && moved_box_[i].overlaps(reached))
            near_inner_.add(moved_box_[i], moved_[i]);
    s_.outer_tree.list_overlaps(reached, near_outer_);
}

/// The first triangles that those of the group meet.
void CellMoves::list_hits()
{
    // For as many planes; the next try shows the others. With four times as many the first planes
    // bind the step more than those that it will really meet: an eighth more time, and .0001 to
    // .0005 less fill on most scans (docs/measurements/scans.md).
    constexpr std::size_t kEnough = 6;
    for (const int f : faces_) {
        const InnerTriangle triangle(s_, f);
        const FloatBox box = float_box_of(triangle.corners());
        const bool enough = near_inner_.any_overlap(box, [&](int g) {
            if (triangle.meets_inner(g))
                hits_.push_back({f, g, false});
            return hits_.size() == kEnough;
        }) || near_outer_.any_overlap(box, [&](int g) {
            if (triangle.meets_outer(g))
                hits_.push_back({f, g, true});
            return hits_.size() == kEnough;
        });
        if (enough)
            return;
    }
}

bool CellMoves::clear_among()
{
    among_.clear();
    for (const int f : faces_)
        among_.add(float_box_of(inner_corners(s_, f)), f);
    return std::none_of(faces_.begin(), faces_.end(), [&](int f) {
        const InnerTriangle triangle(s_, f);
        return among_.any_overlap(float_box_of(triangle.corners()),
                                  [&](int g) { return g > f && triangle.meets_inner(g); });
    });
}

/// Puts a plane before each triangle that was met, as it lies to the group before its step.
/// False if there is none to put: what has a corner in common has no plane between.
bool CellMoves::add_planes()
{
    bool any = false;
    for (const Hit& hit : hits_) {
        if (!hit.outer && s_.mesh->share_a_corner(hit.face, hit.other))
            continue;
        const Corners mine = inner_corners(s_, hit.face);
        const Corners other =
            hit.outer ? outer_corners(s_, hit.other) : inner_corners(s_, hit.other);
        const SlabQuery query{&mine, &other, std::numeric_limits<double>::infinity()};
        Slab slab;
        slabs_between(&query, 1, &slab);
        if (!(slab.gap > 0))
            continue;
        for (std::size_t k = 0; k < 3; ++k)
            if (const double w = weight_of(hit.face, k); w > 0) {
                bounds_.add_unit(slab.n, (Vec3d(slab.n).dot(mine[k] - mine[0]) - slab.hi) / w);
                any = true;
            }
    }
    return any;
}

} // namespace vdb_shell::growth

// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell, and a coarser surface whose vertices say which vertices move together.
// Leaves: a valid shell that is thicker. Prolongation and mending leave voids as wide as many
// triangles, where a detail of the surface held its own pillars back and nobody else came. All
// threads look for the steps of a block of groups; one thread tests and makes them in order, and
// looks again where an earlier one has changed what a step was found for.

#include "growth/move_groups.h"

#include "core/parallel.h"
#include "core/propose_in_blocks.h"
#include "core/six_volumes.h"
#include "growth/barrier.h"
#include "growth/move_tests.h"
#include "growth/ray_hit.h"
#include "growth/separation.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

struct Group {
    const GroupShare *first, *last;
    const GroupShare* begin() const { return first; }
    const GroupShare* end() const { return last; }
};

/// The step that a group is to make, and what was looked at to find it.
struct Proposal {
    std::vector<int> faces; ///< those whose prisms change
    Vec3d gradient{0.0};    ///< of the inner surface's volume6
    Ball ball{Vec3d(0.0), 0.0};
    LinearBounds bounds;
    Vec3d step{0.0};
};

bool has_common_corner(const GrowState& s, int f, int g)
{
    for (int k = 0; k < 3; ++k)
        if (s.mesh->incident_to(g, s.mesh->corner(f, k)))
            return true;
    return false;
}

class GroupMoves
{
public:
    explicit GroupMoves(GrowState& s)
        : s_(s), weight_([&s] { return std::vector<double>(s.b.size(), 0.0); }),
          changed_(s.b.size(), 1), marked_(s.mesh->faces.size(), 0)
    {
        const double solid6 = std::abs(volume6(s.a, s.mesh->faces));
        barrier_weight_ =
            s.schedule.groups.barrier_weight * solid6 / (3.0 * std::max(1, s.mesh->face_count()));
    }

    std::uint32_t now() const { return now_; }

    /// Finds the void before each vertex: what most groups lack.
    void look_ahead()
    {
        rebuild_tree();
        void6_.resize(s_.b.size());
        for_each_index(void6_.size(), [&](std::size_t i) {
            const int v = static_cast<int>(i);
            const Vec3d gradient = inner_volume6_gradient(s_, v);
            const double area6 = gradient.length();
            void6_[i] = s_.pinned[v] || !(area6 > 0) ? 0 : area6 * room(v, gradient / -area6);
        });
    }
    /// Whether there is void enough before the group.
    bool has_room(const Group& group, double least_void6) const
    {
        double sum = 0;
        for (const GroupShare& share : group)
            sum += share.weight * void6_[share.vertex];
        return sum > least_void6;
    }

    void rebuild_tree()
    {
        std::vector<FloatBox> boxes(s_.mesh->faces.size());
        for_each_index(boxes.size(), [&](std::size_t f) {
            boxes[f] = float_box_of(inner_corners(s_, static_cast<int>(f)));
        });
        s_.inner_tree.build(std::move(boxes));
        s_.inner_tree.index_parents();
    }

    /// Changes nothing. False: nothing near the group has changed since `then`, or it has nothing
    /// to win.
    bool propose(const Group& group, std::uint32_t then, double least_gain6, Proposal& out)
    {
        list_faces(group, out.faces);
        if (!changed_since(out.faces, then))
            return false;
        out.gradient = Vec3d(0.0);
        for (const GroupShare& share : group)
            if (!s_.pinned[share.vertex])
                out.gradient += share.weight * inner_volume6_gradient(s_, share.vertex);
        // Six times the area that the group moves, were all of it as flat as can be.
        const double area6 = out.gradient.length();
        out.ball.radius = s_.schedule.groups.radius * std::sqrt(area6 / 6);
        if (!(area6 * out.ball.radius > least_gain6))
            return false;
        std::vector<double>& weight = weight_.local();
        set_weights(group, weight);
        list_bounds(weight, out);
        clear_weights(group, weight);
        out.step = best_step(out);
        return gain6(out, 1) > least_gain6;
    }

    /// Makes the step, or a shorter one. `then`: when it was proposed.
    bool make(const Group& group, std::uint32_t then, double least_gain6, Proposal& proposal)
    {
        if (changed_since(proposal.faces, then) && !propose(group, 0, least_gain6, proposal))
            return false;
        std::vector<double>& weight = weight_.local();
        set_weights(group, weight);
        for (const int f : proposal.faces)
            marked_[f] = 1;
        const bool made = step_allowed(group, weight, least_gain6, proposal);
        for (const int f : proposal.faces)
            marked_[f] = 0;
        clear_weights(group, weight);
        return made;
    }

private:
    /// The way from b_v to the next inner triangle.
    double room(int v, const Vec3d& along) const
    {
        double nearest = s_.diagonal;
        s_.inner_tree.for_each_on_ray(s_.b[v], along, nearest, [&](int f) {
            if (!s_.mesh->incident_to(f, v))
                nearest = std::min(nearest, ray_hit(s_.b[v], along, inner_corners(s_, f)));
        });
        // A ray that meets nothing has left through a triangle of the vertex's own.
        return nearest < s_.diagonal ? nearest : 0;
    }
    void list_faces(const Group& group, std::vector<int>& faces) const
    {
        faces.clear();
        for (const GroupShare& share : group)
            for (const FaceCorner& at : star(*s_.mesh, share.vertex))
                faces.push_back(at.face);
        std::sort(faces.begin(), faces.end());
        faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    }
    bool changed_since(const std::vector<int>& faces, std::uint32_t then) const
    {
        return std::any_of(faces.begin(), faces.end(), [&](int f) {
            return changed_[s_.mesh->corner(f, 0)] > then ||
                   changed_[s_.mesh->corner(f, 1)] > then || changed_[s_.mesh->corner(f, 2)] > then;
        });
    }
    void set_weights(const Group& group, std::vector<double>& weight) const
    {
        for (const GroupShare& share : group)
            weight[share.vertex] = s_.pinned[share.vertex] ? 0 : share.weight;
    }
    static void clear_weights(const Group& group, std::vector<double>& weight)
    {
        for (const GroupShare& share : group)
            weight[share.vertex] = 0;
    }
    static double gain6(const Proposal& p, double share) { return -share * p.gradient.dot(p.step); }
    Vec3d best_step(Proposal& p) const
    {
        return barrier_minimum(p.bounds, p.ball, p.gradient, barrier_weight_);
    }

    /// How far the volumes of the tets let the group go, to first order in its step.
    void list_bounds(const std::vector<double>& weight, Proposal& out) const
    {
        // A tet that loses less than this share of its volume on the way is no bound.
        constexpr double kLeastLoss = 1e-3;
        out.bounds.clear(Vec3d(0.0), out.ball.radius);
        for (const int f : out.faces)
            for (const OrientedTet& tet : tables().twelve) {
                if (dropped(s_, f, tet.pillar))
                    continue;
                TetCorners p;
                for (std::size_t k = 0; k < 4; ++k)
                    p[k] = corner_of(s_, f, tet.corner[k]);
                Vec3d slope(0.0);
                for (std::size_t k = 0; k < 4; ++k)
                    if (tet.corner[k] >= 3)
                        if (const double w = weight[s_.mesh->corner(f, tet.corner[k] - 3)]; w > 0)
                            slope += w * volume6_gradient(p, k);
                const double volume = six_volumes(p);
                const double steepness = slope.length();
                if (steepness * out.ball.radius > kLeastLoss * volume && steepness > 0)
                    out.bounds.add_unit(Vec3s(slope / steepness), volume / steepness);
            }
    }

    bool step_allowed(const Group& group, const std::vector<double>& weight, double least_gain6,
                      Proposal& p)
    {
        const GroupSchedule& schedule = s_.schedule.groups;
        std::vector<Vec3d> before;
        for (const GroupShare& share : group)
            before.push_back(s_.b[share.vertex]);
        double share = 1;
        for (int cut = 0, halving = 0;
             halving < schedule.halvings && gain6(p, share) > least_gain6;) {
            place(group, weight, share * p.step);
            if (allowed(p.faces)) {
                keep(group, p.faces);
                return true;
            }
            for (std::size_t i = 0; i < before.size(); ++i)
                s_.b[group.first[i].vertex] = before[i];
            if (cut++ < schedule.cuts && add_planes(weight, p.bounds)) {
                p.step = best_step(p);
            } else {
                ++halving;
                share *= 0.5;
            }
        }
        return false;
    }

    void place(const Group& group, const std::vector<double>& weight, const Vec3d& by)
    {
        for (const GroupShare& share : group)
            if (!s_.pinned[share.vertex])
                s_.b[share.vertex] =
                    capped(s_, share.vertex, s_.b[share.vertex] + weight[share.vertex] * by);
    }

    void keep(const Group& group, const std::vector<int>& faces)
    {
        ++now_;
        for (const GroupShare& share : group)
            changed_[share.vertex] = now_;
        for (const int f : faces)
            s_.inner_tree.widen(std::size_t(f), float_box_of(inner_corners(s_, f)));
    }

    /// What comes in the way is left in hits_.
    bool allowed(const std::vector<int>& faces)
    {
        hits_.clear();
        for (const int f : faces)
            if (!prism_valid(s_, f) || holds_component(s_, f))
                return false;
        list_hits(faces);
        return hits_.empty() && clear_among(faces);
    }

    /// The first triangles that those of the group meet.
    void list_hits(const std::vector<int>& faces)
    {
        constexpr std::size_t kEnough = 24; // for as many planes: the next try shows the others
        for (const int f : faces) {
            const InnerTriangle triangle(s_, f);
            const FloatBox box = float_box_of(triangle.corners());
            s_.inner_tree.for_each_overlap(box, [&](int g) {
                if (hits_.size() < kEnough && !marked_[g] && triangle.meets_inner(g))
                    hits_.push_back({f, g, false});
            });
            s_.outer_tree.for_each_overlap(box, [&](int g) {
                if (hits_.size() < kEnough && triangle.meets_outer(g))
                    hits_.push_back({f, g, true});
            });
            if (hits_.size() == kEnough)
                return;
        }
    }
    bool clear_among(const std::vector<int>& faces)
    {
        near_.clear();
        for (const int f : faces)
            near_.add(float_box_of(inner_corners(s_, f)), f);
        return std::none_of(faces.begin(), faces.end(), [&](int f) {
            const InnerTriangle triangle(s_, f);
            return near_.any_overlap(float_box_of(triangle.corners()),
                                     [&](int g) { return g > f && triangle.meets_inner(g); });
        });
    }

    /// Puts a plane before each triangle that was met, as it lies to the group before its step.
    /// False if there is none to put: what has a corner in common has no plane between.
    bool add_planes(const std::vector<double>& weight, LinearBounds& bounds) const
    {
        bool any = false;
        for (const Hit& hit : hits_) {
            if (!hit.outer && has_common_corner(s_, hit.face, hit.other))
                continue;
            const Corners mine = inner_corners(s_, hit.face);
            const Corners other =
                hit.outer ? outer_corners(s_, hit.other) : inner_corners(s_, hit.other);
            const SlabQuery query{&mine, &other, std::numeric_limits<double>::infinity()};
            Slab slab;
            slabs_between(&query, 1, &slab);
            if (!(slab.gap > 0))
                continue;
            for (std::size_t k = 0; k < 3; ++k) {
                const double w = weight[s_.mesh->corner(hit.face, static_cast<int>(k))];
                if (!(w > 0))
                    continue;
                bounds.add_unit(slab.n, (Vec3d(slab.n).dot(mine[k] - mine[0]) - slab.hi) / w);
                any = true;
            }
        }
        return any;
    }

    struct Hit {
        int face, other;
        bool outer;
    };

    GrowState& s_;
    double barrier_weight_;
    tbb::enumerable_thread_specific<std::vector<double>> weight_; ///< by vertex, 0 between groups
    std::uint32_t now_ = 1;
    std::vector<std::uint32_t> changed_; ///< by vertex: when it moved last
    std::vector<std::uint8_t> marked_;   ///< faces of the group that is being moved
    std::vector<Hit> hits_;
    BoxTree::Near near_;
    std::vector<double> void6_; ///< by vertex: six times the volume before it
};

std::vector<Group> groups_of(const std::vector<GroupShare>& shares)
{
    std::vector<Group> groups;
    for (const GroupShare& share : shares) {
        if (groups.empty() || groups.back().first->group != share.group)
            groups.push_back({&share, &share});
        groups.back().last = &share + 1;
    }
    return groups;
}

} // namespace

std::size_t move_groups(GrowState& s, const std::vector<GroupShare>& shares,
                        const StageProgress& progress)
{
    // Enough for many threads; the more, the more of them look at what has changed meanwhile.
    constexpr std::size_t kBlock = 64;
    const double empty = 1 - fill_of(s);
    if (empty < s.schedule.groups.least_void_of_solid)
        return 0;
    std::vector<Group> groups = groups_of(shares);
    const double void6 = empty * std::abs(volume6(s.a, s.mesh->faces));
    const double mean_void6 = void6 / std::max<double>(1, double(groups.size()));
    const double least_gain6 = s.schedule.groups.least_gain * mean_void6;
    GroupMoves moves(s);
    moves.look_ahead();
    groups.erase(std::remove_if(groups.begin(), groups.end(),
                                [&](const Group& group) {
                                    return !moves.has_room(group, s.schedule.groups.least_void *
                                                                      mean_void6);
                                }),
                 groups.end());
    std::vector<Proposal> proposal(kBlock);
    std::vector<std::uint8_t> wanted(kBlock);
    std::vector<std::uint32_t> tried(groups.size(), 0);
    std::size_t made = 0;
    for (int sweep = 0; sweep < s.schedule.groups.sweeps; ++sweep) {
        if (sweep > 0)
            moves.rebuild_tree();
        std::uint32_t then = 0;
        propose_in_blocks(
            groups.size(), kBlock,
            [&] {
                progress.stop_if_interrupted(0);
                then = moves.now();
            },
            [&](std::size_t i, std::size_t slot) {
                wanted[slot] = moves.propose(groups[i], tried[i], least_gain6, proposal[slot]);
                tried[i] = then;
            },
            [&](std::size_t i, std::size_t slot) {
                made += wanted[slot] && moves.make(groups[i], then, least_gain6, proposal[slot]);
            });
    }
    return made;
}

} // namespace vdb_shell::growth

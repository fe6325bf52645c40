// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell, and a coarser surface whose vertices say which vertices move together.
// Leaves: a valid shell that is thicker. Prolongation and mending leave voids as wide as many
// triangles, where a detail of the surface held its own pillars back and nobody else came. Groups
// are moved one after another; those of cells that are far from each other at the same time
// (group_cells.h): while a cell's groups keep within its domain, nothing that one of them reads is
// moved by a group of another cell. What would leave its domain comes last, one by one.

#include "growth/move_groups.h"

#include "core/parallel.h"
#include "core/stage_stop.h"
#include "growth/cell_moves.h"
#include "growth/group_cells.h"
#include "growth/other_components.h"
#include "growth/ray_hit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

// Of the longest step that a group may make, what its box is widened by before cells are chosen. On
// the scans boot and skull no group then ever had to leave its domain.
constexpr double kShareOfStep = 0.25;

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

void rebuild_tree(GrowState& s)
{
    build_inner_tree(s);
    s.inner_tree.index_parents();
}

/// The way from b_v to the next inner triangle.
double room(const GrowState& s, int v, const Vec3d& along)
{
    double nearest = s.diagonal;
    s.inner_tree.for_each_on_ray(s.b[v], along, nearest, [&](int f) {
        if (!s.mesh->incident_to(f, v))
            nearest = std::min(nearest, ray_hit(s.b[v], along, inner_corners(s, f)));
    });
    // A ray that meets nothing has left through a triangle of the vertex's own.
    return nearest < s.diagonal ? nearest : 0;
}

/// Six times the void before each vertex: what most groups lack.
std::vector<double> voids6(const GrowState& s)
{
    std::vector<double> void6(s.b.size());
    for_each_index(void6.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        const Vec3d gradient = inner_volume6_gradient(s, v);
        const double area6 = gradient.length();
        void6[i] = s.pinned[v] || !(area6 > 0) ? 0 : area6 * room(s, v, gradient / -area6);
    });
    return void6;
}

/// Leaves out the groups with little void before them.
std::vector<Group> with_room(const GrowState& s, std::vector<Group> groups, double least_void6)
{
    const std::vector<double> void6 = voids6(s);
    const auto has_none = [&](const Group& group) {
        double sum = 0;
        for (const GroupShare& share : group)
            sum += share.weight * void6[share.vertex];
        return !(sum > least_void6);
    };
    groups.erase(std::remove_if(groups.begin(), groups.end(), has_none), groups.end());
    return groups;
}

class Sweeps
{
public:
    Sweeps(GroupField& field, const std::vector<Group>& groups)
        : field_(field), s_(field.s), groups_(groups), tried_(groups.size(), 0)
    {
    }

    void sweep(const StageProgress& progress)
    {
        std::vector<Box> boxes(groups_.size());
        for_each_index(boxes.size(), [&](std::size_t i) { boxes[i] = box_to_move_in(groups_[i]); });
        last_.clear();
        const std::vector<GroupTurn> turns = turns_of_groups(boxes);
        for (std::size_t i = 0; i < turns.size(); ++i) {
            progress.stop_if_interrupted(100 * double(i) / double(turns.size()));
            take(turns[i]);
        }
        std::sort(last_.begin(), last_.end());
        Box all;
        all.lo = Vec3d(-std::numeric_limits<double>::infinity());
        all.hi = Vec3d(std::numeric_limits<double>::infinity());
        CellMoves moves(field_, all);
        for (const std::size_t i : last_) {
            progress.stop_if_interrupted(100);
            ++now_;
            moves.move(groups_[i], tried_[i], now_);
            tried_[i] = now_ - 1;
            moves.update_tree();
        }
        made_ += moves.made();
    }
    std::size_t made() const { return made_; }

private:
    Box box_of_faces(const Group& group) const
    {
        Box box;
        for (const GroupShare& share : group)
            box.add(box_of_star(s_, share.vertex, s_.b[share.vertex]));
        return box;
    }
    Box box_to_move_in(const Group& group) const
    {
        Box box = box_of_faces(group);
        double area6 = 0;
        for (const GroupShare& share : group)
            area6 += share.weight * inner_volume6_gradient(s_, share.vertex).length();
        box.inflate(kShareOfStep * s_.schedule.groups.radius * std::sqrt(area6 / 6));
        return box;
    }
    bool keeps_within(const Group& group, const Box& domain) const
    {
        const Box box = box_of_faces(group);
        return domain.contains(box.lo) && domain.contains(box.hi) &&
               // Any cell may ask where the witness of another component is.
               (s_.mesh->components < 2 ||
                std::none_of(group.begin(), group.end(), [&](const GroupShare& share) {
                    return is_witness(s_, share.vertex);
                }));
    }

    /// The cells of one turn at the same time.
    void take(const GroupTurn& turn)
    {
        // All are asked before one moves: what lies in its cell's domain now will stay there.
        std::vector<std::vector<std::size_t>> within(turn.size()), out(turn.size());
        for_each_index(
            turn.size(),
            [&](std::size_t c) {
                for (const std::size_t i : turn[c].groups)
                    (keeps_within(groups_[i], turn[c].domain) ? within : out)[c].push_back(i);
            },
            1);
        std::vector<CellMoves> moves;
        moves.reserve(turn.size());
        for (const GroupCell& cell : turn)
            moves.emplace_back(field_, cell.domain);
        for_each_index(
            turn.size(),
            [&](std::size_t c) {
                for (std::size_t k = 0; k < within[c].size(); ++k) {
                    stop_if_stage_wants();
                    const std::size_t i = within[c][k];
                    // Cells of a turn know nothing of each other, so their times may be the same.
                    const std::uint32_t now = now_ + 1 + static_cast<std::uint32_t>(k);
                    if (moves[c].move(groups_[i], tried_[i], now) == GroupOutcome::left_domain)
                        out[c].push_back(i);
                    else
                        // A step that was made is tried again as if another had made it.
                        tried_[i] = now - 1;
                }
            },
            1);
        std::size_t most = 0;
        for (std::size_t c = 0; c < turn.size(); ++c) {
            moves[c].update_tree();
            made_ += moves[c].made();
            last_.insert(last_.end(), out[c].begin(), out[c].end());
            most = std::max(most, within[c].size());
        }
        now_ += static_cast<std::uint32_t>(most);
    }

    GroupField& field_;
    GrowState& s_;
    const std::vector<Group>& groups_;
    std::uint32_t now_ = 1;
    std::vector<std::uint32_t> tried_; ///< by group: when it was last
    std::vector<std::size_t> last_;    ///< groups that are moved after all turns
    std::size_t made_ = 0;
};

} // namespace

std::size_t move_groups(GrowState& s, const std::vector<GroupShare>& shares,
                        const StageProgress& progress)
{
    const GroupSchedule& schedule = s.schedule.groups;
    const double fill = fill_of(s), empty = 1 - fill;
    if (empty < schedule.least_void_of_solid || fill >= s.schedule.barrier.enough_fill)
        return 0;
    std::vector<Group> groups = groups_of(shares);
    const double void6 = empty * std::abs(volume6(s.a, s.mesh->faces));
    const double mean_void6 = void6 / std::max<double>(1, double(groups.size()));
    rebuild_tree(s);
    groups = with_room(s, std::move(groups), schedule.least_void * mean_void6);
    GroupField field(s, schedule.least_gain * mean_void6);
    Sweeps sweeps(field, groups);
    for (int i = 0; i < schedule.sweeps; ++i) {
        if (i > 0)
            rebuild_tree(s);
        sweeps.sweep(progress.part(100.0 * i / schedule.sweeps, 100.0 * (i + 1) / schedule.sweeps));
    }
    return sweeps.made();
}

} // namespace vdb_shell::growth

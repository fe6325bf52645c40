// SPDX-License-Identifier: Apache-2.0
#pragma once

// The moves of the groups of one cell.

#include "growth/barrier.h"
#include "growth/group_shares.h"
#include "growth/grow_state.h"
#include "growth/other_components.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// The shares of one group.
struct Group {
    const GroupShare *first, *last;
    const GroupShare* begin() const { return first; }
    const GroupShare* end() const { return last; }
};

/// What the moves of all groups share. A cell writes only what belongs to vertices and faces in its
/// domain.
struct GroupField {
    GroupField(GrowState& state, double least_gain6);

    GrowState& s;
    double barrier_weight;
    double least_gain6;                 ///< six times the volume that a step has to win
    std::vector<double> weight;         ///< by vertex, in the group that is being moved; else 0
    std::vector<std::uint32_t> changed; ///< by vertex: when it moved last
    std::vector<std::uint8_t> marked;   ///< by face: of the group that is being moved
    std::vector<int> moved_at;          ///< by face: place in the list of its cell, or -1
};

enum class GroupOutcome { stayed, moved, left_domain };

/// Moves groups one after another, within a domain. Precondition: boxes of the inner tree hold the
/// triangles and index_parents has been called.
class CellMoves
{
public:
    CellMoves(GroupField& field, const Box& domain) : field_(field), s_(field.s), domain_(domain) {}

    /// `then`: when the group was tried last. `now`: what its vertices are marked with.
    GroupOutcome move(const Group& group, std::uint32_t then, std::uint32_t now);
    /// Tells the tree where the faces are. Not while another cell's groups move.
    void update_tree();
    std::size_t made() const { return made_; }

private:
    struct Hit {
        int face, other;
        bool outer;
    };

    void list_faces(const Group& group);
    bool changed_since(std::uint32_t then) const;
    void list_bounds();
    GroupOutcome make_step(const Group& group, std::uint32_t now);
    void place(const Group& group, const Vec3d& by);
    Box box_of_faces() const;
    void keep(const Group& group, std::uint32_t now);
    bool allowed(const Box& reached);
    void list_near(const FloatBox& reached);
    void list_hits();
    bool clear_among();
    bool add_planes();
    double gain6(double share) const { return -share * gradient_.dot(step_); }
    Vec3d best_step() { return barrier_minimum(bounds_, ball_, gradient_, field_.barrier_weight); }
    double weight_of(int f, std::size_t corner) const
    {
        return field_.weight[s_.mesh->corner(f, static_cast<int>(corner))];
    }

    GroupField& field_;
    GrowState& s_;
    Box domain_;
    std::vector<int> faces_; ///< those whose prisms change
    WitnessSearch search_ = WitnessSearch::trees;
    Vec3d gradient_{0.0}; ///< of the inner surface's volume6
    Ball ball_{Vec3d(0.0), 0.0};
    LinearBounds bounds_;
    Vec3d step_{0.0};
    std::vector<Vec3d> before_;
    std::vector<Hit> hits_;
    std::vector<int> moved_; ///< faces that the tree has in another place
    std::vector<FloatBox> moved_box_;
    BoxTree::Near near_inner_, near_outer_, among_;
    std::size_t made_ = 0;
};

} // namespace vdb_shell::growth

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "taper/taper_state.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::taper
{

/// A change that pays: what it is, the pieces that it is about, and what they cost after it.
struct Trial {
    Substitution change{};
    std::vector<int> pieces;
    std::vector<PieceCost> costs;
    Vec3d step{0.0};  ///< of a move
    double share = 0; ///< of the step that it makes
};

/// Single changes of a state, thought of only: whether all tets stay positive, the pillars short
/// enough and the cost falls. Nothing here looks at the inner surface, and nothing is changed, so
/// several threads can have one each for one state.
///
/// A call that returns true leaves the change, the pieces that it is about and their costs behind.
class Trials
{
public:
    explicit Trials(const TaperState& s) : s_(s), listed_(std::size_t(s.pieces()), 0) {}

    /// Node `from` becomes one with node `to`, at the best of the two points and the one halfway.
    /// Precondition: both are in use, `from` is not fixed.
    bool merge(int from, int to);
    /// A step of Newton's method for the node's own convex problem.
    bool move(int n);
    /// After a move that passed here and failed elsewhere: the next shorter step that passes.
    bool move_less(const Trial& failed);
    /// A place goes over from its node, which keeps others, to another one.
    bool hand_over(int place, int to);

    /// For a diagonal, which the caller turns between the two calls: the pieces beside it.
    void list(const std::vector<int>& pieces);
    bool turned_costs_less();

    /// Takes what the last call has left, for the price of a copy or none.
    void give(Trial& trial)
    {
        trial.change = change_;
        trial.pieces.swap(pieces_);
        trial.costs.swap(cost_);
        trial.step = step_;
        trial.share = share_;
    }

private:
    void begin_list();
    void list(int layer, int face);
    void list_around(const std::vector<int>& places);
    void sum_before();
    template <class PieceOf>
    bool cost_less(const PieceOf& piece_at, double volume6, double than, double& cost);
    bool costs_less(const Substitution& change, double than, double& cost);
    double volume6_after(const Substitution& change) const;
    bool loses_last_tet(int piece, const PieceCost& now) const;
    struct Steps {
        Vec3d plain, for_poor;
    };
    Steps newton_steps(int n) const;
    bool shorter_move(int n, double than);

    const TaperState& s_;
    Substitution change_{};
    Vec3d step_{0.0};
    double share_ = 0; ///< of the step
    // Kept from one change to the next, for the memory.
    std::vector<int> pieces_;
    std::vector<PieceCost> cost_, best_cost_;
    std::vector<std::uint32_t> listed_; ///< by piece: the list that it is in
    std::uint32_t lists_ = 0;
    struct {
        double cost = 0, worst = 0;
    } before_;            ///< of the pieces
    double volume6_ = 0;  ///< of the pieces before the change
    double enough_ = 0;   ///< what they have to cost less than
    double cost_now_ = 0; ///< what they would cost
};

} // namespace vdb_shell::taper

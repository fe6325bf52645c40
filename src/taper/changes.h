// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "taper/inner_contacts.h"
#include "taper/taper_state.h"

#include <vector>

namespace vdb_shell::taper
{

/// Single changes of a state. Each is made only if the state is valid after it and costs less; if
/// not, nothing is changed. Not for several threads: a change may touch any part of the inner
/// surface.
class Changes
{
public:
    explicit Changes(TaperState& s) : s_(s), listed_(std::size_t(s.pieces()), 0) {}

    /// Node `from` becomes one with node `to`, at the best of the two points and the one halfway.
    /// Precondition: both are in use, `from` is not fixed.
    bool merge(int from, int to);
    /// A step of Newton's method for the node's own convex problem, halved until it passes.
    bool move(int n);
    /// A place goes over from its node, which keeps others, to another one.
    bool hand_over(int place, int to);
    /// The other diagonal for the quad under an edge of a layer.
    bool turn(int layer, int edge);

private:
    struct Sum {
        double cost = 0, worst = 0;
        bool valid = false;
    };

    void begin_list();
    void list(int layer, int face);
    void list_around(const std::vector<int>& places);
    Sum present() const;
    Sum measured();
    bool loses_last_tet(int piece, const PieceCost& now) const;
    bool better(const Sum& now) const;
    void accept();
    void point_places(int from, int to);
    Vec3d newton_step(int n) const;

    TaperState& s_;
    // Kept from one change to the next, for the memory.
    std::vector<int> pieces_;
    std::vector<PieceCost> cost_;
    std::vector<Swept> swept_;
    std::vector<std::uint32_t> listed_; ///< by piece: the list that it is in
    std::uint32_t lists_ = 0;
    Sum before_;
};

} // namespace vdb_shell::taper

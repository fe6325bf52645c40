// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "taper/inner_contacts.h"
#include "taper/taper_state.h"
#include "taper/trials.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::taper
{

/// Single changes of a state. Each is made only if the state is valid after it and costs less; if
/// not, nothing is changed. Not for several threads: a change may touch any part of the inner
/// surface. What the changes are: taper/trials.h.
class Changes
{
public:
    explicit Changes(TaperState& s) : s_(s), trials_(s), changed_(s.point.size(), 1) {}

    bool merge(int from, int to) { return trials_.merge(from, to) && make_merge(own_trial()); }
    bool move(int n) { return trials_.move(n) && make_move(own_trial()); }
    bool hand_over(int place, int to)
    {
        return trials_.hand_over(place, to) && make_hand_over(own_trial());
    }
    /// The same of what has been found to pay, on a state in which nothing beside it has changed
    /// since. The trial is used up.
    bool make_merge(Trial& trial);
    bool make_move(Trial& trial);
    bool make_hand_over(Trial& trial);
    /// The other diagonal for the quad under an edge of a layer.
    bool turn(int layer, int edge);

    TaperState& state() { return s_; }
    /// Ticks with each change.
    std::uint32_t now() const { return now_; }
    /// Whether a tet at the node has changed since then. If not, what cost too much then does
    /// still.
    bool changed_since(int n, std::uint32_t then) const { return changed_[std::size_t(n)] > then; }

private:
    Trial& own_trial()
    {
        trials_.give(trial_);
        return trial_;
    }
    void accept(const Trial& trial);
    void point_places(int from, int to);
    bool inner_surface_allows(const Trial& trial);
    void list_swept_by_place(int place, int to);

    TaperState& s_;
    Trials trials_;
    Trial trial_;
    std::uint32_t now_ = 1;
    std::vector<std::uint32_t> changed_; ///< by node: when a tet at it changed last
    std::vector<Swept> swept_;           ///< kept for the memory
};

} // namespace vdb_shell::taper

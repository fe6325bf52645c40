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

    bool merge(int from, int to);
    bool move(int n);
    bool hand_over(int place, int to);
    /// The other diagonal for the quad under an edge of a layer.
    bool turn(int layer, int edge);

    TaperState& state() { return s_; }
    /// Ticks with each change.
    std::uint32_t now() const { return now_; }
    /// Whether a tet at the node has changed since then. If not, what cost too much then does
    /// still.
    bool changed_since(int n, std::uint32_t then) const { return changed_[std::size_t(n)] > then; }

private:
    void accept();
    void point_places(int from, int to);
    bool inner_surface_allows(const Substitution& change);
    void list_swept_by_place(int place, int to);

    TaperState& s_;
    Trials trials_;
    std::uint32_t now_ = 1;
    std::vector<std::uint32_t> changed_; ///< by node: when a tet at it changed last
    std::vector<Swept> swept_;           ///< kept for the memory
};

} // namespace vdb_shell::taper

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/stage_progress.h"
#include "taper/changes.h"
#include "taper/taper_state.h"
#include "taper/trials.h"

#include <tbb/enumerable_thread_specific.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell::taper
{

struct MergeOptions {
    /// Nodes of the innermost surface that are no neighbours are tried too where they are nearer
    /// than this share of the way to the nearest neighbour: across the void, to close it. 0: none.
    double across = 0.5;
    bool into_level_above = false; ///< also a place with the one above it: a layer ends there
};

/// Passes over a state: one try of each change of a kind, in an order of its own. Each gives how
/// many were made. What has failed in the last pass of its kind is tried again only where a tet has
/// changed since. Deterministic for any number of threads. Throws Cancelled between two blocks.
class Passes
{
public:
    Passes(TaperState& s, const MergeOptions& options, const StageProgress& progress)
        : options_(options), progress_(progress), changes_(s), trials_([&s] { return Trials(s); })
    {
    }

    std::size_t merge(int percent);
    std::size_t move(int percent);
    std::size_t hand_over(int percent);
    std::size_t turn(int percent);

private:
    template <class Item, class Search, class Stale, class Make, class Again>
    std::size_t in_blocks(const std::vector<Item>& items, int percent, const Search& search,
                          const Stale& stale, const Make& make, const Again& again);
    std::size_t renewed_after(std::size_t made);
    bool changed_since(int p, int q, std::uint32_t then) const
    {
        return changes_.changed_since(p, then) || changes_.changed_since(q, then);
    }

    MergeOptions options_;
    const StageProgress& progress_;
    Changes changes_;
    tbb::enumerable_thread_specific<Trials> trials_;
    std::size_t widened_ = 0; ///< changes since the tree of the inner surface was built
    struct {
        std::uint32_t merge = 0, move = 0, hand_over = 0;
    } last_; ///< when the last pass of its kind began
};

} // namespace vdb_shell::taper

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/parallel.h"
#include "shell/grow/move_tests.h"

namespace vdb_shell::growth
{

struct SweepScratch {
    std::vector<Vec3d> proposal;
    std::vector<std::uint8_t> wants, moved; ///< by vertex
    std::vector<int> stamp;                 ///< by face: the batch that last moved it
    int batch = 0;
};

/// Did an earlier commit of this batch move anything that v's star may touch?
inline bool disturbed(const GrowState& s, const SweepScratch& w, int v)
{
    for (const FaceCorner& at : star(*s.mesh, v))
        for (const int g : s.near_inner[at.face])
            if (w.stamp[g] == w.batch)
                return true;
    return false;
}

/// One Gauss-Seidel sweep: the proposals of a colour class are made in parallel against the frozen
/// state, then committed one by one in index order, so the result does not depend on the threads.
/// `propose(v, x)` returns true and a position that is already tested against the present state.
/// Which vertices moved stands in `w.moved`.
template <class Propose> void sweep(GrowState& s, SweepScratch& w, const Propose& propose)
{
    constexpr std::size_t kGrain = 8; // a proposal costs microseconds to milliseconds
    w.proposal.resize(s.b.size());
    w.wants.assign(s.b.size(), 0);
    w.moved.assign(s.b.size(), 0);
    w.stamp.resize(s.mesh->faces.size(), 0);
    for (const std::vector<int>& colour : s.mesh->colour) {
        for_each_index(
            colour.size(),
            [&](std::size_t i) { w.wants[colour[i]] = propose(colour[i], w.proposal[colour[i]]); },
            kGrain);
        ++w.batch;
        for (const int v : colour) {
            if (!w.wants[v])
                continue;
            const Vec3d& x = w.proposal[v];
            if ((disturbed(s, w, v) && !star_clear_at(s, v, x)) || swallows_component(s, v, x))
                continue;
            commit_move(s, v, x);
            for (const FaceCorner& at : star(*s.mesh, v))
                w.stamp[at.face] = w.batch;
            w.moved[v] = 1;
        }
    }
}

} // namespace vdb_shell::growth

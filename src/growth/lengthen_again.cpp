// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell after mending, and where its inner points were before. Leaves: a valid shell
// that is thicker. Mending shortens all three pillars of a prism that fails, for which of them is
// to blame cannot be told then, and goes on for as long as one of them fails again; afterwards most
// that were not can go back. Few points have lost much, so they are tried one by one; that this is
// done in blocks, on all threads, changes no bit.

#include "growth/lengthen_again.h"

#include "core/parallel.h"
#include "core/propose_in_blocks.h"
#include "growth/first_contact.h"
#include "growth/move_tests.h"
#include "growth/other_components.h"
#include "growth/violations.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

std::vector<int> most_lost_first(const GrowState& s, const std::vector<double>& lost6)
{
    std::vector<int> vertices;
    const double fill = fill_of(s);
    if (fill >= s.schedule.barrier.enough_fill)
        return vertices;
    const double empty6 = (1 - fill) * std::abs(volume6(s.a, s.mesh->faces));
    const double least6 = s.schedule.mend.least_loss * empty6 / std::max(1, s.mesh->vertices);
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (!s.pinned[v] && lost6[v] > least6)
            vertices.push_back(v);
    std::stable_sort(vertices.begin(), vertices.end(),
                     [&](int u, int v) { return lost6[u] > lost6[v]; });
    return vertices;
}

/// Puts the inner point of v to x, and the boxes of its faces with it.
void put(GrowState& s, int v, const Vec3d& x, const std::vector<int>& faces)
{
    s.b[v] = x;
    for (const int f : faces)
        s.inner_tree.replace(static_cast<std::size_t>(f), float_box_of(inner_corners(s, f)));
}

/// The places on the way back, the farthest first, until visit(x) takes one.
template <class Visit>
bool any_place(const GrowState& s, int v, const Vec3d& before, const Visit& visit)
{
    const Vec3d here = s.b[v];
    double share = 1;
    for (int i = 0; i < s.schedule.mend.tries_back; ++i, share *= 0.5)
        if (visit(capped(s, v, here + share * (before - here))))
            return true;
    return false;
}

/// What is asked first: the tests that look at the vertex's own prisms alone.
bool own_prisms_allow(const GrowState& s, int v, const Vec3d& x)
{
    return x != s.b[v] && x != s.a[v] && tets_positive_at(s, v, x) && !swallows_component(s, v, x);
}

/// Tries each place in turn.
bool put_back(GrowState& s, int v, const Vec3d& before)
{
    const Vec3d here = s.b[v];
    const std::vector<int> faces = faces_at(*s.mesh, v);
    return any_place(s, v, before, [&](const Vec3d& x) {
        if (!own_prisms_allow(s, v, x))
            return false;
        put(s, v, x, faces);
        if (faces_valid(s, faces))
            return true;
        put(s, v, here, faces);
        return false;
    });
}

/// Where one point can go while all others stay.
struct Proposal {
    bool known = false; ///< else it has to be tried in place
    bool moves = false;
    Vec3d to{0.0};
    /// Of its triangles, wherever it was tried: what lies outside does not matter.
    FloatBox reach{};
};

/// Whether the tests that change nothing say all that faces_valid says.
bool can_be_proposed(const GrowState& s, int v)
{
    return !s.mesh->has_crowds && s.excused.empty() && !beside_a_pin(s, v) && !is_witness(s, v);
}

FloatBox reach_of(const GrowState& s, int v, const Vec3d& before)
{
    Box reach = box_of_star(s, v, s.b[v]);
    any_place(s, v, before, [&](const Vec3d& x) {
        reach.add(x);
        return false;
    });
    return float_box(reach);
}

Proposal propose(const GrowState& s, int v, const Vec3d& before, NearTriangles& near)
{
    Proposal proposal;
    proposal.reach = reach_of(s, v, before);
    proposal.known = can_be_proposed(s, v);
    proposal.moves =
        proposal.known && any_place(s, v, before, [&](const Vec3d& x) {
            proposal.to = x;
            return own_prisms_allow(s, v, x) && first_contact(s, v, x, near) == StopReason::none;
        });
    return proposal;
}

/// Puts points back in their order. Most do not meet, so each is tried as if those before it in its
/// block stayed, on all threads; one that comes near what has moved since is tried again.
class PuttingBack
{
public:
    PuttingBack(GrowState& s, const std::vector<Vec3d>& before) : s_(s), before_(before) {}

    void begin() { moved_.clear(); }
    void propose(int v, std::size_t slot)
    {
        proposals_[slot] =
            growth::propose(s_, v, before_[static_cast<std::size_t>(v)], near_.local());
    }
    bool make(int v, std::size_t slot)
    {
        const Proposal& proposal = proposals_[slot];
        const bool stale = std::any_of(moved_.begin(), moved_.end(), [&](const FloatBox& box) {
            return box.overlaps(proposal.reach);
        });
        const bool moves = stale || !proposal.known
                               ? put_back(s_, v, before_[static_cast<std::size_t>(v)])
                               : proposal.moves && take(v, proposal.to);
        if (moves)
            moved_.push_back(proposal.reach);
        return moves;
    }

    // Points. Many for two dozen threads, and few enough that of those before one in its block
    // hardly any has moved near it.
    static constexpr std::size_t kBlock = 128;

private:
    bool take(int v, const Vec3d& x)
    {
        const std::vector<int> faces = faces_at(*s_.mesh, v);
        const Vec3d here = s_.b[v];
        put(s_, v, x, faces);
        if (std::none_of(faces.begin(), faces.end(), [&](int f) { return holds_component(s_, f); }))
            return true;
        put(s_, v, here, faces);
        return put_back(s_, v, before_[static_cast<std::size_t>(v)]);
    }

    GrowState& s_;
    const std::vector<Vec3d>& before_;
    std::array<Proposal, kBlock> proposals_;
    std::vector<FloatBox> moved_; ///< in this block
    tbb::enumerable_thread_specific<NearTriangles> near_;
};

} // namespace

std::vector<double> volume6_lost(const GrowState& s, const std::vector<Vec3d>& before)
{
    std::vector<double> lost6(before.size());
    for_each_index(lost6.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        lost6[i] = -inner_volume6_gradient(s, v).dot(before[i] - s.b[i]);
    });
    return lost6;
}

std::size_t lengthen_again(GrowState& s, const std::vector<Vec3d>& before,
                           const StageProgress& progress)
{
    const std::vector<int> vertices = most_lost_first(s, volume6_lost(s, before));
    // A tree that was refitted often is slow, and later stages go in its order.
    build_inner_tree(s);
    s.inner_tree.index_parents();
    PuttingBack putting(s, before);
    std::size_t begun = 0, moved = 0;
    propose_in_blocks(
        vertices.size(), PuttingBack::kBlock,
        [&] {
            progress.stop_if_interrupted(100 * double(begun) / double(vertices.size()));
            begun += PuttingBack::kBlock;
            putting.begin();
        },
        [&](std::size_t i, std::size_t slot) { putting.propose(vertices[i], slot); },
        [&](std::size_t i, std::size_t slot) { moved += putting.make(vertices[i], slot); });
    return moved;
}

} // namespace vdb_shell::growth

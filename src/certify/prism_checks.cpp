// SPDX-License-Identifier: Apache-2.0

// Takes: prisms, the orders of their corners, and the uses of the edges. Gives: conditions 1 and 2
// of docs/theory.md, "The whole shell": a closed oriented manifold, tets that are positive, and
// diagonals on which the prisms at an edge agree. Signs are exact on the stored float32; all the
// rest compares indices. Flags are raised in parallel, each by its own prism, and listed in index
// order afterwards. Orders come from files too, so an entry may be anything: nothing is concluded
// from an order that is no permutation.

#include "certify/prism_checks.h"

#include "certify/certificate_findings.h"
#include "core/disjoint_sets.h"
#include "core/exact.h"
#include "core/parallel.h"

#include <array>

namespace vdb_shell
{
namespace
{

using Order = std::array<std::uint8_t, 3>;

bool is_permutation(const Order& order)
{
    unsigned seen = 0;
    for (const std::uint8_t corner : order)
        seen |= corner < 3 ? 1U << corner : 0U;
    return seen == 7U;
}

bool comes_before(const Order& order, std::uint8_t corner, std::uint8_t other)
{
    for (const std::uint8_t entry : order) {
        if (entry == corner)
            return true;
        if (entry == other)
            return false;
    }
    return false;
}

/// Each tet of each split holds one whole pillar and one end of either other pillar: four tets a
/// pillar, twelve a prism (docs/theory.md, "One prism: the twelve tets"). With the corners in this
/// order a single formula gives the sign of all of them, whether the split's permutation is even or
/// odd. Only the whole pillar has to be un-pinned: the tet of a pinned pillar does not exist.
class Prism
{
public:
    Prism(const PrismShell& shell, const openvdb::Vec3I& triangle)
    {
        for (std::size_t i = 0; i < 3; ++i)
            pillar_[i] = {&shell.outer[triangle[int(i)]], &shell.inner[triangle[int(i)]]};
    }
    /// The tet of pillar `i`, with the inner ends of the next and of the previous pillar where the
    /// flags say so.
    bool positive(std::size_t i, bool next_inner, bool previous_inner) const
    {
        return exact::orient3d(*pillar_[i][0], *pillar_[i][1],
                               *pillar_[(i + 2) % 3][previous_inner],
                               *pillar_[(i + 1) % 3][next_inner]) > 0;
    }
    bool all_positive(std::size_t i) const
    {
        return positive(i, false, false) && positive(i, true, false) && positive(i, false, true) &&
               positive(i, true, true);
    }
    /// The diagonal over an edge ends at the inner end of the later corner, so the pillar's own tet
    /// has the inner ends of just those corners that come after its own.
    bool chosen_positive(std::size_t i, const Order& order) const
    {
        const auto corner = static_cast<std::uint8_t>(i);
        const auto next = static_cast<std::uint8_t>((i + 1) % 3);
        const auto previous = static_cast<std::uint8_t>((i + 2) % 3);
        return positive(i, comes_before(order, corner, next),
                        comes_before(order, corner, previous));
    }

private:
    std::array<std::array<const openvdb::Vec3s*, 2>, 3> pillar_{};
};

bool once_each_way(const EdgeUse* first, const EdgeUse* last)
{
    // An edge from a vertex to itself, of a triangle that names a corner twice, is no edge, however
    // often it is used.
    return last - first == 2 && first->edge[0] != first->edge[1] &&
           first[0].forward != first[1].forward;
}

/// Whether the diagonal over the edge starts at the outer end of its smaller vertex.
bool from_smaller(const PrismSplit& split, const EdgeUse& use)
{
    const auto end = static_cast<std::uint8_t>((use.side + 1) % 3);
    return comes_before(split.order[use.triangle], use.side, end) == use.forward;
}

} // namespace

std::vector<char> pinned_flags(const PrismShell& shell)
{
    std::vector<char> pinned(shell.outer.size());
    for_each_index(pinned.size(), [&](std::size_t v) { pinned[v] = shell.pinned(v); });
    return pinned;
}

void check_prisms(const PrismShell& shell, const PrismSplit& split, const std::vector<char>& pinned,
                  Certificate& certificate)
{
    std::vector<char> bad(shell.triangles.size()), cyclic(shell.triangles.size());
    const bool all = certificate.test == PrismTest::twelve_tets;
    for_each_index(bad.size(), [&](std::size_t t) {
        cyclic[t] = !is_permutation(split.order[t]);
        // Without an order there are no chosen tets to look at. The twelve do not depend on the
        // order, so they are tested all the same.
        if (cyclic[t] && !all)
            return;
        const Prism prism(shell, shell.triangles[t]);
        for (std::size_t i = 0; i < 3; ++i)
            if (!pinned[shell.triangles[t][int(i)]])
                bad[t] = bad[t] ||
                         !(all ? prism.all_positive(i) : prism.chosen_positive(i, split.order[t]));
    });
    certificate.bad_prisms = raised(bad);
    certificate.cyclic_prisms = raised(cyclic);
}

void check_edges(const PrismSplit& split, const std::vector<char>& pinned, const EdgeUses& uses,
                 Certificate& certificate, std::vector<char>& open_triangle)
{
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        const Edge& edge = uses[begin].edge;
        if (!once_each_way(&uses[begin], uses.data() + end)) {
            add_to(certificate.open_edges, edge);
            for (std::size_t i = begin; i < end; ++i)
                open_triangle[uses[i].triangle] = 1;
            continue;
        }
        // With a pinned end the quad is a triangle or an edge, the same for both prisms, and no
        // diagonal is left to disagree on (docs/theory.md, "Pins").
        const bool quad = !pinned[edge[0]] && !pinned[edge[1]];
        if (quad && is_permutation(split.order[uses[begin].triangle]) &&
            is_permutation(split.order[uses[begin + 1].triangle]) &&
            from_smaller(split, uses[begin]) != from_smaller(split, uses[begin + 1]))
            add_to(certificate.non_conforming_edges, edge);
    }
}

void check_vertices(const PrismShell& shell, const EdgeUses& uses, Certificate& certificate)
{
    // Corners of triangles are united across common edges; two classes at one vertex are two fans.
    // At an edge of more than two triangles all of them are united, so that such an edge is
    // reported as an open edge and not as a split vertex besides. Time is nearly linear.
    const std::size_t corners = 3 * shell.triangles.size();
    DisjointSets sets(corners);
    auto corner_at = [](const EdgeUse& use, bool larger) {
        const bool second = larger == use.forward;
        return 3 * use.triangle + (use.side + (second ? 1U : 0U)) % 3;
    };
    for (std::size_t i = 1; i < uses.size(); ++i) {
        if (uses[i].edge != uses[i - 1].edge)
            continue;
        for (const bool larger : {false, true})
            sets.join(corner_at(uses[i], larger), corner_at(uses[i - 1], larger));
    }
    constexpr std::uint32_t kNone = ~0U;
    std::vector<std::uint32_t> fan(shell.outer.size(), kNone);
    std::vector<char> split(shell.outer.size());
    for (std::uint32_t corner = 0; corner < corners; ++corner) {
        const std::uint32_t v = shell.triangles[corner / 3][int(corner % 3)];
        const std::uint32_t root = sets.root_of(corner);
        if (fan[v] == kNone)
            fan[v] = root;
        split[v] = split[v] || fan[v] != root;
    }
    certificate.split_vertices = raised(split);
}

} // namespace vdb_shell

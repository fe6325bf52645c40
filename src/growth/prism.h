// SPDX-License-Identifier: Apache-2.0
#pragma once

// The tets of one prism. Its corners: 0..2 are a (outer), 3..5 are b (inner).

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// One of the six vertex orders x<y<z of a prism; the diagonal of edge (u,v), u before v, is
/// a_u-b_v.
using PrismOrder = std::array<std::uint8_t, 3>;

struct OrientedTet {
    std::array<std::uint8_t, 4> corner; ///< positive when det(c1-c0, c2-c0, c3-c0) > 0
    int pillar; ///< local vertex whose a-b edge (12-tet set: whose a or b apex) the tet owns
};

/// The index of the set of all twelve tets in PrismTables::from_b.
inline constexpr int kTwelve = 6;

/// A tet seen from its corner b_l: volume6(x) = det(q-p, r-p, x-p), with pillar for pin handling.
struct TetFromInner {
    std::array<std::uint8_t, 3> base;
    int pillar;
};

struct PrismTables {
    std::array<PrismOrder, 6> order;
    std::array<std::array<OrientedTet, 3>, 6> three; ///< by order index
    std::array<OrientedTet, 12> twelve;
    /// [0..5] by order, [6] the twelve; then by local vertex l: the tets holding b_l.
    std::array<std::array<std::array<TetFromInner, 8>, 3>, 7> from_b;
    std::array<std::array<int, 3>, 7> from_b_count;
};

extern const PrismTables prism_tables;
inline const PrismTables& tables()
{
    return prism_tables;
}
int order_index(const PrismOrder& o);
/// By prism.
std::vector<std::uint8_t> order_indices(const std::vector<PrismOrder>& orders);

} // namespace vdb_shell::growth

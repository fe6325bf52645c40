// SPDX-License-Identifier: Apache-2.0

// The tets of a prism under each of the six orders of its corners, worked out by the compiler from
// the one rule of docs/theory.md, "Splits", so that no table is written by hand. Leaves: each tet
// with its corners in the order in which a positive determinant means a sound tet, and the same
// tets again as seen from each inner corner, as moves need them.

#include "growth/prism.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

/// A rotation of 0, 1, 2, which is known by its first two entries.
constexpr bool is_even(const PrismOrder& o)
{
    return (o[0] + 1) % 3 == o[1];
}

constexpr OrientedTet make(int pillar, int p, int q, int r, int s, bool swap)
{
    const auto u = [](int i) { return static_cast<std::uint8_t>(i); };
    return swap ? OrientedTet{{u(p), u(q), u(s), u(r)}, pillar}
                : OrientedTet{{u(p), u(q), u(r), u(s)}, pillar};
}

// As in the theory: owner z: (ax ay az bz), owner y: (ax ay by bz), owner x: (ax bx by bz).
// Triangles are counter-clockwise from outside and b lies inward: for an even order the first and
// the last of these are negative as they stand and the middle one is positive, for an odd order the
// other way round. Exchanging the last two corners mends the sign.
constexpr std::array<OrientedTet, 3> split_tets(const PrismOrder& o)
{
    const int x = o[0], y = o[1], z = o[2];
    const bool odd = !is_even(o);
    return {make(x, x, x + 3, y + 3, z + 3, !odd), make(y, x, y, y + 3, z + 3, odd),
            make(z, x, y, z, z + 3, !odd)};
}

// Of the eighteen tets of six splits twelve are different: that of the first corner of an order,
// and that of the last, do not depend on how the other two are ordered. A tet is known by the set
// of its corners, a bit mask.
constexpr std::array<OrientedTet, 12> union_of_splits(const PrismTables& t)
{
    std::array<OrientedTet, 12> out{};
    std::array<int, 12> mask{};
    int n = 0;
    for (const auto& split : t.three)
        for (const OrientedTet& o : split) {
            int m = 0;
            for (int c : o.corner)
                m |= 1 << c;
            bool seen = false;
            for (int i = 0; i < n; ++i)
                seen = seen || mask[i] == m;
            if (seen)
                continue;
            mask[n] = m;
            out[n++] = o;
        }
    return out;
}

constexpr void add_from_b(PrismTables& t, int set, const OrientedTet& o)
{
    for (int k = 0; k < 4; ++k) {
        if (o.corner[k] < 3)
            continue;
        std::array<std::uint8_t, 3> rest{};
        for (int i = 0, n = 0; i < 4; ++i)
            if (i != k)
                rest[n++] = o.corner[i];
        // An odd number of exchanges has brought the apex to the end: one more keeps the sign.
        if ((3 - k) % 2 == 1)
            rest = {rest[1], rest[0], rest[2]};
        const int l = o.corner[k] - 3;
        t.from_b[set][l][t.from_b_count[set][l]++] = {rest, o.pillar};
    }
}

constexpr PrismTables make_tables()
{
    PrismTables t{};
    t.order = {{{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
    for (int i = 0; i < 6; ++i)
        t.three[i] = split_tets(t.order[i]);
    t.twelve = union_of_splits(t);
    for (int i = 0; i < 6; ++i)
        for (const auto& o : t.three[i])
            add_from_b(t, i, o);
    for (const auto& o : t.twelve)
        add_from_b(t, kTwelve, o);
    return t;
}

} // namespace

const PrismTables prism_tables = make_tables();

int order_index(const PrismOrder& o)
{
    for (int i = 0; i < 6; ++i)
        if (tables().order[i] == o)
            return i;
    return -1;
}

std::vector<std::uint8_t> order_indices(const std::vector<PrismOrder>& orders)
{
    std::vector<std::uint8_t> indices(orders.size());
    std::transform(orders.begin(), orders.end(), indices.begin(), [](const PrismOrder& order) {
        return static_cast<std::uint8_t>(order_index(order));
    });
    return indices;
}

} // namespace vdb_shell::growth

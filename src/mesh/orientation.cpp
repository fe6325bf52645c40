// SPDX-License-Identifier: Apache-2.0

// Says which triangles have to be turned round so that neighbours agree. It goes from triangle to
// triangle over edges of exactly two triangles, each time with the only choice that agrees; if it
// comes to a triangle again and needs the other choice, the piece is one-sided like a Moebius
// strip, and none of it is turned. At edges of three or more triangles nobody knows which two
// belong together, so pieces end there. It takes linear time, in one thread and in the order of the
// triangles, so that the numbers of pieces are unique.

#include "mesh/orientation.h"

#include <array>

namespace vdb_shell
{
namespace
{

constexpr std::uint32_t kNone = UINT32_MAX;

struct Neighbour {
    std::uint32_t triangle = kNone;
    bool disagrees = false; ///< runs through the common edge the same way
};

std::vector<std::array<Neighbour, 3>> neighbours_of(const EdgeUses& uses,
                                                    std::size_t triangle_count)
{
    std::vector<std::array<Neighbour, 3>> neighbours(triangle_count);
    for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
        while (end < uses.size() && uses[end].edge == uses[begin].edge)
            ++end;
        if (end - begin != 2 || uses[begin].edge[0] == uses[begin].edge[1])
            continue;
        // Two triangles agree when they run through their common edge in opposite ways.
        const EdgeUse &a = uses[begin], &b = uses[begin + 1];
        neighbours[a.triangle][a.side] = {b.triangle, a.forward == b.forward};
        neighbours[b.triangle][b.side] = {a.triangle, a.forward == b.forward};
    }
    return neighbours;
}

} // namespace

Orientation consistent_orientation(const EdgeUses& sorted_uses, std::size_t triangle_count)
{
    const auto neighbours = neighbours_of(sorted_uses, triangle_count);
    Orientation result{std::vector<std::uint32_t>(triangle_count, kNone),
                       std::vector<char>(triangle_count, 0),
                       {}};
    std::vector<std::uint32_t> piece;
    for (std::uint32_t seed = 0; seed < triangle_count; ++seed) {
        if (result.piece_of[seed] != kNone)
            continue;
        const auto id = static_cast<std::uint32_t>(result.one_sided.size());
        bool contradiction = false;
        std::size_t turned = 0;
        piece.assign(1, seed);
        result.piece_of[seed] = id;
        for (std::size_t i = 0; i < piece.size(); ++i) {
            const std::uint32_t t = piece[i];
            turned += result.turn[t] != 0;
            for (const Neighbour& n : neighbours[t]) {
                if (n.triangle == kNone)
                    continue;
                const char wanted = static_cast<char>((result.turn[t] != 0) != n.disagrees);
                if (result.piece_of[n.triangle] == kNone) {
                    result.piece_of[n.triangle] = id;
                    result.turn[n.triangle] = wanted;
                    piece.push_back(n.triangle);
                } else {
                    contradiction |= result.turn[n.triangle] != wanted;
                }
            }
        }
        result.one_sided.push_back(contradiction);
        // Both choices agree within the piece. The smaller one changes less of what the user made,
        // and the rest of the surface was probably meant as it is.
        const bool swap = 2 * turned > piece.size();
        for (const std::uint32_t t : piece)
            result.turn[t] = static_cast<char>(!contradiction && (result.turn[t] != 0) != swap);
    }
    return result;
}

} // namespace vdb_shell

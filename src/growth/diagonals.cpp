// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell. Leaves: a valid shell with other diagonals: the tets of a turned prism are
// tested exactly first, and both prisms at an edge turn together, so that the mesh stays conforming
// (docs/theory.md, "Splits").

#include "growth/diagonals.h"

#include "core/marked.h"
#include "core/parallel.h"
#include "core/propose_in_blocks.h"
#include "growth/move_tests.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

// Relative. A diagonal that is better by less than the rounding of its score could be turned back
// and forth for ever.
constexpr double kMargin = 1e-12;

int rank_of(const PrismOrder& order, int local)
{
    return order[0] == local ? 0 : order[1] == local ? 1 : 2;
}

/// The order with local vertices l and m exchanged, or -1 where another stands between them: then
/// turning the one diagonal would close a cycle.
int exchanged(int order, int l, int m)
{
    PrismOrder o = tables().order[order];
    const int i = rank_of(o, l), j = rank_of(o, m);
    if (std::abs(i - j) != 1)
        return -1;
    std::swap(o[i], o[j]);
    return order_index(o);
}

using TetCorners = std::array<Vec3d, 4>;

TetCorners tet_corners(const GrowState& s, int f, const OrientedTet& tet)
{
    return {corner_of(s, f, tet.corner[0]), corner_of(s, f, tet.corner[1]),
            corner_of(s, f, tet.corner[2]), corner_of(s, f, tet.corner[3])};
}

double volume6_of(const TetCorners& p)
{
    return (p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0]));
}

double log_room(const GrowState& s, int f, int order)
{
    double sum = 0;
    for (const OrientedTet& tet : tables().three[order]) {
        if (dropped(s, f, tet.pillar))
            continue;
        // The same sum as the barrier's, so that a turned diagonal gives vertices room to move.
        const double v = volume6_of(tet_corners(s, f, tet));
        if (v <= 0)
            // Worse than all else, and yet the sum of two of them is a number.
            return -std::numeric_limits<double>::max() / 4;
        sum += std::log(v);
    }
    return sum;
}

/// As the mean ratio 12 (3V)^(2/3) / (sum of squared edges) of a tet, but its cube, for only what
/// is larger matters; -1 if inverted.
double cubed_mean_ratio_of(const TetCorners& p)
{
    const double v = volume6_of(p);
    if (v <= 0)
        return -1;
    double edges = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j)
            edges += (p[i] - p[j]).lengthSqr();
    return 432 * v * v / (edges * edges * edges);
}

/// Which of the twelve tets the three of each split are.
std::array<std::array<int, 3>, 6> places_in_twelve()
{
    const auto same = [](const OrientedTet& s, const OrientedTet& t) {
        return std::is_permutation(s.corner.begin(), s.corner.end(), t.corner.begin());
    };
    std::array<std::array<int, 3>, 6> place{};
    for (std::size_t order = 0; order < 6; ++order)
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 12; ++k)
                if (same(tables().three[order][i], tables().twelve[k]))
                    place[order][i] = static_cast<int>(k);
    return place;
}

/// By face and order, the cubed mean ratio of the worst tet.
std::vector<std::array<double, 6>> worst_mean_ratios(const GrowState& s)
{
    const auto place = places_in_twelve();
    std::vector<std::array<double, 6>> worst(s.mesh->faces.size());
    for_each_index(worst.size(), [&](std::size_t i) {
        const int f = static_cast<int>(i);
        std::array<double, 12> ratio{};
        for (std::size_t k = 0; k < 12; ++k)
            ratio[k] = cubed_mean_ratio_of(tet_corners(s, f, tables().twelve[k]));
        for (std::size_t order = 0; order < 6; ++order) {
            worst[i][order] = 1;
            for (std::size_t t = 0; t < 3; ++t)
                if (!dropped(s, f, tables().three[order][t].pillar))
                    worst[i][order] =
                        std::min(worst[i][order], ratio[static_cast<std::size_t>(place[order][t])]);
        }
    });
    return worst;
}

/// An edge between two prisms, seen from the corner at its smaller end of the face where it runs
/// towards the larger, and from that corner of the face across.
struct Seam {
    FaceCorner from, across;
};

/// All edges between two faces, in the order of their smaller ends.
struct Seams {
    std::vector<Seam> seam;
    std::vector<std::array<int, 3>> of_face; ///< places in the list; -1 where there is none

    explicit Seams(const Connectivity& m) : of_face(m.faces.size(), {-1, -1, -1})
    {
        seam.reserve(m.faces.size() * 3 / 2);
        // By vertex w, the face at u whose side from w ends at u: a star of thousands of faces is
        // not to be searched for each of them.
        std::vector<FaceCorner> from(m.vertices, FaceCorner{-1, 0});
        for (int u = 0; u < m.vertices; ++u) {
            for (const FaceCorner& at : star(m, u))
                if (FaceCorner& first = from[m.corner(at.face, (at.local + 2) % 3)]; first.face < 0)
                    first = at;
            for (const FaceCorner& at : star(m, u)) {
                const int w = m.corner(at.face, (at.local + 1) % 3);
                const FaceCorner other = from[w];
                if (w < u || other.face < 0)
                    continue;
                of_face[at.face][at.local] = static_cast<int>(seam.size());
                of_face[other.face][(other.local + 2) % 3] = static_cast<int>(seam.size());
                seam.push_back({at, other});
            }
            for (const FaceCorner& at : star(m, u))
                from[m.corner(at.face, (at.local + 2) % 3)] = {-1, 0};
        }
    }
};

/// The orders of both prisms with the seam's diagonal turned; -1 for one that cannot be.
std::array<int, 2> turned_orders(const GrowState& s, const Seam& seam)
{
    // One and the same edge runs one way in one prism and the other way in the other.
    return {exchanged(s.order[seam.from.face], seam.from.local, (seam.from.local + 1) % 3),
            exchanged(s.order[seam.across.face], seam.across.local, (seam.across.local + 2) % 3)};
}

void set_orders(GrowState& s, const Seam& seam, const std::array<int, 2>& orders)
{
    s.order[seam.from.face] = static_cast<std::uint8_t>(orders[0]);
    s.order[seam.across.face] = static_cast<std::uint8_t>(orders[1]);
}

/// The seam along the edge from that corner of its face to the next; none where there is no face
/// across.
std::optional<Seam> seam_from(const Connectivity& m, const FaceCorner& from)
{
    const int end = m.corner(from.face, (from.local + 1) % 3);
    for (const FaceCorner& at : star(m, m.corner(from.face, from.local)))
        if (m.corner(at.face, (at.local + 2) % 3) == end)
            return Seam{from, at};
    return std::nullopt;
}

/// The orders of both prisms with the seam's diagonal turned, if fewer of their tets fail then, and
/// no prism that was sound. Negative where not.
std::array<int, 2> mending_orders(const GrowState& s, const Seam& seam)
{
    const int f = seam.from.face, g = seam.across.face;
    const auto [f_order, g_order] = turned_orders(s, seam);
    if (f_order < 0 || g_order < 0)
        return {-1, -1};
    const int f_before = failing_tets(s, f, s.order[f]), g_before = failing_tets(s, g, s.order[g]);
    const int f_after = failing_tets(s, f, f_order), g_after = failing_tets(s, g, g_order);
    if (f_after + g_after >= f_before + g_before || (f_before == 0 && f_after > 0) ||
        (g_before == 0 && g_after > 0))
        return {-1, -1};
    return {f_order, g_order};
}

/// The edges of some prisms, three of each, and whether they are to be looked at.
struct EdgesToMend {
    std::vector<int> faces; ///< ascending
    std::vector<std::optional<Seam>> seam;
    std::vector<std::uint8_t> look;

    /// Those of the face, if it is one of these.
    void look_at(int face)
    {
        const auto at = std::lower_bound(faces.begin(), faces.end(), face);
        if (at != faces.end() && *at == face)
            std::fill_n(look.begin() + 3 * (at - faces.begin()), 3, std::uint8_t(1));
    }

    /// What a changed order of the face bears on.
    void look_around(const Connectivity& m, int face)
    {
        look_at(face);
        for (int k = 0; k < 3; ++k)
            if (const std::optional<Seam> beside = seam_from(m, {face, k}))
                look_at(beside->across.face);
    }
};

/// Of these faces, those whose tets are not all positive; their edges are looked at where turning
/// the diagonal would mend something.
EdgesToMend edges_to_mend(const GrowState& s, const std::vector<int>& faces)
{
    std::vector<std::uint8_t> fails(faces.size());
    for_each_index(
        fails.size(),
        [&](std::size_t i) { fails[i] = !split_positive(s, faces[i], s.order[faces[i]]); }, 64);
    EdgesToMend edges;
    for (const int i : marked(fails))
        edges.faces.push_back(faces[i]);
    edges.seam.resize(3 * edges.faces.size());
    edges.look.resize(edges.seam.size());
    for_each_index(
        edges.faces.size(),
        [&](std::size_t i) {
            for (int k = 0; k < 3; ++k) {
                std::optional<Seam>& seam = edges.seam[3 * i + std::size_t(k)];
                seam = seam_from(*s.mesh, {edges.faces[i], k});
                edges.look[3 * i + std::size_t(k)] = seam && mending_orders(s, *seam)[0] >= 0;
            }
        },
        64);
    return edges;
}

/// The orders of both prisms with the seam's diagonal turned, if that is better: score(f, order) of
/// both is joined by `join`. Negative where it is not.
template <class Score, class Join>
std::array<int, 2> better_orders(const GrowState& s, const Seam& seam, const Score& score,
                                 const Join& join)
{
    const int f = seam.from.face, g = seam.across.face;
    const auto [f_order, g_order] = turned_orders(s, seam);
    if (f_order < 0 || g_order < 0)
        return {-1, -1};
    const double now = join(score(f, s.order[f]), score(g, s.order[g]));
    const bool better = join(score(f, f_order), score(g, g_order)) > now + kMargin * std::abs(now);
    return better ? std::array{f_order, g_order} : std::array{-1, -1};
}

/// Passes over the seams in their order, as long as they turn diagonals and `passes` allows.
/// Turning is serial, since a turned diagonal changes what its neighbours may do; what to turn is
/// found on all threads, and anew where one of the two prisms has been turned since. A seam is
/// looked at again only once another of its two prisms has been turned.
template <class Score, class Join>
std::size_t flip_passes(GrowState& s, int passes, const Score& score, const Join& join)
{
    const Seams seams(*s.mesh);
    const auto valid_orders = [&](const Seam& seam) {
        const std::array<int, 2> orders = better_orders(s, seam, score, join);
        const bool valid = orders[0] >= 0 && split_positive(s, seam.from.face, orders[0]) &&
                           split_positive(s, seam.across.face, orders[1]);
        return valid ? orders : std::array{-1, -1};
    };
    constexpr std::size_t kBlock = 4096;
    std::vector<std::uint8_t> look(seams.seam.size(), 1);
    std::vector<std::array<int, 2>> proposed(std::min(kBlock, look.size()));
    // By face, when it was turned last: the number of a block, from 1 on.
    std::vector<std::uint32_t> turned(s.mesh->faces.size(), 0);
    std::uint32_t block = 0;
    std::size_t total = 0;
    for (int pass = 0; pass < passes; ++pass) {
        const std::size_t before = total;
        propose_in_blocks(
            look.size(), kBlock, [&] { ++block; },
            [&](std::size_t i, std::size_t slot) {
                if (look[i])
                    proposed[slot] = valid_orders(seams.seam[i]);
            },
            [&](std::size_t i, std::size_t slot) {
                if (!std::exchange(look[i], std::uint8_t(0)))
                    return;
                const Seam& seam = seams.seam[i];
                const int f = seam.from.face, g = seam.across.face;
                const bool stale = turned[f] == block || turned[g] == block;
                const std::array<int, 2> orders = stale ? valid_orders(seam) : proposed[slot];
                if (orders[0] < 0)
                    return;
                set_orders(s, seam, orders);
                ++total;
                for (const int face : {f, g}) {
                    turned[face] = block;
                    for (const int other : seams.of_face[face])
                        if (other >= 0)
                            look[other] = 1;
                }
            });
        if (total == before)
            break;
    }
    return total;
}

} // namespace

void order_by_length(GrowState& s)
{
    // The long pillar's outer end goes with the short one's inner end: of the two diagonals that is
    // the shorter one where pillars are about parallel.
    std::vector<double> length(s.b.size());
    for_each_index(length.size(), [&](std::size_t v) { length[v] = (s.b[v] - s.a[v]).length(); });
    for_each_index(s.order.size(), [&](std::size_t f) {
        const Vec3I& t = s.mesh->faces[f];
        PrismOrder order{0, 1, 2};
        std::sort(order.begin(), order.end(), [&](int l, int m) {
            return length[t[l]] != length[t[m]] ? length[t[l]] > length[t[m]] : t[l] < t[m];
        });
        s.order[f] = static_cast<std::uint8_t>(order_index(order));
    });
}

std::size_t flip_to_mend(GrowState& s, const std::vector<int>& faces)
{
    EdgesToMend edges = edges_to_mend(s, faces);
    std::size_t total = 0, before = 0;
    // Turning is serial, since a turned diagonal changes what its neighbours may do. An edge is
    // looked at again only once one of its prisms has been turned. Each flip leaves fewer failing
    // tets, so passes end.
    do {
        before = total;
        for (std::size_t i = 0; i < edges.look.size(); ++i) {
            const std::optional<Seam>& seam = edges.seam[i];
            if (!std::exchange(edges.look[i], std::uint8_t(0)) || !seam)
                continue;
            const std::array<int, 2> orders = mending_orders(s, *seam);
            if (orders[0] < 0)
                continue;
            set_orders(s, *seam, orders);
            ++total;
            edges.look_around(*s.mesh, seam->from.face);
            edges.look_around(*s.mesh, seam->across.face);
        }
    } while (total != before);
    return total;
}

std::size_t flip_for_room(GrowState& s)
{
    return flip_passes(
        s, 1, [&](int f, int order) { return log_room(s, f, order); },
        [](double f, double g) { return f + g; });
}

std::size_t flip_for_quality(GrowState& s)
{
    // Positions stay, so the ratios of all twelve tets are computed once for all passes.
    const std::vector<std::array<double, 6>> worst = worst_mean_ratios(s);
    return flip_passes(
        s, s.schedule.quality.diagonal_passes,
        [&](int f, int order) { return worst[std::size_t(f)][std::size_t(order)]; },
        [](double f, double g) { return std::min(f, g); });
}

} // namespace vdb_shell::growth

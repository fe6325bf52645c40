// SPDX-License-Identifier: Apache-2.0

// Takes: pillars prolonged from a coarser shell, or those of a refined surface; a few prisms in a
// hundred are sheared so much that a tet of theirs is inverted. Leaves: a valid shell that is
// nearly as thick. Moving inner points along the inner surface loses nothing, so it comes first;
// shortening always ends, so it comes after that (docs/theory.md, "Termination"). What was
// shortened in vain is lengthened again last.

#include "growth/mend_prolonged.h"

#include "core/marked.h"
#include "core/stage_stop.h"
#include "growth/diagonals.h"
#include "growth/lengthen_again.h"
#include "growth/move_tests.h"
#include "growth/place_pillars.h"
#include "growth/untangle.h"
#include "growth/violations.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace vdb_shell::growth
{
namespace
{

// Percent of the stage's time: on the scans boot and skull a seventh goes into what comes after.
constexpr double kShortenedAt = 85;

// Where fewer than one face in so many fails, going through all of them costs more than looking for
// each by itself: .03 s a round of 1,120,000 faces, and half of 60 rounds were of ten or fewer.
constexpr std::size_t kFewOf = 512;

/// Shortens v's pillar by its share, which grows by the factor.
void shorten(GrowState& s, int v, double cut_growth, std::vector<double>& cut)
{
    const Vec3d arm = (1 - cut[v]) * (s.b[v] - s.a[v]);
    // Little at first, for mostly it is a neighbour's move that was missing.
    cut[v] = std::min(cut_growth * cut[v], s.schedule.mend.greatest_cut);
    s.b[v] = arm.length() < shortest_pillar(s) ? s.a[v] : rounded(s.a[v] + arm);
    s.pinned[v] = s.b[v] == s.a[v];
}

/// Shortens the pillars of violating prisms; marks in `moved` what this moves. False when there is
/// nothing to shorten.
bool shorten_around(GrowState& s, const std::vector<std::uint8_t>& bad, double cut_growth,
                    std::vector<double>& cut, std::vector<std::uint8_t>& moved)
{
    moved = free_corners_of(s, bad);
    bool any = false;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!moved[v])
            continue;
        any = true;
        shorten(s, v, cut_growth, cut);
    }
    return any;
}

/// Whether so few faces are marked that they are better gone through one by one.
bool few(const GrowState& s, const std::vector<std::uint8_t>& bad)
{
    const auto count = static_cast<std::size_t>(std::count(bad.begin(), bad.end(), 1));
    return !s.mesh->has_crowds && count < bad.size() / kFewOf;
}

/// Goes on with that, from few violating prisms, until there are none. Precondition: the inner
/// tree's boxes are those of the inner triangles.
void shorten_few(GrowState& s, std::vector<int> bad, bool flips, std::vector<double>& cut)
{
    s.inner_tree.index_parents();
    while (true) {
        const std::vector<int> moved = free_corners_of(s, bad);
        if (moved.empty())
            return;
        stop_if_stage_wants();
        for (const int v : moved)
            shorten(s, v, s.schedule.mend.last_cut_growth, cut);
        const std::vector<int> changed = faces_around(s, moved);
        if (flips)
            flip_to_mend(s, changed);
        bad = violating_among(s, changed);
    }
}

/// Adds to `look` the vertices that moved and those beside them.
void look_around(const Connectivity& m, const std::vector<std::uint8_t>& moved,
                 std::vector<std::uint8_t>& look)
{
    for (int v = 0; v < m.vertices; ++v) {
        if (!moved[v])
            continue;
        look[v] = 1;
        for (const int u : neighbours(m, v))
            look[u] = 1;
    }
}

} // namespace

std::vector<double> mend_prolonged(GrowState& s, const Directions& directions,
                                   const std::vector<double>& length, const StageProgress& progress)
{
    pin_unservable(s, directions, length);
    place_pillars(s, directions, length);
    if (!s.twelve)
        order_by_length(s);
    const std::vector<Vec3d> prolonged = s.b;
    mend_placed(s, progress.part(0, kShortenedAt),
                s.twelve ? MendFrom::twelve_tets : MendFrom::chosen_tets);
    lengthen_again(s, prolonged, progress.part(kShortenedAt, 100));
    return volume6_lost(s, prolonged);
}

std::vector<std::uint8_t> mend_placed(GrowState& s, const StageProgress& progress, MendFrom from)
{
    const MendSchedule& schedule = s.schedule.mend;
    std::vector<std::uint8_t> look(s.b.size(), 1), moved(s.b.size(), 1);
    std::vector<std::uint8_t> failing(s.mesh->faces.size(), 1);
    if (from == MendFrom::failures) {
        failing = violating_faces(s, failing, true);
        look = free_corners_of(s, failing);
        moved.assign(moved.size(), 0);
    }
    const bool chosen = from == MendFrom::chosen_tets;
    std::vector<std::uint8_t> begun = look;
    std::vector<double> cut(s.b.size(), schedule.first_cut);
    for (int round = 0;; ++round) {
        // Each round has about half as much left to do as the one before.
        progress.stop_if_interrupted(100 - std::ldexp(100, -round));
        const bool first = round == 0;
        const bool moving = round < schedule.moving_rounds;
        std::vector<std::uint8_t> changed;
        const auto look_at_moved = [&] {
            changed = faces_around(s, moved);
            // Another diagonal costs no volume, and nearly every prism that fails has one that
            // does.
            if (chosen)
                flip_to_mend(s, marked(changed));
        };
        // Diagonals come before moves as well: what they put right need not move.
        if (chosen || !moving)
            look_at_moved();
        if (moving) {
            untangle(s, first ? schedule.first_sweeps : schedule.sweeps, look, moved,
                     chosen ? UntangledTets::chosen : UntangledTets::twelve);
            look_at_moved();
        }
        if (first)
            std::transform(changed.begin(), changed.end(), failing.begin(), changed.begin(),
                           std::bit_or<>());
        const std::vector<std::uint8_t> bad =
            violating_faces(s, changed, first && from != MendFrom::failures);
        if (!moving && few(s, bad)) {
            shorten_few(s, marked(bad), chosen, cut);
            break;
        }
        if (!shorten_around(s, bad, moving ? schedule.cut_growth : schedule.last_cut_growth, cut,
                            moved))
            break;
        look_around(*s.mesh, moved, look);
    }
    return begun;
}

} // namespace vdb_shell::growth

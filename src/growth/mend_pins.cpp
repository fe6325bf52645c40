// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell, some of whose vertices are pinned though the surface leaves them a pillar.
// Leaves: a valid shell with fewer of them, or the same. On the way the shell is not valid: beside
// needles two pillars, or all of a fan, may have to be put right together.

#include "growth/mend_pins.h"

#include "growth/mend_prolonged.h"
#include "growth/move_tests.h"
#include "growth/pillars_around_pin.h"
#include "growth/pins.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

/// What mending changes.
struct InnerPoints {
    std::vector<Vec3d> b;
    std::vector<std::uint8_t> pinned;
};

void put(GrowState& s, const InnerPoints& points)
{
    s.b = points.b;
    s.pinned = points.pinned;
}

/// Those whose triangles leave room for a pillar that rounding to float32 does not push out.
std::vector<int> pins_with_room(const GrowState& s, const std::vector<double>& visibility)
{
    std::vector<int> pins = pins_to_release(s, visibility);
    const auto no_room = [&](int v) {
        return view_of_surface(s, v).least * longest_release(s, v) < shortest_pillar(s);
    };
    pins.erase(std::remove_if(pins.begin(), pins.end(), no_room), pins.end());
    return pins;
}

/// Gives these vertices pillars of this share of the longest, and mends what that breaks.
void release_together(GrowState& s, const std::vector<int>& pins, double share,
                      const std::vector<double>& visibility, const StageProgress& progress)
{
    for (const int v : pins) {
        s.b[v] =
            end_within_cap(s, v, view_of_surface(s, v).direction, share * longest_release(s, v));
        s.pinned[v] = s.b[v] == s.a[v];
    }
    mend_placed(s, progress, MendFrom::failures);
    // What that has shortened to nothing is released like any other pin.
    release_last_pins(s, visibility, progress);
}

} // namespace

int mend_pins(GrowState& s, const std::vector<double>& visibility, const StageProgress& progress)
{
    const std::vector<int> pins = pins_with_room(s, visibility);
    if (pins.empty())
        return 0;
    // Long ones are moved together with those beside them; where that does not do, all of them are
    // shortened, which costs less where they are short. Which leaves fewest pins differs.
    constexpr std::array<double, 3> kShares{1, 0.25, 0.0625};
    const InnerPoints before{s.b, s.pinned};
    const std::ptrdiff_t pinned_before = count_pins(s);
    InnerPoints best = before;
    std::ptrdiff_t fewest = pinned_before;
    // No shell with as many pins as before is better.
    double best_fill = std::numeric_limits<double>::infinity();
    for (const double share : kShares) {
        put(s, before);
        release_together(s, pins, share, visibility, progress);
        const std::ptrdiff_t pinned = count_pins(s);
        const double fill = fill_of(s);
        if (pinned < fewest || (pinned == fewest && fill > best_fill)) {
            best = {s.b, s.pinned};
            fewest = pinned;
            best_fill = fill;
        }
    }
    put(s, best);
    build_inner_tree(s);
    return static_cast<int>(pinned_before - fewest);
}

} // namespace vdb_shell::growth

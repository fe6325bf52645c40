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
#include <utility>

namespace vdb_shell::growth
{
namespace
{

/// What mending changes.
struct Shape {
    std::vector<Vec3d> b;
    std::vector<std::uint8_t> pinned, order;
};

Shape shape_of(const GrowState& s)
{
    return {s.b, s.pinned, s.order};
}

void put(GrowState& s, const Shape& shape)
{
    s.b = shape.b;
    s.pinned = shape.pinned;
    s.order = shape.order;
}

std::ptrdiff_t pins_of(const Shape& shape)
{
    return std::count(shape.pinned.begin(), shape.pinned.end(), 1);
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
    build_inner_tree(s);
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
    const Shape before = shape_of(s);
    Shape best = before;
    double best_fill = 0;
    for (const double share : kShares) {
        put(s, before);
        release_together(s, pins, share, visibility, progress);
        Shape mended = shape_of(s);
        const double fill = fill_of(s);
        const std::ptrdiff_t pinned = pins_of(mended), fewest = pins_of(best);
        if (pinned < fewest || (pinned == fewest && pinned < pins_of(before) && fill > best_fill)) {
            best = std::move(mended);
            best_fill = fill;
        }
    }
    put(s, best);
    build_inner_tree(s);
    return static_cast<int>(pins_of(before) - pins_of(best));
}

} // namespace vdb_shell::growth

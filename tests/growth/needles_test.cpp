// SPDX-License-Identifier: Apache-2.0
#include "growth/grown.h"
#include "growth/sound.h"
#include "support/shapes.h"
#include "support/stacks.h"
#include "vdb_shell/growth/grow.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <vector>

namespace
{

using namespace vdb_shell;
using test::Case;
using test::case_of;
using test::expect_embedded;
using test::expect_sound;
using test::fill_of;
using test::grown;

/// Shortened until they are valid, pillars beside needles lose most of their length, and mended
/// ones much of it, how much is luck: without planar quads plates of 19 to 31 points are .91 to .97
/// full by default.
TEST(Grow, FillsPlatesOfNeedles)
{
    const std::vector<GrowOptions> ways = test::ways_to_grow();
    const std::array<double, 3> at_least{0.98, 0.97, 0.98};
    for (const int points : {19, 25, 31}) {
        const Case plate = case_of(test::needled_plate(points));
        for (std::size_t i = 0; i < at_least.size(); ++i) {
            const GrowResult full = grown(plate, ways[i]);
            EXPECT_GE(fill_of(full.shell), at_least[i]) << points << ", " << i;
            expect_sound(full, ways[i]);
            expect_embedded(full.shell);
        }
    }
}

/// Without planar quads rounds on such plates end in a jam: these shells are .84, .74 and .98 full.
/// Under the three-tet test, where it takes more needles, most shells need the very diagonals that
/// they have come to.
TEST(Grow, GoesOnFromAJammedShell)
{
    for (GrowOptions options : test::ways_to_grow()) {
        options.schedule.planar.most_rounds = 0;
        const bool twelve = prism_test_of(options) == PrismTest::twelve_tets;
        for (const int points : twelve ? std::vector<int>{22, 28} : std::vector<int>{56}) {
            const Case plate = case_of(test::needled_plate(points));
            options.schedule.restarts.most = 0;
            const GrowResult jammed = grown(plate, options);
            ASSERT_LT(fill_of(jammed.shell), 0.99);
            options.schedule.restarts.most = 3;
            const GrowResult on = grown(plate, options);
            EXPECT_GT(fill_of(on.shell), fill_of(jammed.shell) + 1e-3);
            expect_sound(on, options);
            expect_embedded(on.shell);
        }
    }
}

/// Restarts of the first start, which do not fill this plate, do not stand in the way of a better
/// one.
TEST(Grow, TriesOtherStartsWhereRestartsAreNotEnough)
{
    const Case plate = case_of(test::needled_plate(25));
    GrowOptions options;
    options.schedule.restarts.before_others_from = 0;
    const GrowResult full = grown(plate, options);
    EXPECT_GE(fill_of(full.shell), 0.97);
    expect_sound(full, options);
    options.schedule.planar.most_rounds = 0;
    const double without = fill_of(grown(plate, options).shell);
    EXPECT_LT(without, 0.97);
    options.schedule.restarts.most = 0;
    EXPECT_GT(without, fill_of(grown(plate, options).shell));
}

/// What comes over coarser surfaces loses most of what it has beside needles: without lines of its
/// own these shells are .82, .59 and .66 full.
TEST(Grow, BeginsALargePlateOfNeedlesFromLines)
{
    const Case plate = case_of(test::needled_plate(20));
    for (GrowOptions options : test::ways_to_grow()) {
        options.coarse_from = 100;
        options.schedule.multilevel.coarsest_triangles = 100;
        options.schedule.multilevel.most_coarsest_triangles = 200; // so that this is a large one
        ASSERT_FALSE(coarse_levels(plate.mesh, options).empty());
        const GrowResult full = grown(plate, options);
        EXPECT_GE(fill_of(full.shell), 0.9);
        expect_sound(full, options);
    }
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "growth/stops.h"

#include "growth/grown.h"
#include "support/stacks.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace
{

using namespace vdb_shell;

// A third of the vertices have a bound, one has no room at all, and the others are stopped by their
// prisms and by each other.
TEST(Stops, ThoseThatNeedNoStepAreToldUnasked)
{
    test::Case c = test::case_of(test::bumpy_sphere(3));
    for (std::size_t v = 0; v < c.cap.size(); v += 3)
        c.cap[v] = 0.05;
    c.cap[5] = 0;
    for (GrowOptions options : test::ways_to_grow()) {
        const GrowResult asked = test::grown(c, options);
        options.stop_reasons = false;
        const GrowResult unasked = test::grown(c, options);
        EXPECT_EQ(unasked.shell.inner, asked.shell.inner);
        EXPECT_EQ(unasked.split.order, asked.split.order);
        std::size_t bound = 0, others = 0;
        for (std::size_t v = 0; v < c.cap.size(); ++v) {
            const StopReason reason = asked.shell.stop[v];
            const bool plain = reason == StopReason::pinned || reason == StopReason::thickness;
            EXPECT_NE(reason, StopReason::not_asked) << v;
            EXPECT_EQ(unasked.shell.stop[v], plain ? reason : StopReason::not_asked) << v;
            bound += reason == StopReason::thickness;
            others += !plain;
        }
        EXPECT_EQ(unasked.shell.stop[5], StopReason::pinned);
        EXPECT_GT(bound, c.cap.size() / 10);
        EXPECT_GT(others, c.cap.size() / 10);
    }
}

} // namespace

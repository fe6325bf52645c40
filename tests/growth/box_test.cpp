// SPDX-License-Identifier: Apache-2.0
#include "growth/box.h"

#include "core/counter_random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vdb_shell::growth
{
namespace
{

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

TEST(Box, InFloatsHoldsAllOfItAndHardlyMore)
{
    const CounterRandom random(3);
    for (std::uint64_t i = 0; i < 1000; ++i) {
        Box box;
        for (std::uint64_t corner = 0; corner < 2; ++corner) {
            const std::uint64_t from = 6 * i + 3 * corner;
            box.add(Vec3d(random.unit(from) - 0.5, 1e-6 * random.unit(from + 1),
                          1e6 * random.unit(from + 2)));
        }
        const FloatBox floats = float_box(box);
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(double(floats.lo[k]), box.lo[k]);
            EXPECT_GE(double(floats.hi[k]), box.hi[k]);
            EXPECT_GT(double(std::nextafter(floats.lo[k], kFloatInfinity)), box.lo[k]);
            EXPECT_LT(double(std::nextafter(floats.hi[k], -kFloatInfinity)), box.hi[k]);
        }
    }
}

TEST(Box, OfFloatsIsThatBox)
{
    Box box;
    box.add(Vec3d(0.5, -2.0, 3.0));
    box.add(Vec3d(1.5, -1.0, 3.0));
    const FloatBox floats = float_box(box);
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(double(floats.lo[k]), box.lo[k]);
        EXPECT_EQ(double(floats.hi[k]), box.hi[k]);
    }
}

} // namespace
} // namespace vdb_shell::growth

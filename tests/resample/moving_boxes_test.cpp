// SPDX-License-Identifier: Apache-2.0
#include "resample/moving_boxes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace vdb_shell::test
{
namespace
{

FloatBox box_at(const openvdb::Vec3s& low, const openvdb::Vec3s& size)
{
    FloatBox box = FloatBox::around(low);
    box.add(low + size);
    return box;
}

TEST(MovingBoxes, FindsWhatComparingAllBoxesFindsWhileTheyComeAndGo)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-1, 1), power(-12, 1);
    // Points, needles and boxes of a thousandth to twice the size of the whole.
    const auto any_box = [&] {
        const float size = std::exp2(power(random));
        return box_at({place(random), place(random), place(random)},
                      {size, size * std::abs(place(random)), power(random) < -10 ? 0 : size});
    };
    MovingBoxes grid;
    std::vector<FloatBox> boxes;
    std::vector<char> there;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        boxes.push_back(any_box());
        there.push_back(1);
        grid.insert(i, boxes[i]);
        if (i % 3 == 2) {
            grid.remove(i / 2);
            there[i / 2] = 0;
            if (i % 2 == 0) {
                boxes[i / 2] = any_box();
                grid.insert(i / 2, boxes[i / 2]);
                there[i / 2] = 1;
            }
        }
        if (i % 50 != 0)
            continue;
        const FloatBox query = any_box();
        std::vector<std::uint32_t> found, expected;
        grid.overlaps(query, found);
        std::sort(found.begin(), found.end());
        for (std::uint32_t k = 0; k <= i; ++k)
            if (there[k] && boxes[k].overlaps(query))
                expected.push_back(k);
        EXPECT_EQ(found, expected) << i;
    }
}

} // namespace
} // namespace vdb_shell::test

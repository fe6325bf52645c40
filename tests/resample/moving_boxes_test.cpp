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

TEST(MovingBoxes, FindWhatComparingAllBoxesFindsWhileTheyComeAndGo)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-1, 1), power(-12, 1);
    // Points, needles and boxes of a thousandth to twice the size of the whole.
    const auto any_box = [&] {
        const float size = std::exp2(power(random));
        return box_at({place(random), place(random), place(random)},
                      {size, size * std::abs(place(random)), power(random) < -10 ? 0 : size});
    };
    MovingBoxes tree;
    std::vector<FloatBox> boxes;
    for (int i = 0; i < 200; ++i)
        boxes.push_back(any_box());
    std::vector<char> there(boxes.size(), 1);
    tree.build(boxes);
    // More come at first and more go later, each often enough for the tree to be built anew.
    for (std::uint32_t step = 0; step < 6000; ++step) {
        const std::uint32_t i = std::uint32_t(random()) % (step < 1500 ? 1000U : 2000U);
        if (i >= boxes.size()) {
            boxes.resize(i + 1);
            there.resize(i + 1, 0);
        }
        if (there[i])
            tree.remove(i);
        there[i] = step < 4000 ? !there[i] || step % 2 == 0 : 0;
        if (there[i]) {
            boxes[i] = any_box();
            tree.insert(i, boxes[i]);
        }
        if (step % 50 != 0)
            continue;
        const FloatBox query = any_box();
        std::vector<std::uint32_t> found, expected;
        tree.overlaps(query, found);
        std::sort(found.begin(), found.end());
        for (std::uint32_t k = 0; k < boxes.size(); ++k)
            if (there[k] && boxes[k].overlaps(query))
                expected.push_back(k);
        EXPECT_EQ(found, expected) << step;
    }
}

} // namespace
} // namespace vdb_shell::test

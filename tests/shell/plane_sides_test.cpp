// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/plane_sides.h"

#include "core/counter_random.h"
#include "core/orient3d_filter.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using openvdb::Vec3d;
using vdb_shell::CounterRandom;
using vdb_shell::growth::PlaneSides;

/// On a coarse lattice, so that many points lie in planes.
Vec3d lattice_point(const CounterRandom& random, std::uint64_t id)
{
    Vec3d p;
    for (std::uint64_t k = 0; k < 3; ++k)
        p[static_cast<int>(k)] = 0.25 * static_cast<double>(random.below(3 * id + k, 5));
    return p;
}

TEST(PlaneSides, HoldPointsTogetherThatThePlaneFilterHoldsToOneSide)
{
    int open = 0, decided = 0;
    for (std::size_t points = 1; points <= PlaneSides::kMostPoints; ++points) {
        const CounterRandom random(points);
        const std::size_t planes = 1 + points % PlaneSides::kMostPlanes;
        std::vector<Vec3d> point;
        std::vector<std::array<Vec3d, 3>> plane;
        PlaneSides sides;
        for (std::size_t i = 0; i < points; ++i) {
            point.push_back(lattice_point(random, i));
            sides.add_point(point.back());
        }
        for (std::size_t k = 0; k < planes; ++k) {
            plane.push_back({lattice_point(random, 100 + 3 * k), lattice_point(random, 101 + 3 * k),
                             lattice_point(random, 102 + 3 * k)});
            sides.add_plane(plane.back());
        }
        sides.compute();
        for (std::size_t k = 0; k < planes; ++k) {
            const vdb_shell::exact::PlaneFilter filter(plane[k][0], plane[k][1], plane[k][2]);
            for (std::size_t i = 0; i < points; ++i)
                for (std::size_t j = 0; j <= i; ++j) {
                    const int side = filter.side(point[i]);
                    const bool together = side != 0 && filter.side(point[j]) == side;
                    const std::uint32_t both = 1U << i | 1U << j;
                    EXPECT_EQ(sides.on_one_side(k, both), together) << k << " " << i << " " << j;
                    ++(together ? decided : open);
                }
        }
    }
    EXPECT_GT(open, 100);
    EXPECT_GT(decided, 1000);
}

} // namespace

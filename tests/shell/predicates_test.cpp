// SPDX-License-Identifier: Apache-2.0
#include "shell/grow/predicates.h"

#include "core/counter_random.h"

#include <gtest/gtest.h>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::growth;

/// On a lattice so coarse that many triangles lie in one plane or have corners on each other.
Vec3d lattice_point(const CounterRandom& random, std::uint64_t id, std::uint32_t steps)
{
    Vec3d p;
    for (std::uint64_t k = 0; k < 3; ++k)
        p[static_cast<int>(k)] = 0.125 * static_cast<double>(random.below(3 * id + k, steps));
    return p;
}

/// If they meet elsewhere, an edge that does not hold the common corner does.
bool meet_elsewhere(const Vec3d& corner, const std::array<Vec3d, 2>& s,
                    const std::array<Vec3d, 2>& t)
{
    const auto triangle = [&](const std::array<Vec3d, 2>& p) {
        return exact::Triangle{Vec3s(corner), Vec3s(p[0]), Vec3s(p[1])};
    };
    return exact::segment_touches_triangle(Vec3s(s[0]), Vec3s(s[1]), triangle(t)) ||
           exact::segment_touches_triangle(Vec3s(t[0]), Vec3s(t[1]), triangle(s));
}

bool flat(const Vec3d& corner, const std::array<Vec3d, 2>& other)
{
    return exact::collinear(Vec3s(corner), Vec3s(other[0]), Vec3s(other[1]));
}

TEST(ApartButForCorner, IsNeverSaidOfTrianglesThatMeetElsewhere)
{
    int apart = 0, meeting = 0;
    for (const std::uint32_t steps : {3U, 5U, 1000U}) {
        const CounterRandom random(steps);
        for (std::uint64_t i = 0; i < 20000; ++i) {
            const auto point = [&](std::uint64_t k) {
                return lattice_point(random, 5 * i + k, steps);
            };
            const std::array<Vec3d, 2> s{point(1), point(2)}, t{point(3), point(4)};
            if (flat(point(0), s) || flat(point(0), t))
                continue;
            const bool meet = meet_elsewhere(point(0), s, t);
            meeting += meet;
            if (!apart_but_for_corner(point(0), s, t))
                continue;
            ++apart;
            ASSERT_FALSE(meet) << steps << " " << i;
        }
    }
    EXPECT_GT(apart, 5000);
    EXPECT_GT(meeting, 5000);
}

TEST(ApartButForCorner, IsSaidOfMostThatLieInOneFan)
{
    // Every second pair of the triangles around a shallow cone's top.
    constexpr int kAround = 7;
    const auto rim = [](int i) {
        const double angle = 2 * M_PI * i / kAround;
        return rounded(Vec3d(std::cos(angle), std::sin(angle), 0.01 * (i % 2)));
    };
    for (int i = 0; i < kAround; ++i)
        for (int skip = 2; skip + 1 < kAround; ++skip) {
            const int j = i + skip;
            EXPECT_TRUE(apart_but_for_corner({0, 0, 0.05}, {rim(i), rim(i + 1)},
                                             {rim(j % kAround), rim((j + 1) % kAround)}))
                << i << " " << j;
        }
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "core/star_sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3s;
using Triangles = std::vector<std::array<Vec3s, 3>>;

/// Turned inward: a point inside makes a positive tet with each.
Triangles faces_of_a_tet(const Vec3s& at)
{
    const Vec3s a = at, b = at + Vec3s(1, 0, 0), c = at + Vec3s(0, 1, 0), d = at + Vec3s(0, 0, 1);
    return {{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}};
}

Triangles turned_round(Triangles triangles)
{
    for (auto& triangle : triangles)
        std::swap(triangle[0], triangle[1]);
    return triangles;
}

TEST(StarSight, APointInsideSeesAllFacesOfATetAndNoneSeesThemFromOutside)
{
    for (const float far : {0.0f, 1.0f, 4096.0f}) {
        const Triangles faces = faces_of_a_tet({far, -far, far});
        EXPECT_TRUE(exact::a_point_sees(faces)) << far;
        EXPECT_FALSE(exact::a_point_sees(turned_round(faces))) << far;
    }
}

TEST(StarSight, BetweenTwoPlanesThereIsAPointWhileTheyFaceEachOther)
{
    const Triangles floor{{Vec3s(0, 0, 0), Vec3s(1, 0, 0), Vec3s(0, 1, 0)}};
    for (const float height : {1.0f, 1e-6f, 0.0f, -1e-6f}) {
        Triangles both = floor;
        both.push_back({Vec3s(0, 0, height), Vec3s(0, 1, height), Vec3s(1, 0, height)});
        EXPECT_EQ(exact::a_point_sees(both), height > 0) << height;
    }
}

TEST(StarSight, NoTrianglesAreSeenFromAnywhereAndOneWithoutAreaFromNowhere)
{
    EXPECT_TRUE(exact::a_point_sees({}));
    EXPECT_FALSE(exact::a_point_sees({{Vec3s(0, 0, 0), Vec3s(1, 1, 1), Vec3s(2, 2, 2)}}));
}

} // namespace
} // namespace vdb_shell

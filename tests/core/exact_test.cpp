// SPDX-License-Identifier: Apache-2.0
#include "core/exact.h"

#include "support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

TEST(orient3d, is_positive_for_a_right_handed_corner)
{
    EXPECT_EQ(exact::orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
    EXPECT_EQ(exact::orient3d({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}), -1);
    EXPECT_EQ(exact::orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {7, 9, 0}), 0);
}

TEST(orient3d, is_right_one_step_off_a_slanted_plane)
{
    // d lies on the plane x + y + z = 3 * 2^20 but for the last bit of one coordinate.
    const float big = 1048576.0F;
    const Vec3s a(3 * big, 0, 0), b(0, 3 * big, 0), c(0, 0, 3 * big), on(big, big, big);
    EXPECT_EQ(exact::orient3d(a, b, c, on), 0);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3s above = on, below = on;
        above[axis] = std::nextafter(big, 2 * big);
        below[axis] = std::nextafter(big, 0.0F);
        EXPECT_EQ(exact::orient3d(a, b, c, above), 1);
        EXPECT_EQ(exact::orient3d(a, b, c, below), -1);
        EXPECT_EQ(exact::orient3d(b, a, c, above), -1);
    }
}

TEST(orient3d, is_right_where_products_underflow)
{
    const float tiny = std::numeric_limits<float>::denorm_min();
    EXPECT_EQ(exact::orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
    EXPECT_EQ(exact::orient3d({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {tiny, tiny, -tiny}), -1);
    const float huge = std::numeric_limits<float>::max();
    EXPECT_EQ(exact::orient3d({-huge, -huge, -huge}, {huge, 0, 0}, {0, huge, 0}, {0, 0, huge}), 1);
}

TEST(turn_along, is_that_of_the_other_two_axes_and_right_at_the_last_bit)
{
    const Vec3s a(1, 2, 3), b(2, 3, 4);
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        Vec3s c = a;
        c[v] += 1;
        EXPECT_EQ(exact::turn_along(axis, a, b, c), 1);
        EXPECT_EQ(exact::turn_along(axis, b, a, c), -1);
        c = {5, 6, 7}; // on the line through a and b
        EXPECT_EQ(exact::turn_along(axis, a, b, c), 0);
        c[axis] = 100;
        EXPECT_EQ(exact::turn_along(axis, a, b, c), 0);
        c[u] = std::nextafter(c[u], 100.0F);
        EXPECT_EQ(exact::turn_along(axis, a, b, c), -1);
    }
}

TEST(collinear, allows_no_tolerance)
{
    const Vec3s a(0, 0, 0), b(1, 1, 1);
    EXPECT_TRUE(exact::collinear(a, b, {3, 3, 3}));
    EXPECT_TRUE(exact::collinear(a, a, b));
    EXPECT_FALSE(exact::collinear(a, b, {3, 3, std::nextafter(3.0F, 4.0F)}));
}

bool touch(const std::vector<Vec3s>& points, const Vec3I& first, const Vec3I& second)
{
    const bool result = exact::triangles_touch(points, first, second);
    // The answer may depend neither on the order nor on the corner that comes first.
    EXPECT_EQ(exact::triangles_touch(points, second, first), result);
    EXPECT_EQ(exact::triangles_touch(points, {first[1], first[2], first[0]},
                                     {second[0], second[2], second[1]}),
              result);
    return result;
}

TEST(triangles_touch, knows_triangles_without_a_common_corner)
{
    const std::vector<Vec3s> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1},
                                    {9, 9, 1}, {1, 1, 0}, {0, 0, 1}, {4, 0, 1},  {4, 4, 0},
                                    {2, 2, 0}, {2, 1, 0}, {1, 2, 0}};
    EXPECT_TRUE(touch(points, {0, 1, 2}, {3, 4, 5})) << "an edge through the face";
    EXPECT_TRUE(touch(points, {0, 1, 2}, {6, 4, 5})) << "a corner in the face";
    EXPECT_FALSE(touch(points, {0, 1, 2}, {4, 7, 8})) << "parallel, above";
    EXPECT_TRUE(touch(points, {0, 1, 2}, {9, 10, 5})) << "a corner on an edge";
    EXPECT_TRUE(touch(points, {0, 1, 2}, {6, 11, 12})) << "coplanar, one within the other";
}

TEST(triangles_touch, allows_what_neighbours_share)
{
    const std::vector<Vec3s> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, -4, 0}, {4, -4, 0},
                                    {0, 0, 4}, {1, 1, 0}, {2, 2, 4}, {2, 1, -4}, {1, 2, 4}};
    EXPECT_FALSE(touch(points, {0, 1, 2}, {1, 0, 3})) << "coplanar over an edge";
    EXPECT_FALSE(touch(points, {0, 1, 2}, {1, 0, 5})) << "at a right angle over an edge";
    EXPECT_TRUE(touch(points, {0, 1, 2}, {1, 0, 6})) << "folded flat over an edge";
    EXPECT_FALSE(touch(points, {0, 1, 2}, {0, 4, 3})) << "coplanar at a corner";
    EXPECT_TRUE(touch(points, {0, 1, 2}, {0, 8, 9})) << "through the face from a corner";
    EXPECT_TRUE(touch(points, {0, 1, 2}, {0, 6, 5})) << "along the face from a corner";
    EXPECT_TRUE(touch(points, {0, 1, 2}, {2, 0, 1})) << "the same";
}

/// What triangles_touch says by its definition, without looking at projections.
bool touch_by_definition(const std::vector<Vec3s>& points, const Vec3I& first, const Vec3I& second)
{
    std::vector<std::uint32_t> shared, p, q;
    for (int k = 0; k < 3; ++k) {
        const bool in_second =
            first[k] == second[0] || first[k] == second[1] || first[k] == second[2];
        (in_second ? shared : p).push_back(first[k]);
        if (second[k] != first[0] && second[k] != first[1] && second[k] != first[2])
            q.push_back(second[k]);
    }
    const auto corners = [&](const Vec3I& t) {
        return exact::Triangle{points[t[0]], points[t[1]], points[t[2]]};
    };
    if (shared.empty())
        return exact::triangles_touch(corners(first), corners(second));
    if (shared.size() == 1)
        return exact::segment_touches_triangle(points[p[0]], points[p[1]], corners(second)) ||
               exact::segment_touches_triangle(points[q[0]], points[q[1]], corners(first));
    return shared.size() == 3 ||
           (exact::orient3d(points[first[0]], points[first[1]], points[first[2]], points[q[0]]) ==
                0 &&
            exact::on_one_side(points[shared[0]], points[shared[1]], points[p[0]], points[q[0]]));
}

TEST(apart_in_projection, is_never_said_of_triangles_that_touch)
{
    // Few places, so that most pairs are in special position; the lowest layer is a plane.
    for (const int height : {1, 2}) {
        std::vector<Vec3s> points;
        for (int z = 0; z < height; ++z)
            for (int y = 0; y < 3; ++y)
                for (int x = 0; x < 3; ++x)
                    points.emplace_back(float(x), float(y), 0.5F * float(z) + 0.25F * float(x));
        std::vector<Vec3I> triangles;
        const auto count = std::uint32_t(points.size());
        for (std::uint32_t a = 0; a < count; ++a)
            for (std::uint32_t b = a + 1; b < count; ++b)
                for (std::uint32_t c = b + 1; c < count; ++c)
                    if ((a + b + c) % std::uint32_t(height * height) == 0 &&
                        !exact::collinear(points[a], points[b], points[c]))
                        triangles.emplace_back(a, b, c);
        std::size_t apart = 0, touching = 0, missed = 0;
        for (const Vec3I& s : triangles)
            for (const Vec3I& t : triangles) {
                if (s == t)
                    continue;
                const bool said = exact::apart_in_projection(points, s, t);
                const bool touch = touch_by_definition(points, s, t);
                EXPECT_FALSE(said && touch) << s << t;
                EXPECT_EQ(exact::triangles_touch(points, s, t), touch) << s << t;
                apart += said;
                touching += touch;
                missed += !said && !touch;
            }
        EXPECT_GT(apart, 100U);
        EXPECT_GT(touching, 100U);
        // In one plane the line of an edge tells nearly all.
        if (height == 1) {
            EXPECT_LT(10 * missed, apart);
        }
    }
}

TEST(crossing_above, counts_shared_edges_and_corners_once)
{
    // Straight above and below corners and edges of a gridded box, and between them.
    const TriangleMesh box = test::gridded_box(openvdb::Vec3d(0), openvdb::Vec3d(4), 4);
    for (int x = -2; x <= 10; ++x)
        for (int y = -2; y <= 10; ++y)
            for (int z = -1; z <= 9; z += 2) {
                const Vec3s point(0.5F * float(x), 0.5F * float(y), 0.5F * float(z));
                const bool side = point[0] == 0 || point[0] == 4 || point[1] == 0 || point[1] == 4;
                int crossings = 0, winding = 0;
                bool on_surface = false;
                for (const Vec3I& t : box.triangles) {
                    const int up = exact::crossing_above(point, box.points[t[0]], box.points[t[1]],
                                                         box.points[t[2]], on_surface);
                    crossings += up != 0;
                    winding += up;
                }
                const bool in_square =
                    point[0] >= 0 && point[0] <= 4 && point[1] >= 0 && point[1] <= 4;
                const bool within = point[2] > 0 && point[2] < 4;
                EXPECT_EQ(on_surface, in_square && side && within) << point;
                if (!on_surface) {
                    EXPECT_EQ(crossings % 2 == 1, in_square && within) << point;
                    EXPECT_EQ(winding, in_square && within ? 1 : 0) << point;
                }
            }
}

} // namespace
} // namespace vdb_shell

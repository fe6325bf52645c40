// SPDX-License-Identifier: Apache-2.0
#include "core/triangle_pairs.h"

#include "core/exact.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;
using Pairs = std::vector<std::array<std::uint32_t, 2>>;

struct Soup {
    std::vector<Vec3s> points;
    std::vector<Vec3I> triangles;

    void add(const Vec3s& a, const Vec3s& b, const Vec3s& c)
    {
        const auto first = std::uint32_t(points.size());
        points.insert(points.end(), {a, b, c});
        triangles.emplace_back(first, first + 1, first + 2);
    }
    bool touch(std::uint32_t i, std::uint32_t j) const
    {
        return exact::triangles_touch(points, triangles[i], triangles[j]);
    }
    Pairs found() const
    {
        return overlapping_triangles(points, triangles,
                                     [&](std::uint32_t i, std::uint32_t j) { return touch(i, j); });
    }
};

Pairs by_brute_force(const Soup& soup)
{
    Pairs pairs;
    for (std::uint32_t i = 0; i < soup.triangles.size(); ++i)
        for (std::uint32_t j = i + 1; j < soup.triangles.size(); ++j)
            if (soup.touch(i, j))
                pairs.push_back({i, j});
    return pairs;
}

/// Triangles of all widths about lines of whole numbers: many touch in one point only, and tips
/// stand over both ends and the middle of the longest edge.
Soup random_needles(std::size_t count, float offset)
{
    std::mt19937 random(5);
    std::uniform_int_distribution<int> place(-8, 8), power(0, 24);
    const auto point = [&] {
        return Vec3s(float(place(random)), float(place(random)), float(place(random)));
    };
    Soup soup;
    while (soup.triangles.size() < count) {
        const Vec3s a = point(), b = point(), c = point();
        const Vec3s middle = a + 0.125F * float(place(random) + 8) * 0.5F * (b - a);
        const Vec3s tip = middle + std::ldexp(1.0F, -power(random)) * (c - middle);
        const Vec3s move(offset);
        if (!exact::collinear(a + move, b + move, tip + move))
            soup.add(a + move, b + move, tip + move);
    }
    return soup;
}

TEST(overlapping_triangles, miss_no_pair_with_a_common_point)
{
    for (const float offset : {0.0F, 1000.0F}) {
        const Soup soup = random_needles(700, offset);
        const Pairs pairs = by_brute_force(soup);
        EXPECT_GT(pairs.size(), 300u);
        EXPECT_EQ(soup.found(), pairs) << offset;
    }
}

TEST(overlapping_triangles, of_those_left_out_none_is_asked)
{
    const Soup soup = random_needles(100, 0);
    std::vector<char> left_out(100);
    for (std::size_t t = 0; t < 100; t += 3)
        left_out[t] = 1;
    const Pairs pairs = overlapping_triangles(
        soup.points, soup.triangles,
        [&](std::uint32_t i, std::uint32_t j) {
            EXPECT_FALSE(left_out[i] || left_out[j]);
            return true;
        },
        nullptr, left_out);
    EXPECT_FALSE(pairs.empty());
}

/// How many pairs of two cones over one rim are asked about that do not share an apex.
std::size_t asked_across(std::uint32_t half)
{
    Soup cones;
    for (std::uint32_t i = 0; i < half; ++i) {
        const double angle = 2 * M_PI * i / half;
        cones.points.emplace_back(float(std::cos(angle)), float(std::sin(angle)), 0.0F);
    }
    cones.points.emplace_back(0.0F, 0.0F, 1.0F);
    cones.points.emplace_back(0.0F, 0.0F, -1.0F);
    for (const std::uint32_t apex : {half, half + 1})
        for (std::uint32_t i = 0; i < half; ++i)
            cones.triangles.emplace_back(i, (i + 1) % half, apex);
    std::atomic<std::size_t> asked{0};
    overlapping_triangles(cones.points, cones.triangles, [&](std::uint32_t i, std::uint32_t j) {
        asked += (i < half) != (j < half);
        return false;
    });
    return asked;
}

TEST(overlapping_triangles, needles_are_asked_about_where_they_are)
{
    // Whole boxes overlap for a quarter of all pairs and more.
    EXPECT_LT(asked_across(2000), 2000u * 2000u / 25);
}

} // namespace
} // namespace vdb_shell

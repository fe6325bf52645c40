// SPDX-License-Identifier: Apache-2.0
#include "core/triangle_pairs.h"

#include "core/exact.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
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

/// Large oblique triangles close behind one another, whose corners are off their planes by up to
/// `uneven` times the distance between two.
Soup layers(std::size_t count, float uneven)
{
    std::mt19937 random(9);
    std::uniform_real_distribution<float> off(-uneven, uneven);
    Soup soup;
    const auto corner = [&](float x, float y, std::size_t layer) {
        return Vec3s(x, y, 700 - x - y + float(layer) + off(random));
    };
    for (std::size_t i = 0; i < count; ++i)
        soup.add(corner(0, 0, i), corner(1000, 200, i), corner(300, 900, i));
    return soup;
}

TEST(overlapping_triangles, miss_no_pair_of_layers_that_cross)
{
    const Soup soup = layers(1500, 1);
    const Pairs pairs = by_brute_force(soup);
    EXPECT_GT(pairs.size(), 300u);
    EXPECT_EQ(soup.found(), pairs);
}

// Of layers whose boxes all overlap, small triangles that cross them or lie between them. A layer's
// box meets more layers than are looked at one by one, or few enough.
TEST(overlapping_triangles, miss_no_pair_of_a_crowd_and_others)
{
    for (const std::size_t count : {900U, 1500U}) {
        Soup soup = layers(count, 0.25F);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> place(300, 400), depth(0, float(count));
        for (int i = 0; i < 400; ++i) {
            const float x = place(random), y = place(random), z = 700 - x - y + depth(random);
            const float height = 0.01F * float(i);
            soup.add(Vec3s(x, y, z), Vec3s(x + 1, y, z - 1), Vec3s(x, y, z + height));
        }
        const Pairs pairs = by_brute_force(soup);
        EXPECT_GT(pairs.size(), 300u);
        EXPECT_EQ(soup.found(), pairs) << count;
    }
}

/// Triangles that share corners and edges by index, up to all of them: around point 0, or around
/// the edge of points 0 and 1, with other points in few places, so that many touch.
Soup random_stars(std::size_t count, int reach, bool around_an_edge)
{
    std::mt19937 random(7);
    std::uniform_int_distribution<int> place(-reach, reach);
    Soup soup;
    soup.points = {Vec3s(0.0F), Vec3s(1.0F, 2.0F, 0.0F)};
    for (int i = 0; i < 60; ++i)
        soup.points.emplace_back(float(place(random)), float(place(random)), float(place(random)));
    std::uniform_int_distribution<std::uint32_t> point(1, std::uint32_t(soup.points.size() - 1));
    while (soup.triangles.size() < count) {
        const std::uint32_t a = around_an_edge ? 1 : point(random), b = point(random);
        if (!exact::collinear(soup.points[0], soup.points[a], soup.points[b]))
            soup.triangles.emplace_back(0, a, b);
    }
    return soup;
}

TEST(overlapping_triangles, miss_no_contact_around_a_corner_or_an_edge)
{
    for (const int reach : {2, 6, 100})
        for (const bool around_an_edge : {false, true}) {
            const Soup soup = random_stars(120, reach, around_an_edge);
            EXPECT_EQ(soup.found(), by_brute_force(soup)) << reach << around_an_edge;
        }
}

/// Points on a circle about the z-axis.
void add_rim(Soup& soup, std::uint32_t count)
{
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count;
        soup.points.emplace_back(float(std::cos(angle)), float(std::sin(angle)), 0.0F);
    }
}

/// The two ends of the axis, behind the rim.
void add_ends_of_axis(Soup& soup)
{
    soup.points.emplace_back(0.0F, 0.0F, 1.0F);
    soup.points.emplace_back(0.0F, 0.0F, -1.0F);
}

std::size_t asked(const Soup& soup)
{
    std::atomic<std::size_t> count{0};
    overlapping_triangles(soup.points, soup.triangles,
                          [&](std::uint32_t, std::uint32_t) { return ++count, false; });
    return count;
}

Soup two_cones(std::uint32_t half)
{
    Soup cones;
    add_rim(cones, half);
    add_ends_of_axis(cones);
    for (const std::uint32_t apex : {half, half + 1})
        for (std::uint32_t i = 0; i < half; ++i)
            cones.triangles.emplace_back(i, (i + 1) % half, apex);
    return cones;
}

Soup pages_of_an_edge(std::uint32_t count)
{
    Soup pages;
    add_rim(pages, count);
    add_ends_of_axis(pages);
    for (std::uint32_t i = 0; i < count; ++i)
        pages.triangles.emplace_back(i, count, count + 1);
    return pages;
}

TEST(overlapping_triangles, few_are_asked_about_where_none_touch)
{
    // Whole boxes overlap for a quarter of all pairs and more.
    for (const std::uint32_t n : {2000U, 8000U}) {
        EXPECT_LT(asked(two_cones(n / 2)), 50 * n);
        EXPECT_LT(asked(pages_of_an_edge(n)), 50 * n);
        EXPECT_LT(asked(layers(n, 0.25F)), 50 * n);
    }
}

/// Pages of an edge, each with an edge of its own, so that all touch along it.
Soup parted_pages(std::uint32_t count)
{
    Soup pages;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double angle = 2 * M_PI * i / count;
        pages.add(Vec3s(0, 0, -1), Vec3s(0, 0, 1),
                  Vec3s(float(std::cos(angle)), float(std::sin(angle)), 0));
    }
    return pages;
}

FoundPairs found_in(const Soup& soup, const PairBounds& wanted)
{
    return overlapping_triangles(
        soup.points, soup.triangles,
        [&](std::uint32_t i, std::uint32_t j) { return soup.touch(i, j); }, wanted);
}

TEST(overlapping_triangles, of_a_crowd_that_all_meets_some_are_listed_if_so_wanted)
{
    PairBounds wanted;
    wanted.limited = true;
    const FoundPairs few = found_in(parted_pages(1400), wanted);
    EXPECT_TRUE(few.all);
    EXPECT_EQ(few.pairs.size(), 1400u * 1399 / 2);
    const Soup soup = parted_pages(4000);
    const FoundPairs many = found_in(soup, wanted);
    EXPECT_FALSE(many.all);
    EXPECT_GT(many.pairs.size(), std::size_t(1) << 20U);
    EXPECT_LT(many.pairs.size(), 4000u * 3999 / 2);
    EXPECT_TRUE(std::is_sorted(many.pairs.begin(), many.pairs.end()));
    for (const std::size_t threads : {1U, 3U, 4U}) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_EQ(found_in(soup, wanted).pairs, many.pairs) << threads;
    }
}

/// By triangle, whether it touches another one, found without those pairs of which both are known.
std::vector<char> touching(const Soup& soup, std::atomic<std::size_t>& tests)
{
    std::vector<std::atomic<bool>> touching(soup.triangles.size());
    PairBounds wanted;
    wanted.settled = [&](std::uint32_t t) { return touching[t].load(); };
    overlapping_triangles(
        soup.points, soup.triangles,
        [&](std::uint32_t i, std::uint32_t j) {
            if (touching[i] && touching[j])
                return false;
            ++tests;
            if (soup.touch(i, j))
                touching[i] = touching[j] = true;
            return false;
        },
        wanted);
    return {touching.begin(), touching.end()};
}

TEST(overlapping_triangles, of_settled_ones_no_more_is_asked)
{
    std::atomic<std::size_t> tests{0};
    for (const Soup& soup : {random_needles(700, 0), layers(1500, 1), parted_pages(1400)}) {
        std::vector<char> by_pairs(soup.triangles.size());
        for (const auto& [i, j] : by_brute_force(soup))
            by_pairs[i] = by_pairs[j] = 1;
        EXPECT_EQ(touching(soup, tests), by_pairs);
    }
    tests = 0;
    touching(parted_pages(8000), tests);
    EXPECT_LT(tests, 80000u);
}

} // namespace
} // namespace vdb_shell

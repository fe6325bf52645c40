// SPDX-License-Identifier: Apache-2.0
#include "repair/fill_patch.h"

#include "core/unit_vector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// Ears cut the plain way: at each cut all corners are looked at, and for each all others.
class PlainCuts
{
public:
    explicit PlainCuts(const Rim& rim) : rim_(rim)
    {
        for (std::uint32_t i = 0; i < rim.points.size(); ++i) {
            ring_.push_back(i);
            normal_ += (rim.points[i] - rim.points[0])
                           .cross(rim.points[(i + 1) % rim.points.size()] - rim.points[0]);
        }
        normal_ = unit_vector(normal_);
    }

    std::vector<Vec3I> triangles()
    {
        std::vector<Vec3I> cut;
        for (; ring_.size() >= 3; ring_.erase(ring_.begin() + std::ptrdiff_t(next_))) {
            if (!find_next())
                return {};
            cut.emplace_back(at(next_ + ring_.size() - 1), at(next_), at(next_ + 1));
            if (ring_.size() == 3)
                return cut;
        }
        return cut;
    }

private:
    std::uint32_t at(std::size_t place) const { return ring_[place % ring_.size()]; }
    const Vec3d& point(std::size_t place) const { return rim_.points[at(place)]; }

    double angle(std::size_t place) const
    {
        const Vec3d ahead = point(place + 1) - point(place);
        const Vec3d back = point(place + ring_.size() - 1) - point(place);
        const Vec3d cross = ahead.cross(back);
        const double signed_angle = std::atan2(normal_.dot(cross), ahead.dot(back));
        if (!(cross.lengthSqr() > 0))
            return M_PI;
        return signed_angle < 0 ? signed_angle + 2 * M_PI : signed_angle;
    }
    bool is_empty(std::size_t place) const
    {
        const Vec3d &a = point(place + ring_.size() - 1), &i = point(place), &b = point(place + 1);
        const auto left_of = [&](const Vec3d& from, const Vec3d& to, const Vec3d& p) {
            return normal_.dot((to - from).cross(p - from)) >= 0;
        };
        for (std::size_t other = place + 2; other < place + ring_.size() - 1; ++other) {
            const Vec3d& p = point(other);
            if (angle(other % ring_.size()) >= M_PI && left_of(a, i, p) && left_of(i, b, p) &&
                left_of(b, a, p))
                return false;
        }
        return true;
    }
    bool find_next()
    {
        std::vector<std::pair<double, std::uint32_t>> order;
        std::vector<std::size_t> place_of(rim_.points.size());
        for (std::size_t place = 0; place < ring_.size(); ++place) {
            place_of[at(place)] = place;
            const std::pair<std::uint32_t, std::uint32_t> edge =
                std::minmax(ring_[(place + ring_.size() - 1) % ring_.size()], at(place + 1));
            if (ring_.size() == 3 || rim_.edges.count(edge) == 0)
                order.emplace_back(angle(place), at(place));
        }
        std::sort(order.begin(), order.end());
        if (order.empty())
            return false;
        const auto ear = std::find_if(order.begin(), order.end(), [&](const auto& e) {
            return ring_.size() == 3 || (e.first < M_PI && is_empty(place_of[e.second]));
        });
        next_ = place_of[(ear == order.end() ? order.front() : *ear).second];
        return true;
    }

    const Rim& rim_;
    Vec3d normal_{0.0};
    std::vector<std::uint32_t> ring_;
    std::size_t next_ = 0;
};

/// A star in a plane at some angle, whose corners are off it by up to `folded`.
Rim random_star(std::mt19937& random, std::size_t corners, double folded)
{
    std::uniform_real_distribution<double> length(0.2, 1), off(-folded, folded);
    Rim rim;
    for (std::size_t i = 0; i < corners; ++i) {
        const double u = 2 * M_PI * double(i) / double(corners), r = length(random);
        const double x = r * std::cos(u), y = r * std::sin(u);
        rim.points.emplace_back(x, y + off(random), 0.5 * y + off(random));
    }
    return rim;
}

TEST(cut_rim_ears, cuts_what_looking_at_all_corners_would_cut)
{
    std::mt19937 random(7);
    std::size_t given_up = 0;
    for (const double folded : {0.0, 0.05, 0.5})
        for (const std::size_t corners : {3U, 4U, 9U, 40U, 150U})
            for (const bool with_edges : {false, true}) {
                Rim rim = random_star(random, corners, folded);
                std::uniform_int_distribution<std::uint32_t> any(0, std::uint32_t(corners) - 1);
                for (std::size_t i = 0; with_edges && i < corners; ++i)
                    rim.edges.insert(std::minmax({any(random), any(random)}));
                const std::vector<Vec3I> cut = cut_rim_ears(rim).triangles;
                EXPECT_EQ(cut, PlainCuts(rim).triangles()) << corners << ' ' << folded;
                given_up += cut.empty();
            }
    EXPECT_LT(given_up, 15u);
}

TEST(cut_rim_ears, of_a_comb_cuts_all)
{
    // Long teeth: the triangle of nearly every corner has others in its box.
    Rim rim;
    constexpr std::size_t kTeeth = 2000;
    for (std::size_t i = 0; i < kTeeth; ++i) {
        rim.points.emplace_back(double(i), 0, 0);
        rim.points.emplace_back(double(i) + 0.5, 1000 + double(i % 7), 0);
    }
    rim.points.emplace_back(double(kTeeth), 0, 0);
    rim.points.emplace_back(double(kTeeth) / 2, -10, 0);
    std::reverse(rim.points.begin(), rim.points.end());
    const Patch patch = cut_rim_ears(rim);
    ASSERT_EQ(patch.triangles.size(), rim.points.size() - 2);
    double area = 0;
    for (const Vec3I& t : patch.triangles)
        area += 0.5 * (patch.points[t[1]] - patch.points[t[0]])
                          .cross(patch.points[t[2]] - patch.points[t[0]])[2];
    double whole = 0;
    for (std::size_t i = 0; i < rim.points.size(); ++i)
        whole += 0.5 * rim.points[i].cross(rim.points[(i + 1) % rim.points.size()])[2];
    EXPECT_NEAR(area, whole, 1e-9 * std::abs(whole));
}

} // namespace
} // namespace vdb_shell::repair

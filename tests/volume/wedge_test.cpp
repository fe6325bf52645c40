// SPDX-License-Identifier: Apache-2.0
#include "volume/wedge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

Wedge upright()
{
    Wedge w;
    w.outer = {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
    for (std::size_t i = 0; i < 3; ++i)
        w.inner[i] = w.outer[i] - Vec3d(0, 0, 1);
    return w;
}

/// The inner triangle turned by an angle about the middle.
Wedge twisted(double radians)
{
    Wedge w = upright();
    const Vec3d middle(1.0 / 3, 1.0 / 3, 0);
    for (Vec3d& p : w.inner) {
        const Vec3d d = p - middle;
        p = middle + Vec3d(std::cos(radians) * d[0] - std::sin(radians) * d[1],
                           std::sin(radians) * d[0] + std::cos(radians) * d[1], d[2]);
    }
    return w;
}

/// Numbers in [0, 1) by a fixed rule.
Vec3d spread(int i)
{
    const auto part = [](double x) { return x - std::floor(x); };
    return {part(0.5 + i * 0.8191725134), part(0.5 + i * 0.6710436067),
            part(0.5 + i * 0.5497004779)};
}

WedgePlace place(int i)
{
    Vec3d at = spread(i);
    if (at[0] + at[1] > 1)
        at = Vec3d(1 - at[0], 1 - at[1], at[2]);
    return at;
}

double determinant(const Wedge& w, const WedgePlace& at)
{
    // Inner points lie below, so u, v and t are a left-handed system.
    return -jacobian_of(w, at).det();
}

TEST(Wedge, AnUprightPrismIsLinear)
{
    EXPECT_TRUE(has_positive_jacobian(upright()));
    for (int i = 0; i < 50; ++i)
        EXPECT_LT((point_of(upright(), place(i)) - Vec3d(place(i)[0], place(i)[1], -place(i)[2]))
                      .length(),
                  1e-15);
}

TEST(Wedge, TheJacobianIsTheDerivative)
{
    const Wedge w = twisted(0.7);
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 50; ++i)
        for (int k = 0; k < 3; ++k) {
            WedgePlace more = place(i), less = place(i);
            more[k] += kStep;
            less[k] -= kStep;
            const Vec3d slope = (point_of(w, more) - point_of(w, less)) / (2 * kStep);
            EXPECT_LT((slope - jacobian_of(w, place(i)).col(k)).length(), 1e-8);
        }
}

TEST(Wedge, WhereItSaysSoTheJacobianIsPositiveEverywhere)
{
    int sound = 0, unsound = 0;
    for (int k = 0; k < 60; ++k) {
        Wedge w = twisted(0.05 * k);
        w.inner[std::size_t(k % 3)] += 0.8 * (spread(k) - Vec3d(0.5));
        if (!has_positive_jacobian(w)) {
            ++unsound;
            continue;
        }
        ++sound;
        for (int i = 0; i < 200; ++i)
            EXPECT_GT(determinant(w, place(i)), 0) << k;
    }
    EXPECT_GT(sound, 10);
    EXPECT_GT(unsound, 10);
}

TEST(Wedge, RefusesAPrismThatIsTurnedOver)
{
    EXPECT_FALSE(has_positive_jacobian(twisted(3.1)));
    Wedge w = upright();
    std::swap(w.outer, w.inner);
    EXPECT_FALSE(has_positive_jacobian(w));
    w.inner = w.outer;
    EXPECT_FALSE(has_positive_jacobian(w));
}

TEST(Wedge, PinnedAndSharedCornersArePositiveInside)
{
    Wedge pinned = upright();
    pinned.inner[1] = pinned.outer[1];
    EXPECT_TRUE(has_positive_jacobian(pinned));
    Wedge shared = upright();
    shared.inner = {Vec3d(0.3, 0.3, -1), Vec3d(0.3, 0.3, -1), Vec3d(0.3, 0.3, -1)};
    EXPECT_TRUE(has_positive_jacobian(shared));
}

TEST(Wedge, FindsThePlaceOfAPoint)
{
    for (const double angle : {0.0, 0.5, 0.9}) {
        const Wedge w = twisted(angle);
        ASSERT_TRUE(has_positive_jacobian(w));
        for (int i = 0; i < 200; ++i) {
            const std::optional<WedgePlace> found = place_of(w, point_of(w, place(i)), Vec3d(0.3));
            ASSERT_TRUE(found);
            EXPECT_LT((*found - place(i)).length(), 1e-9);
        }
    }
}

} // namespace
} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "taper/tet_shape.h"

#include "vdb_shell/shell/quality.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace vdb_shell;
using namespace vdb_shell::taper;

const TetCorners kRegular{Vec3d(1, 1, 1), Vec3d(1, -1, -1), Vec3d(-1, -1, 1), Vec3d(-1, 1, -1)};
const TetCorners kSome{Vec3d(0, 0, 0), Vec3d(1.2, 0.1, -0.2), Vec3d(0.3, 0.9, 0.1),
                       Vec3d(0.4, 0.2, 0.7)};

constexpr double kPower = 1.5;
double weighed_of(const TetCorners& p)
{
    return weighed(distortion(squared_edges(p), six_volumes(p)), kPower);
}
double distortion_of(const TetCorners& p)
{
    return distortion(squared_edges(p), six_volumes(p));
}

TEST(TetShape, IsOneForTheRegularTetOfAnySize)
{
    TetCorners p = kRegular;
    if (six_volumes(p) < 0)
        std::swap(p[0], p[1]);
    EXPECT_NEAR(distortion_of(p), 1, 1e-12);
    for (Vec3d& corner : p)
        corner *= 1e-3;
    EXPECT_NEAR(distortion_of(p), 1, 1e-12);
}

TEST(TetShape, IsAPowerOfTheMeanRatioAndOfAmips)
{
    const double value = distortion_of(kSome);
    EXPECT_NEAR(value,
                std::pow(vdb_shell::mean_ratio(kSome[0], kSome[1], kSome[2], kSome[3]), -1.5),
                1e-12 * value);
    EXPECT_NEAR(distortion_of_amips(3 * std::pow(value, 2.0 / 3)), value, 1e-12 * value);
    EXPECT_NEAR(distortion_of_amips(3), 1, 1e-12); // of the regular tet
}

/// Differences of the value, in each corner.
TEST(TetShape, HasTheSlopesAndTheCurvatureThatItIsSaidToHave)
{
    constexpr double kStep = 1e-4;
    for (std::size_t free = 0; free < 4; ++free) {
        SCOPED_TRACE(free);
        Vec3d gradient(0.0);
        Symmetric h;
        add_distortion(kSome, free, six_volumes(kSome), kPower, gradient, h);
        const Vec3d volume = volume6_gradient(kSome, free);
        const auto at = [&](const Vec3d& by) {
            TetCorners p = kSome;
            p[free] += by;
            return p;
        };
        const double rows[3][3] = {{h.xx, h.xy, h.xz}, {h.xy, h.yy, h.yz}, {h.xz, h.yz, h.zz}};
        for (int i = 0; i < 3; ++i) {
            Vec3d step(0.0);
            step[i] = kStep;
            EXPECT_NEAR((six_volumes(at(step)) - six_volumes(at(-step))) / (2 * kStep), volume[i],
                        1e-9);
            EXPECT_NEAR((weighed_of(at(step)) - weighed_of(at(-step))) / (2 * kStep), gradient[i],
                        1e-5);
            for (int j = 0; j < 3; ++j) {
                Vec3d other(0.0);
                other[j] = kStep;
                const double mixed = weighed_of(at(step + other)) - weighed_of(at(step - other)) -
                                     weighed_of(at(other - step)) + weighed_of(at(-step - other));
                EXPECT_NEAR(mixed / (4 * kStep * kStep), rows[i][j], 1e-4);
            }
        }
    }
}

TEST(TetShape, IsConvexInOneCorner)
{
    // On the line from one place to another the value halfway lies below the mean of the ends.
    for (std::size_t free = 0; free < 4; ++free)
        for (int k = 1; k < 60; ++k) {
            const Vec3d by(0.3 * std::sin(k), 0.3 * std::sin(2.3 * k), 0.3 * std::cos(1.7 * k));
            TetCorners from = kSome, to = kSome, middle = kSome;
            to[free] += by, from[free] -= by;
            if (six_volumes(from) <= 0 || six_volumes(to) <= 0)
                continue;
            EXPECT_LT(distortion_of(middle), 0.5 * (distortion_of(from) + distortion_of(to)));
        }
}

TEST(TetShape, BreaksSofasRuleWhereTheReportSaysSo)
{
    int broken = 0, kept = 0;
    for (int k = 1; k < 4000; ++k) {
        TetCorners p = kSome;
        for (std::size_t c = 0; c < 4; ++c)
            p[c] += 0.6 * Vec3d(std::sin(1.1 * k + double(c)), std::sin(2.3 * k + 3.0 * double(c)),
                                0.5 * std::cos(1.7 * k - double(c)));
        // One in three is stretched, for the ratio of its edges.
        p[0] *= k % 3 == 0 ? 12 : 1;
        const double volume = six_volumes(p);
        if (volume <= 0)
            continue;
        const bool bad = shape_of(p).sofa_bad();
        EXPECT_EQ(breaks_sofa_rule(p, volume), bad) << k;
        bad ? ++broken : ++kept;
    }
    EXPECT_GT(broken, 100);
    EXPECT_GT(kept, 100);
}

TEST(TetShape, EdgesOfMoreThanOneToTenBreakSofasRuleWithAnyAngles)
{
    // A long tet over a regular triangle: its angles are 60 degrees and more.
    const auto over_triangle = [](double height) {
        const double r = std::sqrt(3.0) / 3;
        return TetCorners{Vec3d(r, 0, 0), Vec3d(-r / 2, 0.5, 0), Vec3d(-r / 2, -0.5, 0),
                          Vec3d(0, 0, height)};
    };
    for (const double height : {9.5, 10.5}) {
        const TetCorners p = over_triangle(height);
        ASSERT_GT(shape_of(p).min_dihedral_radians, kSofaSmallRadians);
        EXPECT_EQ(breaks_sofa_rule(p, six_volumes(p)), height > 10);
    }
}

TEST(TetShape, SolvesWhatIsPositiveAndNothingElse)
{
    Symmetric h;
    h.add_identity(2);
    h.add(1, Vec3d(1, 2, -1));
    Vec3d x;
    ASSERT_TRUE(solve_positive(h, Vec3d(1, -2, 3), x));
    EXPECT_NEAR(h.xx * x[0] + h.xy * x[1] + h.xz * x[2], 1, 1e-12);
    EXPECT_NEAR(h.xy * x[0] + h.yy * x[1] + h.yz * x[2], -2, 1e-12);
    EXPECT_NEAR(h.xz * x[0] + h.yz * x[1] + h.zz * x[2], 3, 1e-12);
    h.add(-10, Vec3d(0, 0, 1));
    EXPECT_FALSE(solve_positive(h, Vec3d(1, 1, 1), x));
    EXPECT_FALSE(solve_positive(Symmetric{}, Vec3d(1, 1, 1), x));
}

} // namespace

// SPDX-License-Identifier: Apache-2.0
#include "core/least_squares.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <vector>

namespace vdb_shell
{
namespace
{

/// A line through four points that lie on none: 2 + 3 t and a residual that is orthogonal to both
/// columns.
std::vector<SparseRow> line_rows()
{
    std::vector<SparseRow> rows;
    for (const double t : {0.0, 1.0, 2.0, 3.0})
        rows.push_back({{{0, 1.0}, {1, t}}});
    return rows;
}
const std::vector<double> kConstants{-3, -4, -7, -12};

TEST(LeastSquares, FitsALine)
{
    std::vector<double> x(2);
    minimise_squares(line_rows(), kConstants, x);
    EXPECT_NEAR(x[0], 2, 1e-9);
    EXPECT_NEAR(x[1], 3, 1e-9);
}

TEST(LeastSquares, AreTheSameInColumnsOfLengthOne)
{
    std::vector<SparseRow> rows = line_rows();
    for (SparseRow& row : rows)
        row.terms[1].second *= 1000;
    const std::vector<double> factor = scale_columns(rows, 3);
    EXPECT_EQ(factor[2], 1) << "which is in no row";
    for (std::size_t column = 0; column < 2; ++column) {
        double squared = 0;
        for (const SparseRow& row : rows)
            squared += row.terms[column].second * row.terms[column].second;
        EXPECT_NEAR(squared, 1, 1e-12);
    }
    std::vector<double> x(3);
    minimise_squares(rows, kConstants, x);
    EXPECT_NEAR(x[0] * factor[0], 2, 1e-9);
    EXPECT_NEAR(1000 * x[1] * factor[1], 3, 1e-9);
    EXPECT_EQ(x[2], 0);
}

/// A chain of springs between a row of points, many to a task, whose ends are held at 0 and 1.
TEST(LeastSquares, OfManyRowsAreTheSameForAnyNumberOfThreads)
{
    const std::size_t points = 20000;
    std::vector<SparseRow> rows{{{{0, 1.0}}}, {{{points - 1, 1.0}}}};
    std::vector<double> constants{0, -1};
    for (std::size_t i = 1; i < points; ++i) {
        rows.push_back({{{i - 1, -1.0}, {i, 1.0}}});
        constants.push_back(0);
    }
    const auto solved = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        LeastSquaresLimits limits;
        limits.most_steps = 200;
        std::vector<double> x(points);
        for (std::size_t i = 0; i < points; ++i)
            x[i] = double(i % 7) + double(i) / double(points - 1);
        minimise_squares(rows, constants, x, limits);
        return x;
    };
    const std::vector<double> x = solved(1);
    EXPECT_EQ(solved(4), x);
    // The waves of seven points are gone; the straight line between the ends is what is left.
    for (std::size_t i = points / 2; i < points / 2 + 100; ++i)
        EXPECT_NEAR(x[i + 1] - x[i], 1.0 / double(points - 1), 1e-3);
}

TEST(LeastSquares, EndAfterAsManyStepsAsAreAllowed)
{
    LeastSquaresLimits none, one;
    none.most_steps = 0;
    one.most_steps = 1;
    std::vector<double> x(2), y(2);
    minimise_squares(line_rows(), kConstants, x, none);
    EXPECT_EQ(x, std::vector<double>(2));
    minimise_squares(line_rows(), kConstants, y, one);
    EXPECT_NE(y, x);
    EXPECT_GT(std::abs(y[0] - 2), 1e-3);
}

} // namespace
} // namespace vdb_shell

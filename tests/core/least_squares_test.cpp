// SPDX-License-Identifier: Apache-2.0
#include "core/least_squares.h"

#include <gtest/gtest.h>

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

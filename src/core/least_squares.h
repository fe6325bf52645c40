// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace vdb_shell
{

/// A linear function of many unknowns that few of them are in: coefficients by unknown.
struct SparseRow {
    std::vector<std::pair<std::size_t, double>> terms;
};

struct LeastSquaresLimits {
    /// The residual's length, over what it was at the start, at which this ends.
    double gain = 1e-9;
    std::size_t most_steps = ~std::size_t(0);
    std::size_t most_work = 300'000'000; ///< terms of rows, a second's work
};

/// From x on, makes the sum of the squares of row(x) + constant least, by conjugate gradients on
/// the normal equations (Hestenes and Stiefel 1952, "Methods of conjugate gradients for solving
/// linear systems"). The same bytes for any number of threads. Stops where the stage is to
/// (stage_stop.h). Preconditions: a constant for each row; fewer than 2^32 rows and unknowns.
void minimise_squares(const std::vector<SparseRow>& rows, const std::vector<double>& constants,
                      std::vector<double>& x, const LeastSquaresLimits& limits = {});

/// Makes the columns of the rows alike, which takes steps off where their lengths differ: the
/// factor by which each unknown of the new rows is that of the old ones. 1 where none has it.
std::vector<double> scale_columns(std::vector<SparseRow>& rows, std::size_t unknowns);

} // namespace vdb_shell

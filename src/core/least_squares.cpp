// SPDX-License-Identifier: Apache-2.0

// Takes: linear functions of many unknowns. Gives: the unknowns for which the sum of their squares
// is least, or nearly: whoever calls this does not rest on how exactly it is solved. The matrix of
// the normal equations is never formed.

#include "core/least_squares.h"

#include "core/stage_stop.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

/// out = transpose(A) A x for the rows A.
void apply(const std::vector<SparseRow>& rows, const std::vector<double>& x,
           std::vector<double>& out)
{
    std::fill(out.begin(), out.end(), 0.0);
    for (const SparseRow& row : rows) {
        double value = 0;
        for (const auto& [i, coefficient] : row.terms)
            value += coefficient * x[i];
        for (const auto& [i, coefficient] : row.terms)
            out[i] += coefficient * value;
    }
}

double dot(const std::vector<double>& a, const std::vector<double>& b)
{
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

} // namespace

void minimise_squares(const std::vector<SparseRow>& rows, const std::vector<double>& constants,
                      std::vector<double>& x, const LeastSquaresLimits& limits)
{
    const std::size_t n = x.size();
    std::vector<double> residual(n), direction, image(n);
    apply(rows, x, image);
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (const auto& [i, coefficient] : rows[r].terms)
            residual[i] -= coefficient * constants[r];
    for (std::size_t i = 0; i < n; ++i)
        residual[i] -= image[i];
    direction = residual;
    double squared = dot(residual, residual);
    const double enough = limits.gain * limits.gain * squared;
    std::size_t terms = 1;
    for (const SparseRow& row : rows)
        terms += row.terms.size();
    // Without rounding n steps would be enough; a few times as many bound the work with it. What is
    // left where the work ends sooner is a slow wave over the whole.
    const std::size_t most_steps =
        std::min({limits.most_steps, 4 * n, limits.most_work / terms + 1});
    for (std::size_t step = 0; step < most_steps && squared > enough && squared > 0; ++step) {
        stop_if_stage_wants();
        apply(rows, direction, image);
        const double curvature = dot(direction, image);
        // Along this direction no row changes, so there is nothing left to gain.
        if (!(curvature > 0))
            return;
        const double length = squared / curvature;
        for (std::size_t i = 0; i < n; ++i) {
            x[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        const double next = dot(residual, residual);
        for (std::size_t i = 0; i < n; ++i)
            direction[i] = residual[i] + next / squared * direction[i];
        squared = next;
    }
}

std::vector<double> scale_columns(std::vector<SparseRow>& rows, std::size_t unknowns)
{
    std::vector<double> squared(unknowns), factor(unknowns, 1);
    for (const SparseRow& row : rows)
        for (const auto& [i, coefficient] : row.terms)
            squared[i] += coefficient * coefficient;
    for (std::size_t i = 0; i < unknowns; ++i)
        if (squared[i] > 0)
            factor[i] = 1 / std::sqrt(squared[i]);
    for (SparseRow& row : rows)
        for (auto& [i, coefficient] : row.terms)
            coefficient *= factor[i];
    return factor;
}

} // namespace vdb_shell

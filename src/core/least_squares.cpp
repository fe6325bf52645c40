// SPDX-License-Identifier: Apache-2.0

// Takes: linear functions of many unknowns. Gives: the unknowns for which the sum of their squares
// is least, or nearly: whoever calls this does not rest on how exactly it is solved. The matrix of
// the normal equations is never formed.

#include "core/least_squares.h"

#include "core/parallel.h"
#include "core/stage_stop.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

namespace vdb_shell
{
namespace
{

// Rows or columns that one task takes: some tens of microseconds of work.
constexpr std::size_t kRowsAtOnce = 2048;

/// The rows of a matrix, or its columns, packed one after the other: number i has the terms from
/// first[i] on. Every product of a step reads all of them.
struct Packed {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> place;
    std::vector<double> coefficient;

    std::size_t size() const { return first.size() - 1; }

    /// Each sum is of one thread, so it is rounded the same way for any number of them.
    void multiply(const std::vector<double>& x, std::vector<double>& products) const
    {
        for_each_index(
            size(),
            [&](std::size_t i) {
                double sum = 0;
                for (std::size_t t = first[i]; t < first[i + 1]; ++t)
                    sum += coefficient[t] * x[place[t]];
                products[i] = sum;
            },
            kRowsAtOnce);
    }
};

Packed packed_rows(const std::vector<SparseRow>& rows)
{
    Packed packed;
    packed.first.push_back(0);
    for (const SparseRow& row : rows) {
        for (const auto& [i, coefficient] : row.terms) {
            packed.place.push_back(static_cast<std::uint32_t>(i));
            packed.coefficient.push_back(coefficient);
        }
        packed.first.push_back(packed.place.size());
    }
    return packed;
}

/// Columns for rows. The terms of each stand in the order of the rows.
Packed transposed(const Packed& rows, std::size_t columns)
{
    Packed packed;
    packed.first.assign(columns + 1, 0);
    for (const std::uint32_t i : rows.place)
        ++packed.first[i + 1];
    std::partial_sum(packed.first.begin(), packed.first.end(), packed.first.begin());
    packed.place.resize(rows.place.size());
    packed.coefficient.resize(rows.place.size());
    std::vector<std::size_t> next(packed.first.begin(), packed.first.end() - 1);
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t t = rows.first[r]; t < rows.first[r + 1]; ++t) {
            const std::size_t to = next[rows.place[t]]++;
            packed.place[to] = static_cast<std::uint32_t>(r);
            packed.coefficient[to] = rows.coefficient[t];
        }
    return packed;
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
    assert(std::max(n, rows.size()) <= std::numeric_limits<std::uint32_t>::max());
    const Packed by_row = packed_rows(rows), by_column = transposed(by_row, n);
    std::vector<double> residual(n), direction, image(n), values(rows.size());
    // transpose(A) A x for the rows A.
    const auto apply = [&](const std::vector<double>& to) {
        by_row.multiply(to, values);
        by_column.multiply(values, image);
    };
    by_column.multiply(constants, residual);
    apply(x);
    for (std::size_t i = 0; i < n; ++i)
        residual[i] = -residual[i] - image[i];
    direction = residual;
    double squared = dot(residual, residual);
    const double enough = limits.gain * limits.gain * squared;
    const std::size_t terms = 1 + by_row.place.size();
    // Without rounding n steps would be enough; a few times as many bound the work with it. What is
    // left where the work ends sooner is a slow wave over the whole.
    const std::size_t most_steps =
        std::min({limits.most_steps, 4 * n, limits.most_work / terms + 1});
    for (std::size_t step = 0; step < most_steps && squared > enough && squared > 0; ++step) {
        stop_if_stage_wants();
        apply(direction);
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

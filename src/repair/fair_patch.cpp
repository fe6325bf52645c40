// SPDX-License-Identifier: Apache-2.0

// Takes a refined patch and moves its new points; the rim stays. The Laplacian at a point is the
// mean of its neighbours, weighted by the inverse of their distance, minus the point: the
// scale-dependent umbrella of Desbrun, Meyer, Schroeder and Barr 1999, "Implicit fairing of
// irregular meshes using diffusion and curvature flow". With Laplacians at the new points only,
// their sum of squares can be made zero and the patch is a membrane; with those at the rim too,
// which see the surface outside, the patch goes on with its slope. Weights are those of the places
// before, so the problem is linear and the three axes are apart. Nothing rests on how exactly it is
// solved: the fill is tested afterwards.

#include "core/parallel.h"
#include "repair/fill_patch.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// One Laplacian as a linear function of the new points: their coefficients, and the constant part
/// that comes from points which stay.
struct Row {
    std::vector<std::pair<std::size_t, double>> terms;
    Vec3d constant{0.0};
};

/// The Laplacian at a point. Neighbours come in ascending order, so the sums are always rounded
/// alike.
Row laplacian_at(const Patch& patch, const Rim& rim, std::size_t point,
                 const std::set<std::uint32_t>& neighbours)
{
    const std::size_t fixed = rim.points.size();
    Row row;
    std::vector<std::pair<const Vec3d*, double>> all;
    double sum = 0;
    const auto weigh = [&](const Vec3d& other) {
        const double length = (other - patch.points[point]).length();
        // A neighbour in the same place would have an infinite weight, and gets none.
        const double weight = length > 0 ? 1 / length : 0;
        sum += weight;
        return weight;
    };
    std::vector<double> weights;
    weights.reserve(neighbours.size());
    for (const std::uint32_t v : neighbours)
        weights.push_back(weigh(patch.points[v]));
    if (point < fixed)
        for (const Vec3d& outside : rim.neighbours[point])
            row.constant += outside * weigh(outside);
    if (!(sum > 0))
        return {};
    // So far the constant has only the neighbours outside of the patch, by weights that do not yet
    // sum to 1; the shares below do.
    row.constant /= sum;
    std::size_t next = 0;
    for (const std::uint32_t v : neighbours) {
        const double share = weights[next++] / sum;
        if (v < fixed)
            row.constant += patch.points[v] * share;
        else
            row.terms.emplace_back(v - fixed, share);
    }
    if (point < fixed)
        row.constant -= patch.points[point];
    else
        row.terms.emplace_back(point - fixed, -1.0);
    return row;
}

/// out = transpose(A) A x for the rows A.
void apply(const std::vector<Row>& rows, const std::vector<double>& x, std::vector<double>& out)
{
    std::fill(out.begin(), out.end(), 0.0);
    for (const Row& row : rows) {
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

/// Least squares of A x + constant along one axis by conjugate gradients on the normal equations,
/// from x on (Hestenes and Stiefel 1952, "Methods of conjugate gradients for solving linear
/// systems"). The matrix is never formed: a row has as many terms as a point has neighbours.
/// Serial, so that sums keep their order.
void minimise(const std::vector<Row>& rows, int axis, std::vector<double>& x)
{
    // The length of the residual, relative to what it was at the start, at which this ends.
    constexpr double kGain = 1e-9;
    const std::size_t n = x.size();
    std::vector<double> residual(n), direction, image(n);
    apply(rows, x, image);
    for (const Row& row : rows)
        for (const auto& [i, coefficient] : row.terms)
            residual[i] -= coefficient * row.constant[axis];
    for (std::size_t i = 0; i < n; ++i)
        residual[i] -= image[i];
    direction = residual;
    double squared = dot(residual, residual);
    const double enough = kGain * kGain * squared;
    // Without rounding n steps would be enough; a few times as many bound the work with it. Large
    // patches, from some 5000 points on, end at kMostWork: what is left then is a slow wave over
    // the whole of the patch, and a second's work.
    constexpr std::size_t kMostWork = 300'000'000; // terms of rows
    std::size_t terms = 1;
    for (const Row& row : rows)
        terms += row.terms.size();
    const std::size_t most_steps = std::min(4 * n, kMostWork / terms + 1);
    for (std::size_t step = 0; step < most_steps && squared > enough && squared > 0; ++step) {
        apply(rows, direction, image);
        const double curvature = dot(direction, image);
        // Along this direction no Laplacian changes, so there is nothing left to gain.
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

} // namespace

void fair(Patch& patch, const Rim& rim, bool smooth)
{
    const std::size_t fixed = rim.points.size(), moving = patch.points.size() - fixed;
    if (moving == 0)
        return;
    std::vector<std::set<std::uint32_t>> neighbours(patch.points.size());
    for (const Vec3I& t : patch.triangles)
        for (int k = 0; k < 3; ++k) {
            neighbours[t[k]].insert(t[(k + 1) % 3]);
            neighbours[t[(k + 1) % 3]].insert(t[k]);
        }
    std::vector<Row> rows;
    for (std::size_t v = smooth ? 0 : fixed; v < patch.points.size(); ++v)
        rows.push_back(laplacian_at(patch, rim, v, neighbours[v]));
    for_each_index(
        3,
        [&](std::size_t k) {
            const auto axis = static_cast<int>(k);
            std::vector<double> x(moving);
            for (std::size_t i = 0; i < moving; ++i)
                x[i] = patch.points[fixed + i][axis];
            minimise(rows, axis, x);
            for (std::size_t i = 0; i < moving; ++i)
                patch.points[fixed + i][axis] = x[i];
        },
        1);
}

} // namespace vdb_shell::repair

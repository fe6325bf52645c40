// SPDX-License-Identifier: Apache-2.0

// Takes a refined patch and moves its new points; the rim stays. The Laplacian at a point is the
// mean of its neighbours, weighted by the inverse of their distance, minus the point: the
// scale-dependent umbrella of Desbrun, Meyer, Schroeder and Barr 1999, "Implicit fairing of
// irregular meshes using diffusion and curvature flow". With Laplacians at the new points only,
// their sum of squares can be made zero and the patch is a membrane; with those at the rim too,
// which see the surface outside, the patch goes on with its slope. Weights are those of the places
// before, so the problem is linear and the three axes are apart. Nothing rests on how exactly it is
// solved: the fill is tested afterwards.

#include "core/least_squares.h"
#include "core/parallel.h"
#include "repair/fill_patch.h"

#include <set>
#include <utility>
#include <vector>

namespace vdb_shell::repair
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

/// One Laplacian as a linear function of the new points, and the constant part that comes from
/// points which stay.
struct Laplacian {
    SparseRow row;
    Vec3d constant{0.0};
};

/// The Laplacian at a point. Neighbours come in ascending order, so the sums are always rounded
/// alike.
Laplacian laplacian_at(const Patch& patch, const Rim& rim, std::size_t point,
                       const std::set<std::uint32_t>& neighbours)
{
    const std::size_t fixed = rim.points.size();
    Laplacian at;
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
            at.constant += outside * weigh(outside);
    if (!(sum > 0))
        return {};
    // So far the constant has only the neighbours outside of the patch, by weights that do not yet
    // sum to 1; the shares below do.
    at.constant /= sum;
    std::size_t next = 0;
    for (const std::uint32_t v : neighbours) {
        const double share = weights[next++] / sum;
        if (v < fixed)
            at.constant += patch.points[v] * share;
        else
            at.row.terms.emplace_back(v - fixed, share);
    }
    if (point < fixed)
        at.constant -= patch.points[point];
    else
        at.row.terms.emplace_back(point - fixed, -1.0);
    return at;
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
    std::vector<SparseRow> rows;
    std::vector<Vec3d> constants;
    for (std::size_t v = smooth ? 0 : fixed; v < patch.points.size(); ++v) {
        Laplacian at = laplacian_at(patch, rim, v, neighbours[v]);
        rows.push_back(std::move(at.row));
        constants.push_back(at.constant);
    }
    for_each_index(
        3,
        [&](std::size_t k) {
            const auto axis = static_cast<int>(k);
            std::vector<double> x(moving), along(constants.size());
            for (std::size_t i = 0; i < moving; ++i)
                x[i] = patch.points[fixed + i][axis];
            for (std::size_t r = 0; r < along.size(); ++r)
                along[r] = constants[r][axis];
            // Large patches, from some 5000 points on, end by the work: what is left then is a slow
            // wave over the whole of the patch.
            minimise_squares(rows, along, x);
            for (std::size_t i = 0; i < moving; ++i)
                patch.points[fixed + i][axis] = x[i];
        },
        1);
}

} // namespace vdb_shell::repair

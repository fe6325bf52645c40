// SPDX-License-Identifier: Apache-2.0

// Finds points of exactly equal position by sorting, in O(n log n). There is no tolerance: "nearer
// than a tolerance" does not carry over from one pair to the next, so the result would depend on
// the order of the points. The index is part of the key, which makes the order unique and puts the
// first of equal points in front. Trap: a coordinate that is not a number would make the order
// contradict itself, which is why callers refuse such points before.

#include "mesh/equal_points.h"

#include "core/parallel_sort.h"

#include <numeric>
#include <tuple>

namespace vdb_shell
{

std::vector<std::uint32_t> first_equal_point(const std::vector<openvdb::Vec3s>& points)
{
    // Equal points come to stand side by side, the first of them in front.
    auto key = [&](std::uint32_t i) {
        const openvdb::Vec3s& p = points[i];
        return std::make_tuple(p[0], p[1], p[2], i);
    };
    std::vector<std::uint32_t> order(points.size()), first(points.size());
    std::iota(order.begin(), order.end(), 0U);
    parallel_sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool repeats = k > 0 && points[order[k]] == points[order[k - 1]];
        first[order[k]] = repeats ? first[order[k - 1]] : order[k];
    }
    return first;
}

} // namespace vdb_shell

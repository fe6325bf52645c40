// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell after mending, and where its inner points were before. Leaves: a valid shell
// that is thicker. Mending shortens all three pillars of a prism that fails, for which of them is
// to blame cannot be told then, and goes on for as long as one of them fails again; afterwards most
// that were not can go back. Few points have lost much, so they are tried one by one.

#include "growth/lengthen_again.h"

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/other_components.h"
#include "growth/violations.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell::growth
{
namespace
{

std::vector<int> most_lost_first(const GrowState& s, const std::vector<double>& lost6)
{
    std::vector<int> vertices;
    const double fill = fill_of(s);
    if (fill >= s.schedule.barrier.enough_fill)
        return vertices;
    const double empty6 = (1 - fill) * std::abs(volume6(s.a, s.mesh->faces));
    const double least6 = s.schedule.mend.least_loss * empty6 / std::max(1, s.mesh->vertices);
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (!s.pinned[v] && lost6[v] > least6)
            vertices.push_back(v);
    std::stable_sort(vertices.begin(), vertices.end(),
                     [&](int u, int v) { return lost6[u] > lost6[v]; });
    return vertices;
}

/// Puts the inner point of v to x, and the boxes of its faces with it.
void put(GrowState& s, int v, const Vec3d& x, const std::vector<int>& faces)
{
    s.b[v] = x;
    for (const int f : faces)
        s.inner_tree.replace(static_cast<std::size_t>(f), float_box_of(inner_corners(s, f)));
}

bool put_back(GrowState& s, int v, const Vec3d& before)
{
    const Vec3d here = s.b[v];
    const std::vector<int> faces = faces_at(*s.mesh, v);
    double share = 1;
    for (int i = 0; i < s.schedule.mend.tries_back; ++i, share *= 0.5) {
        const Vec3d x = capped(s, v, here + share * (before - here));
        if (x == here || x == s.a[v] || !tets_positive_at(s, v, x) || swallows_component(s, v, x))
            continue;
        put(s, v, x, faces);
        if (faces_valid(s, faces))
            return true;
        put(s, v, here, faces);
    }
    return false;
}

} // namespace

std::vector<double> volume6_lost(const GrowState& s, const std::vector<Vec3d>& before)
{
    std::vector<double> lost6(before.size());
    for_each_index(lost6.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        lost6[i] = -inner_volume6_gradient(s, v).dot(before[i] - s.b[i]);
    });
    return lost6;
}

std::size_t lengthen_again(GrowState& s, const std::vector<Vec3d>& before,
                           const StageProgress& progress)
{
    const std::vector<int> vertices = most_lost_first(s, volume6_lost(s, before));
    // A tree that was refitted often is slow, and later stages go in its order.
    s.inner_tree.build(inner_boxes(s));
    s.inner_tree.index_parents();
    std::size_t moved = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        progress.stop_if_interrupted(100 * double(i) / double(vertices.size()));
        moved += put_back(s, vertices[i], before[std::size_t(vertices[i])]);
    }
    return moved;
}

} // namespace vdb_shell::growth

// SPDX-License-Identifier: Apache-2.0
#include "growth/pins.h"

#include "core/parallel.h"
#include "growth/line_directions.h"
#include "growth/move_tests.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

constexpr int kLengths = 16; ///< of a ladder that halves

/// The direction that serves the tets on v's pillar best, with the neighbours where they are: each
/// of these tets asks for one side of a plane through a_v, whatever the pillar's length.
Vec3d best_direction(const GrowState& s, int v)
{
    std::vector<Vec3d> normals;
    for (const FaceCorner& at : star(*s.mesh, v)) {
        const int j = s.mesh->corner(at.face, (at.local + 1) % 3);
        const int k = s.mesh->corner(at.face, (at.local + 2) % 3);
        for (const Vec3d* p : {&s.a[j], &s.b[j]})
            for (const Vec3d* q : {&s.a[k], &s.b[k]}) {
                const Vec3d n = (*q - s.a[v]).cross(*p - s.a[v]);
                if (n.lengthSqr() > 0)
                    normals.push_back(n / n.length());
            }
    }
    return most_visible(normals);
}

/// The mean pillar beside v: what it would have had without the pin.
double longest_try(const GrowState& s, int v)
{
    double sum = 0;
    for (const int u : neighbours(*s.mesh, v))
        sum += (s.b[u] - s.a[u]).length();
    return std::min(sum / std::max(1, neighbours(*s.mesh, v).size()), 0.05 * s.diagonal);
}

bool star_valid(const GrowState& s, int v)
{
    for (const FaceCorner& at : star(*s.mesh, v))
        if (!prism_valid(s, at.face) || !inner_triangle_clear(s, at.face) ||
            holds_component(s, at.face))
            return false;
    return true;
}

bool release(GrowState& s, int v, double length)
{
    const Vec3d d = best_direction(s, v);
    if (d.lengthSqr() == 0)
        return false;
    s.pinned[v] = 0;
    for (int i = 0; i < kLengths && length > 2 * s.rounding; ++i, length *= 0.5) {
        const Vec3d x = end_within_cap(s, v, d, length);
        if (x == s.a[v])
            break;
        if (swallows_component(s, v, x))
            continue;
        s.b[v] = x;
        if (star_valid(s, v))
            return true;
        s.b[v] = s.a[v];
    }
    s.pinned[v] = 1;
    return false;
}

/// Boxes that hold the inner triangles wherever these vertices may go.
void box_in(GrowState& s, const std::vector<double>& longest)
{
    std::vector<FloatBox> boxes(s.mesh->faces.size());
    for_each_index(boxes.size(), [&](std::size_t i) {
        const int f = static_cast<int>(i);
        double reach = 0;
        for (int k = 0; k < 3; ++k)
            reach = std::max(reach, longest[s.mesh->corner(f, k)]);
        boxes[i] = float_box_of(inner_corners(s, f), reach > 0 ? 1.01 * reach + s.rounding : 0);
    });
    s.inner_tree.refit(boxes);
}

} // namespace

int release_pins(GrowState& s, const std::vector<double>& visibility)
{
    std::vector<int> candidates;
    std::vector<double> longest(s.b.size(), 0.0);
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (s.pinned[v] && visibility[v] > 0 && s.cap[v] > 0 && star(*s.mesh, v).size() > 0) {
            candidates.push_back(v);
            longest[v] = longest_try(s, v);
        }
    if (candidates.empty())
        return 0;
    box_in(s, longest);
    int released = 0;
    for (const int v : candidates)
        released += release(s, v, longest[v]);
    return released;
}

} // namespace vdb_shell::growth

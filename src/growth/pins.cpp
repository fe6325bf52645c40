// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell with pinned vertices. Leaves: a valid shell in which those have a pillar
// that the exact tests allow one. A release is a change like any other: all prisms and inner
// triangles around the vertex pass the tests before and after it (docs/theory.md, "Growth").

#include "growth/pins.h"

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "mesh/most_visible.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

/// The direction that serves the tets on v's pillar best, with the neighbours where they are: each
/// of these tets is positive on one side of a plane through a_v, whatever the pillar's length.
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

/// The mean pillar beside v, about what it would have had without the pin.
double longest_try(const GrowState& s, int v)
{
    double sum = 0;
    for (const int u : neighbours(*s.mesh, v))
        sum += (s.b[u] - s.a[u]).length();
    return std::min(sum / std::max(1, neighbours(*s.mesh, v).size()),
                    s.schedule.pins.longest * s.diagonal);
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
    // The tests have to see the vertex as released, so it is pinned again where they fail.
    s.pinned[v] = 0;
    for (int i = 0; i < s.schedule.pins.lengths && length > shortest_pillar(s);
         ++i, length *= 0.5) {
        const Vec3d x = end_within_cap(s, v, d, length);
        if (x == s.a[v])
            break;
        // Contact tests see only where a triangle ends up, not what it has passed over.
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

/// Boxes that hold the inner triangles wherever these vertices may go, so that the tree need not be
/// refitted after each release. The tests need boxes that are large enough, not tight.
void box_in(GrowState& s, const std::vector<double>& longest)
{
    std::vector<FloatBox> boxes(s.mesh->faces.size());
    for_each_index(boxes.size(), [&](std::size_t i) {
        const int f = static_cast<int>(i);
        double most = 0;
        for (int k = 0; k < 3; ++k)
            most = std::max(most, longest[s.mesh->corner(f, k)]);
        const double wider = most > 0 ? (1 + kRadiusMargin) * most + s.rounding : 0;
        boxes[i] = float_box_of(inner_corners(s, f), wider);
    });
    s.inner_tree.refit(boxes);
}

} // namespace

int release_pins(GrowState& s, const std::vector<double>& visibility)
{
    // One after another in index order, never in parallel: each release changes what the next sees.
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

// SPDX-License-Identifier: Apache-2.0

// Takes: the surface, directions and the lengths of line stepping. Leaves: a valid shell, which
// growth goes on from; as the one with all vertices pinned is valid where the surface is, there
// always is one. Lengths err on the long side, because what is shrunk where it has to be ends
// thicker than what is grown from nothing. Source: docs/theory.md, "Growth".

#include "growth/initialise.h"

#include "core/parallel.h"
#include "core/triangle_piece.h"
#include "growth/line_directions.h"
#include "growth/mend_prolonged.h"
#include "growth/move_tests.h"
#include "growth/place_pillars.h"
#include "growth/planar_quads.h"
#include "growth/ray_hit.h"
#include "growth/violations.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

double smallest_altitude(const Corners& c)
{
    const double longest =
        std::max({(c[1] - c[0]).lengthSqr(), (c[2] - c[1]).lengthSqr(), (c[0] - c[2]).lengthSqr()});
    return longest > 0 ? (c[1] - c[0]).cross(c[2] - c[0]).length() / std::sqrt(longest) : 0;
}

/// Shrinks the pillars of violating prisms; marks the faces that this changes. False when there is
/// nothing left to shrink.
bool shrink_around(GrowState& s, const std::vector<std::uint8_t>& bad, std::vector<double>& length,
                   std::vector<std::uint8_t>& changed)
{
    const std::vector<std::uint8_t> shrunk = free_corners_of(s, bad);
    bool any = false;
    for (int v = 0; v < s.mesh->vertices; ++v) {
        if (!shrunk[v])
            continue;
        any = true;
        // All three corners shrink, for which of them is to blame cannot be told.
        length[v] *= s.schedule.initial.shrink_factor;
        if (length[v] < shortest_pillar(s))
            s.pinned[v] = 1;
    }
    changed = faces_around(s, shrunk);
    return any;
}

/// The longer of line stepping's length and half the ray to the other side: stop tests end many
/// lines early, and how early depends on the voxels.
std::vector<double> first_lengths(const GrowState& s, const Directions& directions,
                                  const std::vector<double>& stepped)
{
    std::vector<double> length = half_rays(s, directions);
    for (std::size_t v = 0; v < length.size(); ++v)
        length[v] = s.schedule.initial.share_of_half_ray * std::max(length[v], stepped[v]);
    return length;
}

// Of a length, where a ray ends in a vertex of thousands of triangles: one of them is as good as
// another, and boxes of floats are 6e-8 wider than what they hold.
constexpr double kNearEnough = 1 - 1e-6;

} // namespace

Directions prepare_directions(const TriangleMesh& mesh, Directions directions,
                              const GrowOptions& options, bool smooth)
{
    if (options.mend_directions)
        mend_directions(mesh, directions, options.schedule.initial);
    if (options.smooth_directions && smooth)
        smooth_directions(mesh, directions, options.schedule.initial);
    return directions;
}

std::vector<double> half_rays(const GrowState& s, const Directions& directions)
{
    std::vector<double> half(s.a.size(), 0);
    // Where many long triangles meet in a vertex, a ray past it meets the boxes of all.
    PartBoxes parts;
    BoxTree tree_of_parts;
    const bool by_parts = s.mesh->has_crowds;
    if (by_parts) {
        parts = part_boxes({s.a.begin(), s.a.end()}, s.mesh->faces);
        tree_of_parts.build(parts.boxes);
    }
    for_each_index(half.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        const Vec3d& d = directions.inward[v];
        // A ray that meets nothing, as many do outward, ends at the diagonal.
        double best = s.diagonal, limit = best;
        (by_parts ? tree_of_parts : s.outer_tree).for_each_on_ray(s.a[v], d, limit, [&](int box) {
            const int f = by_parts ? static_cast<int>(parts.triangle[std::size_t(box)]) : box;
            if (s.mesh->incident_to(f, v))
                return;
            best = std::min(best, ray_hit(s.a[v], d, outer_corners(s, f)));
            limit = best * (by_parts ? kNearEnough : 1);
        });
        half[v] = 0.5 * best;
    });
    return half;
}

std::vector<double> thin_heights(const GrowState& s)
{
    std::vector<double> h(s.a.size(), std::numeric_limits<double>::infinity());
    for (int f = 0; f < s.mesh->face_count(); ++f) {
        // However its pillars tilt, a low prism over a wide triangle is sound.
        const double height =
            s.schedule.initial.thin_share * smallest_altitude(outer_corners(s, f));
        for (int k = 0; k < 3; ++k)
            h[s.mesh->corner(f, k)] = std::min(h[s.mesh->corner(f, k)], height);
    }
    return h;
}

void shrink_until_valid(GrowState& s, const Directions& directions, std::vector<double> length,
                        const StageProgress& progress)
{
    pin_unservable(s, directions, length);
    for (std::size_t v = 0; v < length.size(); ++v)
        length[v] = std::min(length[v], s.cap[v]);
    std::vector<std::uint8_t> changed(s.mesh->faces.size(), 1);
    place_pillars(s, directions, length);
    bool first = true;
    // Every round shortens each free pillar of a failing prism by a fixed factor, or pins it when
    // it is lost in the rounding. So it ends, even on a surface that crosses itself: with all its
    // vertices pinned.
    while (shrink_around(s, violating_faces(s, changed, first), length, changed)) {
        progress.stop_if_interrupted(0);
        place_pillars(s, directions, length);
        first = false;
    }
}

void start_from_lines(GrowState& s, const Directions& directions,
                      const std::vector<double>& stepped, LineStart start,
                      const GrowOptions& options, const StageProgress& progress)
{
    if (leaves_lines(start)) {
        // Its pins are few and have room around them, so that growth can release most.
        s.twelve = prism_test_of(options) == PrismTest::twelve_tets;
        const Directions lines = start == LineStart::planar
                                     ? with_planar_quads(s, directions, half_rays(s, directions))
                                     : directions;
        mend_prolonged(s, lines, first_lengths(s, lines, stepped), progress);
        return;
    }
    const std::vector<double> thin = thin_heights(s);
    if (start == LineStart::shrunk) {
        shrink_until_valid(s, directions, first_lengths(s, directions, stepped), progress);
        if (count_pins(s) == 0)
            return;
    }
    // A pin holds back all vertices around it, which costs more than a thin start: the start with
    // fewer pins is taken.
    const std::vector<Vec3d> long_b = std::exchange(s.b, s.a);
    const std::vector<std::uint8_t> long_pinned = s.pinned;
    const std::ptrdiff_t long_pins = count_pins(s);
    shrink_until_valid(s, directions, thin, progress);
    if (start == LineStart::thin || count_pins(s) < long_pins)
        return;
    s.b = long_b;
    s.pinned = long_pinned;
}

} // namespace vdb_shell::growth

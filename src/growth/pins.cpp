// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell with pinned vertices. Leaves: a valid shell in which those have a pillar
// that the exact tests allow one. A release is a change like any other: all prisms and inner
// triangles around the vertex pass the tests before and after it (docs/theory.md, "Growth"). Where
// the pillars around it leave none, those are changed first, in the way that costs least volume.

#include "growth/pins.h"

#include "core/parallel.h"
#include "core/sort_unique.h"
#include "core/stage_stop.h"
#include "growth/move_tests.h"
#include "growth/other_components.h"
#include "growth/pillars_around_pin.h"
#include "growth/trust_radius.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

/// Of those beside v.
double mean_pillar(const GrowState& s, int v)
{
    double sum = 0;
    for (const int u : neighbours(*s.mesh, v))
        sum += (s.b[u] - s.a[u]).length();
    return sum / std::max(1, neighbours(*s.mesh, v).size());
}

// Which of them costs least differs from pin to pin, up to .6 % of the solid (scan falconstatue).
// Where the first does not do, none of the others does.
constexpr std::array<Shortening, 4> kShortenings{
    {{0.5, true}, {0.8, true}, {0.5, false}, {0.8, false}}};

/// Gives v a pillar along d, of that length or one of its halves.
bool place(GrowState& s, int v, const Vec3d& d, double length, const PillarsAround& around)
{
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
        if (around.valid())
            return true;
    }
    s.b[v] = s.a[v];
    s.pinned[v] = 1;
    return false;
}

/// Changes pillars until the vertex can have one of its own.
bool make_room(GrowState& s, int v, double length, double clear, PillarsBesidePin allowed,
               PillarsAround& around)
{
    for (bool look = true; look;) {
        const View view = best_view(s, v);
        if (view.least > 0 && place(s, v, view.direction, length, around))
            return true;
        const std::optional<View> beside = view_beside_pins(s, v, length, view);
        if (beside && beside->least > 0 && place(s, v, beside->direction, length, around))
            return true;
        // What is seen well and cannot be gone to has something else in the way.
        if (view.least < clear)
            look = allowed != PillarsBesidePin::kept && around.shorten(view, clear);
        else
            look = allowed == PillarsBesidePin::turned && around.turn(view.direction);
    }
    return false;
}

/// In the way that costs least.
bool release(GrowState& s, int v, double length, const std::vector<double>& visibility,
             PillarsBesidePin allowed)
{
    const double clear = clear_view(s, visibility[v]);
    double least_loss6 = std::numeric_limits<double>::infinity();
    std::vector<PillarEnd> best;
    for (const Shortening& shortening : kShortenings) {
        PillarsAround around(s, v, visibility, shortening);
        if (!make_room(s, v, length, clear, allowed, around)) {
            around.restore();
            break;
        }
        if (around.none_changed())
            return true;
        const double after6 = around.void6();
        std::vector<PillarEnd> ends = around.restore();
        const double loss6 = after6 - around.void6();
        if (loss6 < least_loss6) {
            least_loss6 = loss6;
            best = std::move(ends);
        }
    }
    for (const PillarEnd& p : best)
        s.b[p.vertex] = p.end;
    s.pinned[v] = best.empty();
    return !best.empty();
}

/// The vertices that are marked, and those beside one.
std::vector<std::uint8_t> with_neighbours(const GrowState& s,
                                          const std::vector<std::uint8_t>& marked)
{
    std::vector<std::uint8_t> all = marked;
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (marked[v])
            for (const int u : neighbours(*s.mesh, v))
                all[u] = 1;
    return all;
}

/// Boxes that hold the inner triangles wherever these vertices may go, and those around them, so
/// that the tree need not be refitted after each release. The tests need boxes that are large
/// enough, not tight.
void box_in(GrowState& s, const std::vector<double>& longest)
{
    assert(s.inner_tree.size() == s.mesh->faces.size());
    std::vector<std::uint8_t> around(s.b.size());
    std::transform(longest.begin(), longest.end(), around.begin(), [](double l) { return l > 0; });
    for (int ring = 0; ring < 2; ++ring)
        around = with_neighbours(s, around);
    s.inner_tree.refit([&](std::size_t i) {
        const int f = static_cast<int>(i);
        double most = 0;
        for (int k = 0; k < 3; ++k)
            most = std::max(most, longest[s.mesh->corner(f, k)]);
        const double wider = most > 0 ? (1 + kRadiusMargin) * most + s.rounding : 0;
        FloatBox box = float_box_of(inner_corners(s, f), wider);
        for (int k = 0; k < 3; ++k) {
            const int v = s.mesh->corner(f, k);
            // A pillar that is changed is at most half as long after it, in any direction, or lies
            // along what it was.
            if (around[v])
                box.add(float_box_of({s.a[v], s.a[v], s.a[v]},
                                     0.5 * (s.b[v] - s.a[v]).length() + 2 * s.rounding));
        }
        return box;
    });
}

// A release changes pillars up to two edges away: those beside the pin, and where one of these is
// turned, those beside that. Their triangles reach one edge farther.
constexpr int kChangedByRelease = 3;
// Those beside a pin are released as well. There are some hundred vertices within so many edges;
// where there are many more, triangles crowd around one of them, and all that follows would take
// the square of their number.
constexpr int kReach = kChangedByRelease + 1;
constexpr std::size_t kMostWithinReach = 2000;

// Under the three-tet test halving a pillar can make prisms beside it fail, so that theirs have to
// be halved too. That ends within five edges for all pins that were seen, but for those of one mesh
// (libigl's decimated-max): three of its six shells were left one pin, and none within twelve.
constexpr std::array<int, 2> kReachesUnderThree{kReach + 1, 3 * kReach};

/// The vertices within so many edges of v, v among them; none where there are too many.
std::vector<int> vertices_around(const GrowState& s, int v, int rings = kReach)
{
    std::vector<int> all{v};
    for (int ring = 0; ring < rings; ++ring) {
        const std::size_t count = all.size();
        for (std::size_t i = 0; i < count; ++i) {
            for (const int u : neighbours(*s.mesh, all[i]))
                all.push_back(u);
            if (all.size() > 10 * kMostWithinReach)
                return {};
        }
        sort_unique(all);
        if (all.size() > kMostWithinReach)
            return {};
    }
    return all;
}

/// Boxes that hold the inner triangles of these vertices wherever they go: no farther than
/// `longest` from their outer points, or than they are.
void widen_boxes(GrowState& s, const std::vector<int>& vertices, double longest)
{
    for (const int u : vertices) {
        const double wider = std::max(longest, (s.b[u] - s.a[u]).length()) + 2 * s.rounding;
        const FloatBox box = float_box_of({s.a[u], s.a[u], s.a[u]}, (1 + kRadiusMargin) * wider);
        for (const FaceCorner& at : star(*s.mesh, u))
            s.inner_tree.widen(static_cast<std::size_t>(at.face), box);
    }
}

void put(GrowState& s, const PillarEnd& p)
{
    s.b[p.vertex] = p.end;
    s.pinned[p.vertex] = p.end == s.a[p.vertex];
}

/// Half of u's pillar; where that does not see all triangles around u, as pillars under the
/// three-tet test need not, in the direction that sees them best.
Vec3d halved_arm(const GrowState& s, int u)
{
    const Vec3d arm = 0.5 * (s.b[u] - s.a[u]);
    const View view = view_of_surface(s, u);
    const bool sees = std::all_of(view.bounds.begin(), view.bounds.end(),
                                  [&](const Bound& bound) { return bound.normal.dot(arm) > 0; });
    return sees ? arm : arm.length() * view.direction;
}

/// Makes these prisms pass the twelve-tet test, under the three-tet test: of those that fail all
/// pillars are halved together, for single ones could not be, none but those of the vertices
/// `around`. As pillars see their triangles then, that ends, since the two ends of a short prism
/// are nearly alike. What is as short as a rounding becomes one of the `pins`, but only of the
/// vertices `near`. False where another pillar would have to be halved or taken away. Precondition:
/// the boxes of the inner tree hold what may be changed.
bool shorten_to_twelve_tets(GrowState& s, const std::vector<int>& prisms,
                            const std::vector<int>& around, const std::vector<int>& near,
                            std::vector<PillarEnd>& pins)
{
    constexpr int kRounds = 24; // a float has no more bits to lose
    const auto passes = [&](int f) {
        const bool twelve = std::binary_search(prisms.begin(), prisms.end(), f);
        return (twelve ? twelve_tets_valid(s, f) : prism_valid(s, f)) && inner_triangle_clear(s, f);
    };
    std::vector<int> look = prisms;
    for (int round = 0; round < kRounds; ++round) {
        std::vector<int> failing, shortened;
        std::copy_if(look.begin(), look.end(), std::back_inserter(failing),
                     [&](int f) { return !passes(f); });
        if (failing.empty())
            return true;
        for (const int f : failing)
            for (int k = 0; k < 3; ++k)
                if (const int u = s.mesh->corner(f, k); !s.pinned[u])
                    shortened.push_back(u);
        sort_unique(shortened);
        for (const int u : shortened) {
            const Vec3d end = rounded(s.a[u] + halved_arm(s, u));
            const std::vector<int>& allowed = end == s.a[u] ? near : around;
            if (!std::binary_search(allowed.begin(), allowed.end(), u))
                return false;
            if (end == s.a[u])
                pins.push_back({u, s.b[u]});
            put(s, {u, end});
        }
        look = faces_at(*s.mesh, shortened);
        look.insert(look.end(), failing.begin(), failing.end());
        sort_unique(look);
    }
    return false;
}

/// The ends of pillars, to go back to.
std::vector<PillarEnd> ends_of(const GrowState& s, const std::vector<int>& vertices)
{
    std::vector<PillarEnd> ends;
    ends.reserve(vertices.size());
    for (const int u : vertices)
        ends.push_back({u, s.b[u]});
    return ends;
}

/// Gives these vertices, which have none, a pillar, none longer than `longest` or than it was: the
/// one first that sees its triangles least, since a vertex that hardly sees them has to come before
/// those that are easily served. False where one of them has none in the end.
bool release_in_turn(GrowState& s, std::vector<PillarEnd> pins, double longest,
                     const std::vector<double>& visibility)
{
    std::stable_sort(pins.begin(), pins.end(), [&](const PillarEnd& p, const PillarEnd& q) {
        return visibility[p.vertex] < visibility[q.vertex];
    });
    return std::all_of(pins.begin(), pins.end(), [&](const PillarEnd& p) {
        const double length = std::max(longest, (p.end - s.a[p.vertex]).length());
        return release(s, p.vertex, length, visibility, PillarsBesidePin::turned);
    });
}

/// Takes their pillars from v and those beside it, and gives all of them one in turn. Under the
/// three-tet test another pillar can stand in the way even then: with `twelve_within`, prisms so
/// many edges around are made to pass the twelve-tet test before, and stay so. Nothing farther from
/// v than `reach` edges changes. False, with nothing changed, where one of them has none in the
/// end. Precondition: BoxTree::index_parents.
bool release_before_others(GrowState& s, int v, const std::vector<double>& visibility,
                           int reach = kReach, std::optional<int> twelve_within = std::nullopt)
{
    const std::vector<int> around = vertices_around(s, v, reach);
    if (around.empty())
        return false;
    const double longest =
        std::min(mean_edge(*s.mesh, s.a, v), s.schedule.pins.longest * s.diagonal);
    widen_boxes(s, around, longest);
    const std::vector<PillarEnd> before = ends_of(s, around);
    std::vector<PillarEnd> pins{{v, s.a[v]}};
    for (const int u : neighbours(*s.mesh, v))
        if (!s.pinned[u])
            pins.push_back({u, s.b[u]});
    for (const PillarEnd& p : pins)
        put(s, {p.vertex, s.a[p.vertex]});
    // Each release tests all that it changes, so what is valid in the end is so without these pins.
    bool done = false;
    if (!twelve_within) {
        done = release_in_turn(s, pins, longest, visibility);
    } else if (shorten_to_twelve_tets(s, faces_at(*s.mesh, vertices_around(s, v, *twelve_within)),
                                      around, vertices_around(s, v, reach - kChangedByRelease),
                                      pins)) {
        // Whatever passes this test passes the other.
        s.twelve = true;
        done = release_in_turn(s, pins, longest, visibility);
        s.twelve = false;
    }
    if (!done)
        for (const PillarEnd& p : before)
            put(s, p);
    return done;
}

/// In one of these ways. Releasing changes pillars up to three edges away; fewer prisms have to do
/// where one of them does not pass the twelve-tet test however short it is.
bool release_last(GrowState& s, int v, const std::vector<double>& visibility)
{
    if (release_before_others(s, v, visibility))
        return true;
    if (s.twelve)
        return false;
    for (const int reach : kReachesUnderThree)
        for (int rings = kReach - 1; rings > 0; --rings)
            if (release_before_others(s, v, visibility, reach, rings))
                return true;
    return false;
}

} // namespace

std::vector<int> pins_to_release(const GrowState& s, const std::vector<double>& visibility)
{
    std::vector<int> pins;
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (s.pinned[v] && visibility[v] > 0 && s.cap[v] > 0 && star(*s.mesh, v).size() > 0)
            pins.push_back(v);
    return pins;
}

double longest_release(const GrowState& s, int v)
{
    return std::min(mean_pillar(s, v), s.schedule.pins.longest * s.diagonal);
}

int release_pins(GrowState& s, const std::vector<double>& visibility, PillarsBesidePin beside)
{
    // One after another, never in parallel: each release changes what the next sees.
    const std::vector<int> pins = pins_to_release(s, visibility);
    if (pins.empty())
        return 0;
    std::vector<double> longest(s.b.size(), 0.0);
    for (const int v : pins)
        longest[v] = longest_release(s, v);
    box_in(s, longest);
    int released = 0;
    for (const int v : pins) {
        stop_if_stage_wants();
        released += release(s, v, longest[v], visibility, beside);
    }
    return released;
}

int release_last_pins(GrowState& s, const std::vector<double>& visibility,
                      const StageProgress& progress)
{
    int released = release_pins(s, visibility, PillarsBesidePin::turned);
    const std::vector<int> pins = pins_to_release(s, visibility);
    if (!pins.empty())
        s.inner_tree.index_parents();
    for (const int v : pins) {
        progress.stop_if_interrupted(100);
        released += release_last(s, v, visibility);
    }
    return released;
}

} // namespace vdb_shell::growth

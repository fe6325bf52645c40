// SPDX-License-Identifier: Apache-2.0

// Takes: the tets of a shell and what was asked of them. Gives: for each wish what was reached,
// which tets fall short, and why as far as the surface or the thickness tell. The causes are
// necessary ones only where they name the surface: no shell of it does better there
// (docs/theory.md, "What the surface bounds"). In doubles, on the float32 that are written.

#include "vdb_shell/taper/wanted_bounds.h"

#include "core/stage_stop.h"
#include "mesh/topology.h"
#include "vdb_shell/options/option.h"
#include "vdb_shell/shell/quality.h"
#include "vdb_shell/shell/surface_bounds.h"
#include "vdb_shell/shell/tessellate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

// A pillar that has this share of its cap is held by it: growth ends a little below.
constexpr double kAtCap = 0.999;

/// What the causes are looked up in.
struct Place {
    const ShellStack& stack;
    const TetMesh& tets;
    const TriangleMesh& surface;
    const std::vector<double>& cap;
    std::map<std::pair<std::uint32_t, std::uint32_t>, double> edge_angle;
};

/// Angles of all edges are for one wish only, so they are measured for that one alone.
Place look_around(const ShellStack& stack, const TetMesh& tets, const TriangleMesh& surface,
                  Side side, const std::vector<double>& cap, const WantedBounds& wanted)
{
    Place place{stack, tets, surface, cap, {}};
    if (!wanted.min_dihedral_radians)
        return place;
    for (const EdgeAngle& at : edge_angles(surface, side))
        // The smaller vertex first, as corners_on_skin gives them.
        place.edge_angle[{at.edge[0], at.edge[1]}] = at.radians;
    return place;
}

/// The vertices of the skin among the corners of a tet.
std::vector<std::uint32_t> corners_on_skin(const Place& at, std::size_t t)
{
    std::vector<std::uint32_t> vertices;
    for (int i = 0; i < 4; ++i)
        if (const std::uint32_t p = at.tets.tets[t][i]; at.tets.layer[p] == at.stack.skin)
            vertices.push_back(at.tets.source_vertex[p]);
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

/// Whether the tet has a triangle of the skin by which alone no tet could do better.
bool held_by_triangle(const Place& at, const std::vector<std::uint32_t>& skin, std::size_t t,
                      const WantedBound& bound)
{
    const openvdb::Vec3I& triangle = at.surface.triangles[at.tets.prism[t]];
    std::array<Vec3d, 3> p;
    for (int i = 0; i < 3; ++i) {
        if (!std::binary_search(skin.begin(), skin.end(), triangle[i]))
            return false;
        p[std::size_t(i)] = Vec3d(at.surface.points[triangle[i]]);
    }
    return (bound.kind == BoundKind::amips && least_amips(p[0], p[1], p[2]) > bound.asked) ||
           (bound.kind == BoundKind::edge_ratio &&
            least_edge_ratio(p[0], p[1], p[2]) > bound.asked);
}

/// Two triangles at an edge have two tets, one of which has half the angle of the solid there at
/// most. It may be this one.
bool held_by_edge(const Place& at, const std::vector<std::uint32_t>& skin, const WantedBound& bound)
{
    if (bound.kind != BoundKind::dihedral)
        return false;
    for (std::size_t i = 0; i < skin.size(); ++i)
        for (std::size_t j = i + 1; j < skin.size(); ++j) {
            const auto found = at.edge_angle.find({skin[i], skin[j]});
            if (found != at.edge_angle.end() && found->second < 2 * bound.asked)
                return true;
        }
    return false;
}

/// Where a length was asked for, a longer pillar might have made a better tet.
bool at_cap(const Place& at, std::uint32_t vertex)
{
    const double cap = at.cap[vertex];
    const Vec3d from(at.stack.surface(at.stack.skin)[vertex]);
    return std::isfinite(cap) &&
           (Vec3d(at.stack.surface(at.stack.layers.size())[vertex]) - from).length() >=
               kAtCap * cap;
}

/// The surface first, as it is the one cause that is proven; room is what is left.
ShortCause cause_of(const Place& at, std::size_t t, const WantedBound& bound)
{
    const std::vector<std::uint32_t> skin = corners_on_skin(at, t);
    if (held_by_triangle(at, skin, t, bound))
        return ShortCause::surface_triangle;
    if (held_by_edge(at, skin, bound))
        return ShortCause::surface_edge;
    const openvdb::Vec3I& triangle = at.surface.triangles[at.tets.prism[t]];
    for (int i = 0; i < 3; ++i)
        if (at_cap(at, triangle[i]))
            return ShortCause::thickness;
    return ShortCause::room;
}

/// Of a figure that each tet has by itself. `larger`: the larger the better.
WantedBound judge_shapes(const Place& at, const std::vector<TetShape>& shapes, BoundKind kind,
                         double TetShape::*figure, double asked, bool larger)
{
    WantedBound bound;
    bound.kind = kind;
    bound.asked = asked;
    // A shell without tets breaks no bound on them.
    bound.reached = shapes.empty() ? asked : shapes[0].*figure;
    for (std::size_t t = 0; t < shapes.size(); ++t) {
        const double value = shapes[t].*figure;
        bound.reached = larger ? std::min(bound.reached, value) : std::max(bound.reached, value);
        if (larger ? value >= asked : value <= asked)
            continue;
        const ShortCause cause = cause_of(at, t, bound);
        ++bound.short_tets;
        ++bound.causes[std::size_t(cause)];
        // In the order of tets: a few, to look at; the counts have them all.
        if (bound.first.size() < WantedBound::kFirstShown)
            bound.first.push_back(
                {std::uint32_t(t), at.tets.prism[t], at.tets.prism_layer[t], value, cause});
    }
    bound.met = bound.short_tets == 0;
    if (!bound.met)
        bound.shortfall = double(bound.short_tets) / double(shapes.size());
    return bound;
}

/// A wish about the shell as a whole, which no single tet falls short of.
WantedBound judge_whole(BoundKind kind, double asked, double reached, bool larger)
{
    WantedBound bound;
    bound.kind = kind;
    bound.asked = asked;
    bound.reached = reached;
    bound.met = larger ? reached >= asked : reached <= asked;
    // Of the larger one: of a fill what is missing of the one that was asked for, of tets those
    // that there should not be of all there are. So it is a share, as that of tets of a poor shape.
    if (!bound.met)
        bound.shortfall = std::abs(asked - reached) / std::max(asked, reached);
    return bound;
}

} // namespace

const NameTable<BoundKind>& names(BoundKind)
{
    static const NameTable<BoundKind> table{{"dihedral", BoundKind::dihedral},
                                            {"amips", BoundKind::amips},
                                            {"edge-ratio", BoundKind::edge_ratio},
                                            {"fill", BoundKind::fill},
                                            {"tets", BoundKind::tets}};
    return table;
}

const NameTable<ShortCause>& names(ShortCause)
{
    static const NameTable<ShortCause> table{{"surface-triangle", ShortCause::surface_triangle},
                                             {"surface-edge", ShortCause::surface_edge},
                                             {"thickness", ShortCause::thickness},
                                             {"room", ShortCause::room}};
    return table;
}

OptionList describe(WantedBounds& o)
{
    // That of a regular tet, arccos(1/3), rounded up to the digits that messages show, so that the
    // bound itself can be typed.
    constexpr double kMostDihedral = 1.23096;
    return in_group(
        "Bounds",
        {option("min_dihedral_radians", o.min_dihedral_radians, "--want-dihedral",
                "Want no dihedral angle smaller than this, radians")
             .in(Unit::radians)
             .within(above(0).at_most(kMostDihedral)),
         option("amips", o.amips, "--want-amips",
                "Want no tet of a larger AMIPS, 3 for a regular tet")
             .within(at_least(3)),
         option("edge_ratio", o.edge_ratio, "--want-edge-ratio",
                "Want no tet whose longest edge is more times its shortest")
             .within(at_least(1)),
         option("fill", o.fill, "--want-fill", "Want this share of the solid filled, 0 to 1")
             .in(Unit::share)
             .within(above(0).at_most(1)),
         option("tets", o.tets, "--want-tets", "Want no more tets than this")
             .in(Unit::count)
             .within(at_least(4))});
}

bool BoundsReport::met() const
{
    return std::all_of(bounds.begin(), bounds.end(), [](const WantedBound& b) { return b.met; });
}

double BoundsReport::shortfall() const
{
    double missed = 0, shares = 0;
    for (const WantedBound& bound : bounds) {
        missed += bound.met ? 0 : 1;
        shares += bound.shortfall;
    }
    // Shares are 1 at most, so their mean over all bounds is less than one more missed bound.
    return bounds.empty() ? 0 : missed + shares / double(bounds.size());
}

BoundsReport judge_bounds(const ShellStack& stack, const TetMesh& tets, const TriangleMesh& surface,
                          Side side, const std::vector<double>& cap, const WantedBounds& wanted)
{
    const Place at = look_around(stack, tets, surface, side, cap, wanted);
    std::vector<TetShape> shapes;
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        stop_if_stage_wants(t);
        shapes.push_back(shape_of(tets, t));
    }
    BoundsReport report;
    const auto add = [&](WantedBound bound) { report.bounds.push_back(std::move(bound)); };
    if (wanted.min_dihedral_radians)
        add(judge_shapes(at, shapes, BoundKind::dihedral, &TetShape::min_dihedral_radians,
                         *wanted.min_dihedral_radians, true));
    if (wanted.amips)
        add(judge_shapes(at, shapes, BoundKind::amips, &TetShape::amips, *wanted.amips, false));
    if (wanted.edge_ratio)
        add(judge_shapes(at, shapes, BoundKind::edge_ratio, &TetShape::edge_ratio,
                         *wanted.edge_ratio, false));
    if (wanted.fill)
        // What lies outside of the skin is no part of the solid.
        add(judge_whole(
            BoundKind::fill, *wanted.fill,
            tet_volume(tets, stack.skin) / signed_volume(surface.points, surface.triangles), true));
    if (wanted.tets)
        add(judge_whole(BoundKind::tets, double(*wanted.tets), double(tets.tets.size()), false));
    return report;
}

} // namespace vdb_shell

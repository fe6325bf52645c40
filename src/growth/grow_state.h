// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shell while it grows: positions, splits, pins, and what a round of moves needs.

#include "growth/box.h"
#include "growth/connectivity.h"
#include "growth/predicates.h"
#include "growth/prism.h"
#include "mesh/curve_order.h"
#include "vdb_shell/growth/schedule.h"
#include "vdb_shell/shell/prism_shell.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

/// Rounding a proposed place to float32 must not take a vertex out of its trust region. A place is
/// proposed this share of the radius inside it, and boxes are drawn as much wider than a step; so a
/// radius has to be so many roundings of a coordinate that this share of it is two of them.
inline constexpr double kRadiusMargin = 0.01;
inline constexpr double kLeastRadiusInRoundings = 2 / kRadiusMargin;

/// Invariant between any two moves: all prisms pass the exact tests, and no two triangles touch
/// (docs/theory.md, "Growth").
struct GrowState {
    const Connectivity* mesh = nullptr;
    GrowthSchedule schedule;
    std::vector<Vec3d> a, b;          ///< outer and inner points: float32 values held as doubles
    std::vector<std::uint8_t> pinned; ///< b_v = a_v; the tets that own the pillar do not exist
    std::vector<std::uint8_t> order;  ///< by face: index into PrismTables::order
    bool twelve = true;               ///< test all 12 tets of a prism, not the chosen 3
    std::vector<double> cap;          ///< upper bound of |b-a|, may be infinite
    double diagonal = 0;              ///< of the surface's box: the scale of all step lengths
    bool bounded = true; ///< the side to fill has a volume; the outside of a surface has none

    double rounding = 0; ///< how far rounding to float32 can move a point

    /// In a round a vertex stays within `trust_radius` of `trust_centre`; so long the boxes of the
    /// inner tree hold the inner triangles.
    std::vector<Vec3d> trust_centre;
    std::vector<double> trust_radius;
    BoxTree inner_tree, outer_tree;

    /// By face: contacts between two such are let be, as where the outer surface crosses itself.
    /// Empty: none is; else components may be anywhere.
    std::vector<std::uint8_t> excused;

    /// One vertex per component, ascending, to see a move that would enclose a whole other
    /// component.
    std::vector<int> witness;
};

GrowState make_state(const Connectivity& mesh, const std::vector<Vec3s>& outer,
                     const std::vector<double>& cap, const GrowthSchedule& schedule = {});

/// Puts a shell in place of the state's own, as shell_of gave it, with the orders of its prisms,
/// and builds the tree over its inner triangles. Any test that the shell passed it passes still.
void put_shell(GrowState& s, const PrismShell& shell, const std::vector<PrismOrder>& order);

/// Pillars no longer than this are lost in the rounding.
inline double shortest_pillar(const GrowState& s)
{
    return 2 * s.rounding;
}
/// Position of prism corner c (0..2 outer, 3..5 inner) of face f.
inline const Vec3d& corner_of(const GrowState& s, int f, int c)
{
    return c < 3 ? s.a[s.mesh->faces[f][c]] : s.b[s.mesh->faces[f][c - 3]];
}
/// Whether the tet of face f that owns local pillar `pillar` does not exist.
inline bool dropped(const GrowState& s, int f, int pillar)
{
    return s.pinned[s.mesh->faces[f][pillar]] != 0;
}
inline Corners inner_corners(const GrowState& s, int f)
{
    const Vec3I& t = s.mesh->faces[f];
    return {s.b[t[0]], s.b[t[1]], s.b[t[2]]};
}
inline Corners outer_corners(const GrowState& s, int f)
{
    const Vec3I& t = s.mesh->faces[f];
    return {s.a[t[0]], s.a[t[1]], s.a[t[2]]};
}
inline Box box_of(const Corners& c)
{
    Box b;
    for (const Vec3d& p : c)
        b.add(p);
    return b;
}
/// The same in floats, wider by `reach`.
inline FloatBox float_box_of(const Corners& c, double reach = 0)
{
    Box b = box_of(c);
    b.inflate(reach);
    return float_box(b);
}
/// Ids of the corners: outer vertex v is v, inner vertex v is V + v, or v where it is pinned.
inline CornerIds outer_ids(const GrowState& s, int f)
{
    return {s.mesh->corner(f, 0), s.mesh->corner(f, 1), s.mesh->corner(f, 2)};
}
inline CornerIds inner_ids(const GrowState& s, int f)
{
    CornerIds id = outer_ids(s, f);
    for (int& v : id)
        v += s.pinned[v] ? 0 : s.mesh->vertices;
    return id;
}

/// The shell as it is between two rounds, without reasons for its stops.
PrismShell shell_of(const TriangleMesh& mesh, const GrowState& s);
/// The shell of a mesh that was put in order, as that of the mesh before.
PrismShell shell_out_of_order(const PrismShell& shell, const MeshOrder& order);

/// Six times the signed volume enclosed.
double volume6(const std::vector<Vec3d>& p, const std::vector<Vec3I>& faces);
/// Gradient of the inner surface's volume6 in b_v.
Vec3d inner_volume6_gradient(const GrowState& s, int v);
/// What lies between the surfaces over what the outer one encloses, whichever side it lies on.
double fill_of(const GrowState& s);
/// Whether one of these is the user's thickness: neither infinite nor the 0 of a core's vertices.
bool bounds_thickness(const std::vector<double>& cap);
/// Whether the void is to be filled: an unbounded side has none to go by, and where the user bounds
/// the thickness most of it is meant to stay.
bool fills_void(const GrowState& s);

/// How many vertices are pinned.
std::ptrdiff_t count_pins(const GrowState& s);

/// The tree over the inner triangles as they are, anew or in its old shape; the latter where
/// `changed` says, empty: all.
void build_inner_tree(GrowState& s);
void refit_inner_tree(GrowState& s, const std::vector<std::uint8_t>& changed = {});
/// The box of the inner triangles around v, with b_v = x.
Box box_of_star(const GrowState& s, int v, const Vec3d& x);

} // namespace vdb_shell::growth

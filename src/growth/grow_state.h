// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shell while it grows: positions, splits, pins, and the exact tests one move needs.

#include "growth/box.h"
#include "growth/connectivity.h"
#include "growth/predicates.h"
#include "growth/prism.h"

#include <cstdint>
#include <vector>

namespace vdb_shell::growth
{

struct GrowState {
    const Connectivity* mesh = nullptr;
    std::vector<Vec3d> a, b;          ///< outer and inner points: float32 values held as doubles
    std::vector<std::uint8_t> pinned; ///< b_v = a_v; the tets that own the pillar do not exist
    std::vector<std::uint8_t> order;  ///< by face: index into PrismTables::order
    bool twelve = true;               ///< ask all 12 tets of a prism, not the chosen 3
    std::vector<double> cap;          ///< upper bound of |b-a|, may be infinite
    double diagonal = 0;              ///< of the surface's box: the scale of all step lengths
    bool bounded = true; ///< the side to fill has a volume; the outside of a surface has none

    double rounding = 0; ///< how far rounding to float32 can move a point

    // Broad phase: the boxes of the inner tree hold the triangles while every vertex stays within
    // `reach` of `home`.
    std::vector<Vec3d> home;
    std::vector<double> reach;
    BoxTree inner_tree, outer_tree;

    /// One vertex per component, to see a move that would swallow a whole other component.
    std::vector<int> witness;
};

GrowState make_state(const Connectivity& mesh, const std::vector<Vec3s>& outer,
                     const std::vector<double>& cap);

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

/// Six times the signed volume enclosed.
double volume6(const std::vector<Vec3d>& p, const std::vector<Vec3I>& faces);
/// Gradient of the inner surface's volume6 in b_v.
Vec3d inner_volume6_gradient(const GrowState& s, int v);
/// What lies between the surfaces over what the outer one encloses, whichever side it lies on.
double fill_of(const GrowState& s);

} // namespace vdb_shell::growth

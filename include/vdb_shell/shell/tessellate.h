// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/describe.h"
#include "vdb_shell/shell/prism_shell.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// How the diagonals of the prisms' quads are chosen. A quad over the edge {u,v} has its diagonal
/// from outer u to inner v when u comes before v; prisms on both sides see the same diagonal, so
/// the tets are conforming by construction (any order without a cycle inside a triangle will do:
/// docs/theory.md, "Splits").
enum class SplitRule {
    vertex_index,      ///< smaller index first: stable when lengths change
    length_descending, ///< longest pillar first, ties by index: the best shaped tets
    length_ascending,  ///< shortest pillar first, ties by index
    ripple,            ///< the randomised method of [9], for comparison
};
const NameTable<SplitRule>& names(SplitRule);

struct SplitOptions {
    SplitRule rule = SplitRule::length_descending;
    std::uint64_t seed = 1; ///< ripple only
};
OptionList describe(SplitOptions& options);

/// Per triangle, its three corners (0,1,2) from first to last in the order that fixes the
/// diagonals. A prism with order x,y,z splits into (ax,ay,az,bz), (ax,ay,by,bz), (ax,bx,by,bz).
struct PrismSplit {
    std::vector<std::array<std::uint8_t, 3>> order;
    std::size_t ripples = 0; ///< inconsistencies that the ripple method had to pass on
};

struct TetMesh {
    /// The outer vertices, then the inner vertex of each un-pinned one, both in the order of the
    /// surface. Every point is a corner of some tet: a vertex that is pinned together with all
    /// its neighbours has no tets, and no point here. Without such vertices, points[v] is outer[v].
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> tets; ///< det(b-a, c-a, d-a) > 0 when the tet is not inverted
    std::vector<std::uint32_t> prism; ///< per tet: the triangle above it
    std::vector<std::uint32_t> source_vertex; ///< per point: the surface vertex it belongs to
    /// Per point: its surface, 0 the outermost. Of one shell: 0 outer, 1 inner.
    std::vector<std::uint8_t> layer;
    std::vector<std::uint8_t> prism_layer; ///< per tet: the layer of its prism, 0 the outermost
};

/// Chooses the diagonals. Deterministic; the ripple method for a given seed.
/// Throws GeometryError when the ripple method cannot become consistent within its bound (it has no
/// proof of convergence; the other rules cannot fail).
PrismSplit split_prisms(const PrismShell& shell, const SplitOptions& options);

/// The tets in order of their prisms, in each from the outer to the inner triangle: three a prism,
/// less one for each pinned corner (its pillar's tet). The tets that are left meet face to face
/// (docs/theory.md, "The whole shell"), and their points are those of the shell bit for bit.
/// Precondition: `split` is consistent, as split_prisms gives it; every vertex is in a triangle, or
/// has no point in the result.
TetMesh make_tets(const PrismShell& shell, const PrismSplit& split);

/// Sum of the signed volumes of the tets of layer `first_layer` and of those further in, in index
/// order, world units cubed. Each volume is taken relative to a corner of its tet, so it is as
/// accurate far from the origin.
double tet_volume(const TetMesh& tets, std::size_t first_layer = 0);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shell while it is tapered: which vertices share which inner points, and where those are.

#include "core/box_tree.h"
#include "growth/connectivity.h"
#include "growth/predicates.h"
#include "growth/prism.h"
#include "vdb_shell/shell/shell_stack.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell::taper
{

using openvdb::Vec3d;
using openvdb::Vec3s;

/// What a set of tets costs: sum of tet + amips^exponent, less volume6 times what its volume is
/// worth.
struct CostWeights {
    double tet = 1;
    double exponent = 1.5;
    double volume6 = 0;     ///< of six times a volume
    double most_amips = 10; ///< a change may not make a worse tet than this, unless it was there
};

/// A *place* is a vertex on one of the surfaces of the stack: level * vertices + vertex, level 0
/// the outermost. A *node* is a point that one or several places share; the first nodes are the
/// places of level 0, which stay where they are. A *piece* is the prism of a face in a layer:
/// layer * faces + face. Its tets are those of its order, less those in which a node comes twice.
///
/// Invariant between any two changes: all tets are positive, and no triangle of the innermost
/// surface touches another one or an outer one but in common nodes.
struct TaperState {
    const growth::Connectivity* mesh = nullptr;
    int levels = 0;                       ///< of the innermost surface; as many layers
    std::vector<Vec3d> point;             ///< by node: float32 values held as doubles
    std::vector<int> node;                ///< by place
    std::vector<std::vector<int>> places; ///< by node, ascending; empty: it is used no longer
    /// By layer * edges + edge: whether the diagonal of the quad under the edge starts at the outer
    /// end of its smaller vertex. It means nothing while the quad is a triangle.
    std::vector<std::uint8_t> diagonal;
    std::vector<std::array<int, 2>> edges;          ///< vertices, the smaller first
    std::vector<std::array<int, 3>> edges_of_face;  ///< from local corner i to the next
    std::vector<std::array<int, 2>> faces_of_edge;
    std::vector<double> cap;              ///< by vertex: upper bound of its pillar, may be infinite
    CostWeights weights;
    bool vertical = false; ///< whether a place may become one with the place above it

    BoxTree inner_tree, outer_tree; ///< of the faces on the innermost and the outermost surface
    mutable std::vector<std::uint32_t> stamp; ///< by piece
    mutable std::uint32_t stamps = 0;

    int vertices() const { return mesh->vertices; }
    int faces() const { return mesh->face_count(); }
    bool fixed(int n) const { return n < mesh->vertices; }
    int node_at(int level, int vertex) const { return node[level * mesh->vertices + vertex]; }
    int corner(int level, int face, int local) const
    {
        return node_at(level, mesh->corner(face, local));
    }
};

TaperState make_taper_state(const growth::Connectivity& mesh, const ShellStack& stack,
                            const std::vector<double>& cap);

/// The stack with the points as they are now.
void put_back(const TaperState& s, ShellStack& stack);

/// The order of the piece that its diagonals make, an index into PrismTables::order; -1 where they
/// go round in a circle. A quad of which two corners are one node has no diagonal to keep to.
int order_of(const TaperState& s, int piece);

/// The nodes of a tet, and its orientation as PrismTables has it.
using TetNodes = std::array<int, 4>;

/// Calls visit(nodes) for each tet of the piece; false: its diagonals go round in a circle.
template <class Visit> bool for_each_tet(const TaperState& s, int piece, Visit&& visit)
{
    const int order = order_of(s, piece);
    if (order < 0)
        return false;
    const int face = piece % s.faces(), layer = piece / s.faces();
    std::array<int, 6> n;
    for (int i = 0; i < 3; ++i) {
        n[std::size_t(i)] = s.corner(layer, face, i);
        n[std::size_t(i) + 3] = s.corner(layer + 1, face, i);
    }
    for (const growth::OrientedTet& tet : growth::tables().three[std::size_t(order)]) {
        const TetNodes t{n[tet.corner[0]], n[tet.corner[1]], n[tet.corner[2]], n[tet.corner[3]]};
        if (t[0] != t[1] && t[0] != t[2] && t[0] != t[3] && t[1] != t[2] && t[1] != t[3] &&
            t[2] != t[3])
            visit(t);
    }
    return true;
}

/// The pieces that hold one of the nodes, each once, appended to `pieces`.
void list_pieces(const TaperState& s, int n, std::vector<int>& pieces);
/// To be called before the first list_pieces of a list.
inline void begin_list(const TaperState& s)
{
    ++s.stamps;
}

/// The cost of the pieces' tets, and the worst amips; `positive` is false, and the rest means
/// nothing, if a tet is not positive.
struct Cost {
    bool positive = true;
    double sum = 0, worst = 0;
    int tets = 0;
};
Cost cost_of(const TaperState& s, const std::vector<int>& pieces);

/// Whether the inner triangles among the pieces touch no other inner triangle and no outer one.
/// Two of the same corners may lie on each other if they face each other.
bool inner_triangles_clear(const TaperState& s, const std::vector<int>& pieces);

/// What inner triangles sweep over on their way to where a change takes them: for each of them the
/// tet of its old corners and of the new place of the corner that moves.
struct Swept {
    std::array<int, 3> nodes; ///< of the old triangle, renamed if the change does so
    int centre;               ///< the node that moves, or takes in the others
    std::array<Vec3d, 4> corners;
};
/// Appends the inner triangles among the pieces that have node `n`, with their fourth corner at x.
void list_swept(const TaperState& s, const std::vector<int>& pieces, int n, const Vec3d& x,
                std::vector<Swept>& swept);
/// Whether the change passed a node of an inner triangle to the other side: the winding number of
/// what is swept over is not nought there. Nodes of the fan that moves have no side.
bool passes_a_node(const TaperState& s, const std::vector<Swept>& swept);

/// Whether the pillars of all places of the node, were it at x, are as short as they have to be.
bool within_caps(const TaperState& s, int n, const Vec3d& x);

/// Tells the tree where the inner triangles among the pieces are now.
void update_tree(TaperState& s, const std::vector<int>& pieces);
void rebuild_tree(TaperState& s);

/// Counts and figures of the whole.
struct TaperFigures {
    std::size_t tets = 0, nodes = 0;
    double volume6 = 0, worst = 0, mean = 0, cost = 0;
};
TaperFigures figures_of(const TaperState& s);

} // namespace vdb_shell::taper

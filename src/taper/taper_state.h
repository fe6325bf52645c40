// SPDX-License-Identifier: Apache-2.0
#pragma once

// The shell while it is tapered: which vertices share which inner points, and where those are.

#include "core/box_tree.h"
#include "growth/connectivity.h"
#include "growth/prism.h"
#include "taper/tet_shape.h"
#include "vdb_shell/obstacles/join_cores.h"
#include "vdb_shell/shell/shell_stack.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell::taper
{

using openvdb::Vec3s;

/// What a set of tets costs: `tet` for each, its distortion to a power, less its volume times
/// `volume6`.
struct CostWeights {
    double tet = 1;
    double power = 1;            ///< of the distortion, at least 1
    double poor = 0;             ///< of a tet that breaks SOFA's rule, besides
    double volume6 = 0;          ///< of six times a volume
    double worst_distortion = 6; ///< a change makes no worse tet than this, unless there was one
};

/// Of the tets of one piece.
struct PieceCost {
    double distortion = 0; ///< sum of the powers
    double worst = 0;      ///< distortion
    double volume6 = 0;
    int tets = 0;
};

/// A *place* is a vertex on one of the surfaces of the stack: level * vertices + vertex, level 0
/// the outermost. A *node* is a point that one or several places share; the first nodes are the
/// places of level 0, which stay where they are. A *piece* is the prism of a face in a layer:
/// layer * faces + face. Its tets are those of its diagonals, less those that have a node twice.
///
/// Invariant between any two changes: all tets are positive, and the inner triangles, those of the
/// innermost surface that have three different nodes, touch each other and the outer triangles in
/// common nodes and edges only, unless two of them lie on each other and face each other.
struct TaperState {
    const growth::Connectivity* mesh = nullptr;
    int levels = 0;                       ///< of the innermost surface; as many layers
    std::vector<Vec3d> point;             ///< by node: float32 values held as doubles
    std::vector<int> node;                ///< by place
    std::vector<std::vector<int>> places; ///< by node, ascending; empty: it is used no longer
    std::vector<double> cap;              ///< by vertex: upper bound of its pillar, may be infinite

    /// By layer * edges + edge: whether the diagonal of the quad under the edge starts at the outer
    /// end of its smaller vertex. It means nothing while the quad is a triangle or an edge.
    std::vector<std::uint8_t> diagonal;
    std::vector<std::array<int, 2>> edges;         ///< vertices, the smaller first
    std::vector<std::array<int, 3>> edges_of_face; ///< from local corner i to the next
    std::vector<std::uint8_t>
        low_first; ///< by face, bit i: corner i is the smaller end of its edge i
    std::vector<std::array<int, 2>> faces_of_edge;

    VertexRange obstacles; ///< among the fixed nodes: nothing becomes one with them

    CostWeights weights;
    std::vector<PieceCost> cost; ///< by piece, of how it is now

    BoxTree inner_tree, outer_tree; ///< of the faces on the innermost and the outermost surface

    int vertices() const { return mesh->vertices; }
    int faces() const { return mesh->face_count(); }
    int pieces() const { return levels * faces(); } ///< fits: make_taper_state() sees to it
    int place(int level, int vertex) const { return level * vertices() + vertex; }
    int level_of(int place) const { return place / vertices(); }
    int vertex_of(int place) const { return place % vertices(); }
    int node_at(int level, int vertex) const { return node[std::size_t(place(level, vertex))]; }
    int corner(int level, int face, int local) const
    {
        return node_at(level, mesh->corner(face, local));
    }
    const Vec3d& at(int n) const { return point[std::size_t(n)]; }
    bool fixed(int n) const { return n < vertices(); }
    bool obstacle(int n) const { return obstacles.holds(std::uint32_t(n)); }
    bool used(int n) const { return !places[std::size_t(n)].empty(); }
    bool on_inner_surface(int n) const
    {
        return used(n) && places[std::size_t(n)].back() >= levels * vertices();
    }
    std::uint8_t& diagonal_of(int layer, int edge)
    {
        return diagonal[std::size_t(layer) * edges.size() + std::size_t(edge)];
    }
};

/// Precondition: the stack is valid and lies inward, its splits conform.
TaperState make_taper_state(const growth::Connectivity& mesh, const ShellStack& stack,
                            const std::vector<double>& cap, const CostWeights& weights);

/// Puts points and diagonals back into the stack that the state was made of.
void put_back(const TaperState& s, ShellStack& stack);

/// The nodes of a prism: three above, three below.
using PrismNodes = std::array<int, 6>;
inline PrismNodes nodes_of(const TaperState& s, int piece)
{
    const int layer = piece / s.faces();
    const openvdb::Vec3I& face = s.mesh->faces[std::size_t(piece % s.faces())];
    const int* above = s.node.data() + s.place(layer, 0);
    const int* below = above + s.vertices();
    return {above[face[0]], above[face[1]], above[face[2]],
            below[face[0]], below[face[1]], below[face[2]]};
}

/// A change of points that is only thought of: places of node `from` belong to node `to`, which
/// lies at `at`. With both the same a node has moved.
struct Substitution {
    static constexpr int kAllPlaces = -1;
    int from, to;
    Vec3d at;
    int place = kAllPlaces; ///< the one place of `from` that it is about
};

/// A prism with what its nodes are and where.
struct Piece {
    int index;
    PrismNodes nodes;
    std::array<Vec3d, 6> corners;
};
inline Piece piece_of(const TaperState& s, int index)
{
    const PrismNodes n = nodes_of(s, index);
    return {index, n, {s.at(n[0]), s.at(n[1]), s.at(n[2]), s.at(n[3]), s.at(n[4]), s.at(n[5])}};
}
inline Piece piece_of(const TaperState& s, int index, const Substitution& change)
{
    Piece piece = piece_of(s, index);
    if (change.place != Substitution::kAllPlaces) {
        const int level = s.level_of(change.place) - index / s.faces();
        for (int k = 0; k < 3; ++k)
            if (s.mesh->corner(index % s.faces(), k) == s.vertex_of(change.place)) {
                const auto i = static_cast<std::size_t>(3 * level + k);
                piece.nodes[i] = change.to;
                piece.corners[i] = change.at;
            }
        return piece;
    }
    for (std::size_t i = 0; i < piece.nodes.size(); ++i)
        if (piece.nodes[i] == change.from || piece.nodes[i] == change.to) {
            piece.nodes[i] = change.to;
            piece.corners[i] = change.at;
        }
    return piece;
}

/// By which of the three edges of a prism run forward, from corner i to the next: the order of the
/// corners, or -1.
const std::array<int, 8>& orders_by_diagonals();

/// The order of the piece that its diagonals make, an index into PrismTables::order; -1 where they
/// go round in a circle. A quad in which a node comes twice has no diagonal to keep to.
inline int order_of(const TaperState& s, int piece, const PrismNodes& n)
{
    static const std::array<int, 8>& orders = orders_by_diagonals();
    const int layer = piece / s.faces();
    const auto face = std::size_t(piece % s.faces());
    const std::array<int, 3>& e = s.edges_of_face[face];
    const std::uint8_t* from_low = s.diagonal.data() + std::size_t(layer) * s.edges.size();
    // Forward where the diagonal starts at the smaller vertex and that comes first, or neither.
    const unsigned forward =
        7U & ~((from_low[e[0]] | from_low[e[1]] << 1U | from_low[e[2]] << 2U) ^ s.low_first[face]);
    if (orders[forward] >= 0)
        return orders[forward];
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        if (n[i] == n[j] || n[i + 3] == n[j + 3] || n[i] == n[i + 3] || n[j] == n[j + 3])
            return orders[forward ^ (1U << i)];
    }
    return -1;
}

/// Calls visit(corners) for each tet of the piece, the corners as indices into its nodes and as its
/// orientation wants them; false: its diagonals go round in a circle.
template <class Visit>
bool for_each_tet(const TaperState& s, const Piece& piece, const Visit& visit)
{
    const PrismNodes& n = piece.nodes;
    const int order = order_of(s, piece.index, n);
    if (order < 0)
        return false;
    for (const growth::OrientedTet& tet : growth::tables().three[std::size_t(order)]) {
        const auto& [a, b, c, d] = tet.corner;
        if (n[a] != n[b] && n[a] != n[c] && n[a] != n[d] && n[b] != n[c] && n[b] != n[d] &&
            n[c] != n[d])
            visit(tet.corner);
    }
    return true;
}
template <class TetOfPrism> TetCorners corners_of(const Piece& piece, const TetOfPrism& tet)
{
    return {piece.corners[tet[0]], piece.corners[tet[1]], piece.corners[tet[2]],
            piece.corners[tet[3]]};
}

/// What of a piece costs what. False: it has a tet that is not positive, by the exact sign, or
/// diagonals in a circle.
bool measure(const TaperState& s, const Piece& piece, PieceCost& cost);

/// Whether the pillars of these places, did they end at x, are as short as they have to be.
bool within_caps(const TaperState& s, const std::vector<int>& places, const Vec3d& x);

} // namespace vdb_shell::taper

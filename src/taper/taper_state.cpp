// SPDX-License-Identifier: Apache-2.0

// Takes: a valid stack of layers. Gives: its points as nodes that places may share, its tets by
// nodes, and what they cost. Diagonals are kept by edge and not by prism, so neighbouring prisms
// agree whatever is changed, also where a quad comes back that had been a triangle for a while. The
// sign of a tet is exact; its shape, which only says what is worth doing, is computed in doubles.

#include "taper/taper_state.h"

#include "core/fail.h"
#include "growth/predicates.h"
#include "taper/inner_contacts.h"
#include "vdb_shell/core/error.h"

#include <algorithm>
#include <limits>
#include <tuple>

namespace vdb_shell::taper
{
namespace
{

/// Sorted by their vertices, so that the number of an edge does not depend on the order in which
/// faces name it.
void index_edges(TaperState& s)
{
    struct Side {
        int low, high, face, local;
    };
    std::vector<Side> sides;
    for (int f = 0; f < s.faces(); ++f)
        for (int i = 0; i < 3; ++i) {
            const int u = s.mesh->corner(f, i), v = s.mesh->corner(f, (i + 1) % 3);
            sides.push_back({std::min(u, v), std::max(u, v), f, i});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    s.edges_of_face.resize(s.mesh->faces.size());
    s.low_first.resize(s.mesh->faces.size());
    for (const Side& side : sides) {
        if (s.edges.empty() || s.edges.back() != std::array{side.low, side.high}) {
            s.edges.push_back({side.low, side.high});
            s.faces_of_edge.push_back({side.face, side.face});
        }
        s.faces_of_edge.back()[1] = side.face;
        s.edges_of_face[std::size_t(side.face)][std::size_t(side.local)] =
            static_cast<int>(s.edges.size()) - 1;
        const bool low_first = s.mesh->corner(side.face, side.local) == side.low;
        s.low_first[std::size_t(side.face)] |= std::uint8_t(unsigned(low_first) << side.local);
    }
}

void read_diagonals(TaperState& s, const PrismSplit& split)
{
    for (std::size_t e = 0; e < s.edges.size(); ++e) {
        const int f = s.faces_of_edge[e][0];
        // The diagonal begins at the outer end of the vertex that comes earlier in the order by
        // which the prism is cut (docs/theory.md, "Splits"). Both prisms beside the edge say the
        // same, as the split conforms; the first one is asked.
        const auto place_in_order = [&](int vertex) {
            const auto& order = split.order[std::size_t(f)];
            return std::find_if(order.begin(), order.end(), [&](std::uint8_t local) {
                return s.mesh->corner(f, local) == vertex;
            });
        };
        s.diagonal.push_back(place_in_order(s.edges[e][0]) < place_in_order(s.edges[e][1]));
    }
}

/// Places of equal coordinates one above the other are one node: a pin.
void read_points(TaperState& s, const ShellStack& stack)
{
    for (int level = 0; level <= s.levels; ++level)
        for (int v = 0; v < s.vertices(); ++v) {
            const Vec3s& p = stack.surface(std::size_t(level))[std::size_t(v)];
            // Only along a pillar. Points of different vertices that happen to be in one place stay
            // two nodes: the stack is not tapered yet.
            if (level > 0 && p == stack.surface(std::size_t(level - 1))[std::size_t(v)]) {
                s.node.push_back(s.node_at(level - 1, v));
                s.places[std::size_t(s.node.back())].push_back(s.place(level, v));
                continue;
            }
            s.node.push_back(static_cast<int>(s.point.size()));
            s.point.emplace_back(p);
            s.places.push_back({s.place(level, v)});
        }
}

/// See orders_by_diagonals().
std::array<int, 8> make_orders()
{
    std::array<int, 8> orders{};
    for (unsigned forward = 0; forward < 8; ++forward) {
        // Each corner before the next and the last before the first: no order does that.
        if (forward == 0 || forward == 7) {
            orders[forward] = -1;
            continue;
        }
        // The corner that comes first at both of its edges is the first of all.
        std::array<unsigned, 3> first{};
        for (unsigned i = 0; i < 3; ++i)
            ++first[(forward >> i & 1U) != 0 ? i : (i + 1) % 3];
        growth::PrismOrder order{};
        for (std::uint8_t i = 0; i < 3; ++i)
            order[2 - first[i]] = i;
        orders[forward] = growth::order_index(order);
    }
    return orders;
}

} // namespace

const std::array<int, 8>& orders_by_diagonals()
{
    static const std::array<int, 8> orders = make_orders();
    return orders;
}

TaperState make_taper_state(const growth::Connectivity& mesh, const ShellStack& stack,
                            const std::vector<double>& cap, const CostWeights& weights)
{
    // Places and pieces have numbers of 32 bits and a sign.
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    const std::size_t surfaces = stack.layers.size() + 1;
    const std::size_t elements = std::max(std::size_t(mesh.vertices), mesh.faces.size());
    if (surfaces * elements > kMost)
        fail<InvalidOption>("taper: ", surfaces - 1, " layers of ", mesh.faces.size(),
                            " triangles have more than 2^31 - 1 prisms or points; fewer layers "
                            "(--layers) or triangles (--decimate-to) can be tapered");
    TaperState s;
    s.weights = weights;
    s.mesh = &mesh;
    s.levels = static_cast<int>(stack.layers.size());
    s.cap = cap;
    index_edges(s);
    read_points(s, stack);
    for (const PrismSplit& split : stack.splits)
        read_diagonals(s, split);
    s.cost.resize(std::size_t(s.pieces()));
    for (int piece = 0; piece < s.pieces(); ++piece)
        // The stack is valid, so the answer whether the piece is positive is not looked at.
        measure(s, piece_of(s, piece), s.cost[std::size_t(piece)]);
    build_trees(s);
    return s;
}

void put_back(const TaperState& s, ShellStack& stack)
{
    for (int k = 0; k < s.levels; ++k) {
        PrismShell& layer = stack.layers[std::size_t(k)];
        for (int v = 0; v < s.vertices(); ++v) {
            layer.outer[std::size_t(v)] = Vec3s(s.at(s.node_at(k, v)));
            layer.inner[std::size_t(v)] = Vec3s(s.at(s.node_at(k + 1, v)));
        }
        for (int f = 0; f < s.faces(); ++f) {
            const int piece = k * s.faces() + f;
            // Every prism has an order in the stack, also one that has no tets left.
            stack.splits[std::size_t(k)].order[std::size_t(f)] =
                growth::tables().order[std::size_t(order_of(s, piece, nodes_of(s, piece)))];
        }
    }
}

bool measure(const TaperState& s, const Piece& piece, PieceCost& cost)
{
    cost = {};
    bool positive = true;
    const bool split = for_each_tet(s, piece, [&](const auto& tet) {
        if (!positive)
            return;
        const TetCorners p = corners_of(piece, tet);
        // The exact sign decides; the shape below may round as it likes.
        if (growth::orient(p[0], p[1], p[2], p[3]) <= 0) {
            positive = false;
            return;
        }
        // In doubles a volume that is exactly positive may come out as nought or less.
        const double volume = six_volumes(p);
        const double shape =
            volume > 0 ? distortion(squared_edges(p), volume) : std::numeric_limits<float>::max();
        cost.distortion += weighed(shape, s.weights.power);
        if (s.weights.poor > 0 && breaks_sofa_rule(p, volume))
            cost.distortion += s.weights.poor;
        cost.worst = std::max(cost.worst, shape);
        cost.volume6 += volume;
        ++cost.tets;
    });
    return positive && split;
}

bool within_caps(const TaperState& s, const std::vector<int>& places, const Vec3d& x)
{
    return std::all_of(places.begin(), places.end(), [&](int place) {
        const int v = s.vertex_of(place);
        // Exactly: a thickness that was asked for is a promise.
        return !exact::longer_than(Vec3s(s.at(v)), Vec3s(x), s.cap[std::size_t(v)]);
    });
}

} // namespace vdb_shell::taper

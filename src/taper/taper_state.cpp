// SPDX-License-Identifier: Apache-2.0

// Takes: a stack of layers, later single changes of it. Gives: its tets by nodes, what they cost,
// and the two exact tests that every change has to pass: positive tets, and inner triangles without
// contacts (docs/theory.md, "Tapering"). A test looks at what is stored, after the change has been
// made; whoever made it takes it back if it fails.

#include "taper/taper_state.h"

#include "growth/grow_state.h"
#include "shell/pillar.h"
#include "taper/tet_shape.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <tuple>

namespace vdb_shell::taper
{
namespace
{

using growth::Corners;
using growth::CornerIds;
using growth::FaceCorner;

struct InnerTriangle {
    CornerIds ids;
    Corners corners;
    bool flat() const { return ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0]; }
};

InnerTriangle inner_triangle(const TaperState& s, int face)
{
    InnerTriangle t{{s.corner(s.levels, face, 0), s.corner(s.levels, face, 1),
                     s.corner(s.levels, face, 2)},
                    {}};
    for (std::size_t i = 0; i < 3; ++i)
        t.corners[i] = s.point[std::size_t(t.ids[i])];
    return t;
}

/// Whether two triangles of the same corners run round them the same way.
bool same_turn(const CornerIds& s, const CornerIds& t)
{
    const auto first = std::size_t(std::find(t.begin(), t.end(), s[0]) - t.begin());
    return s[1] == t[(first + 1) % 3];
}

bool share_all(const CornerIds& s, const CornerIds& t)
{
    return std::is_permutation(s.begin(), s.end(), t.begin());
}

void index_edges(TaperState& s)
{
    const growth::Connectivity& m = *s.mesh;
    struct Side {
        int low, high, face, local;
    };
    std::vector<Side> sides;
    for (int f = 0; f < m.face_count(); ++f)
        for (int i = 0; i < 3; ++i) {
            const int u = m.corner(f, i), v = m.corner(f, (i + 1) % 3);
            sides.push_back({std::min(u, v), std::max(u, v), f, i});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    s.edges_of_face.resize(m.faces.size());
    for (const Side& side : sides) {
        if (s.edges.empty() || s.edges.back() != std::array{side.low, side.high}) {
            s.edges.push_back({side.low, side.high});
            s.faces_of_edge.push_back({side.face, side.face});
        }
        s.faces_of_edge.back()[1] = side.face;
        s.edges_of_face[std::size_t(side.face)][std::size_t(side.local)] =
            static_cast<int>(s.edges.size()) - 1;
    }
}

} // namespace

TaperState make_taper_state(const growth::Connectivity& mesh, const ShellStack& stack,
                            const std::vector<double>& cap)
{
    TaperState s;
    s.mesh = &mesh;
    s.levels = static_cast<int>(stack.layers.size());
    s.cap = cap;
    const int vertices = mesh.vertices;
    for (std::size_t level = 0; level < stack.surfaces(); ++level)
        for (int v = 0; v < vertices; ++v) {
            const int place = static_cast<int>(s.node.size());
            const Vec3s& p = stack.surface(level)[std::size_t(v)];
            if (level > 0 && p == stack.surface(level - 1)[std::size_t(v)]) {
                const int above = s.node[std::size_t(place - vertices)];
                s.node.push_back(above);
                s.places[std::size_t(above)].push_back(place);
                continue;
            }
            s.node.push_back(static_cast<int>(s.point.size()));
            s.point.emplace_back(p);
            s.places.push_back({place});
        }
    index_edges(s);
    for (const PrismSplit& split : stack.splits)
        for (std::size_t e = 0; e < s.edges.size(); ++e) {
            const int f = s.faces_of_edge[e][0];
            std::array<std::uint8_t, 2> local{};
            for (std::uint8_t i = 0; i < 3; ++i)
                for (std::size_t k = 0; k < 2; ++k)
                    if (mesh.corner(f, i) == s.edges[e][k])
                        local[k] = i;
            const auto& order = split.order[std::size_t(f)];
            s.diagonal.push_back(std::find(order.begin(), order.end(), local[0]) <
                                 std::find(order.begin(), order.end(), local[1]));
        }
    s.stamp.assign(std::size_t(s.levels) * mesh.faces.size(), 0);
    std::vector<FloatBox> outer;
    for (int f = 0; f < mesh.face_count(); ++f) {
        FloatBox box = FloatBox::around(Vec3s(s.point[std::size_t(mesh.corner(f, 0))]));
        for (int i = 1; i < 3; ++i)
            box.add(Vec3s(s.point[std::size_t(mesh.corner(f, i))]));
        outer.push_back(box);
    }
    s.outer_tree.build(std::move(outer));
    rebuild_tree(s);
    return s;
}

void put_back(const TaperState& s, ShellStack& stack)
{
    const auto vertices = static_cast<std::size_t>(s.vertices());
    for (std::size_t k = 0; k < stack.layers.size(); ++k) {
        for (std::size_t v = 0; v < vertices; ++v) {
            stack.layers[k].outer[v] = Vec3s(s.point[std::size_t(s.node[k * vertices + v])]);
            stack.layers[k].inner[v] = Vec3s(s.point[std::size_t(s.node[(k + 1) * vertices + v])]);
        }
        for (std::size_t f = 0; f < stack.splits[k].order.size(); ++f)
            stack.splits[k].order[f] = growth::tables().order[std::size_t(
                order_of(s, static_cast<int>(k * stack.splits[k].order.size() + f)))];
    }
}

int order_of(const TaperState& s, int piece)
{
    const int face = piece % s.faces(), layer = piece / s.faces();
    // The corner that comes first twice is the first of all, the one that never does the last.
    std::array<int, 3> first{};
    std::array<bool, 3> forward{};
    for (std::size_t i = 0; i < 3; ++i) {
        const int e = s.edges_of_face[std::size_t(face)][i];
        const bool from_low =
            s.diagonal[std::size_t(layer) * s.edges.size() + std::size_t(e)] != 0;
        forward[i] = from_low == (s.mesh->corner(face, int(i)) == s.edges[std::size_t(e)][0]);
    }
    if (forward[0] == forward[1] && forward[1] == forward[2]) {
        std::size_t free = 3;
        for (std::size_t i = 0; i < 3 && free == 3; ++i) {
            const int u = int(i), v = int((i + 1) % 3);
            const int au = s.corner(layer, face, u), av = s.corner(layer, face, v),
                      bu = s.corner(layer + 1, face, u), bv = s.corner(layer + 1, face, v);
            if (au == av || bu == bv || au == bu || av == bv)
                free = i;
        }
        if (free == 3)
            return -1;
        forward[free] = !forward[free];
    }
    for (std::size_t i = 0; i < 3; ++i)
        ++first[forward[i] ? i : (i + 1) % 3];
    growth::PrismOrder order{};
    for (std::uint8_t i = 0; i < 3; ++i)
        order[std::size_t(2 - first[i])] = i;
    return growth::order_index(order);
}

void list_pieces(const TaperState& s, int n, std::vector<int>& pieces)
{
    const int vertices = s.vertices(), faces = s.faces();
    for (const int place : s.places[std::size_t(n)]) {
        const int level = place / vertices, v = place % vertices;
        for (const FaceCorner& at : star(*s.mesh, v))
            for (int layer = std::max(0, level - 1); layer < std::min(s.levels, level + 1); ++layer) {
                const int piece = layer * faces + at.face;
                if (s.stamp[std::size_t(piece)] == s.stamps)
                    continue;
                s.stamp[std::size_t(piece)] = s.stamps;
                pieces.push_back(piece);
            }
    }
}

Cost cost_of(const TaperState& s, const std::vector<int>& pieces)
{
    Cost cost;
    double volume6 = 0;
    for (const int piece : pieces) {
        const bool split = for_each_tet(s, piece, [&](const TetNodes& t) {
            if (!cost.positive)
                return;
            const std::array<Vec3d, 4> p{s.point[std::size_t(t[0])], s.point[std::size_t(t[1])],
                                         s.point[std::size_t(t[2])], s.point[std::size_t(t[3])]};
            if (growth::orient(p[0], p[1], p[2], p[3]) <= 0) {
                cost.positive = false;
                return;
            }
            // In doubles an exactly positive volume may come out as nought or less; the shape is
            // without bound then.
            const double six = six_volumes(p[0], p[1], p[2], p[3]);
            const double shape = six > 0 ? amips(p, six) : 1e30;
            cost.sum += s.weights.tet + std::pow(shape, s.weights.exponent);
            cost.worst = std::max(cost.worst, shape);
            volume6 += six;
            ++cost.tets;
        });
        cost.positive = cost.positive && split;
        if (!cost.positive)
            return cost;
    }
    cost.sum -= s.weights.volume6 * volume6;
    return cost;
}

bool inner_triangles_clear(const TaperState& s, const std::vector<int>& pieces)
{
    const int faces = s.faces(), last = (s.levels - 1) * faces;
    for (const int piece : pieces) {
        if (piece < last)
            continue;
        const int f = piece - last;
        const InnerTriangle t = inner_triangle(s, f);
        if (t.flat())
            continue;
        // With all its tets dropped but for those beside it, nothing has shown that it has an area.
        if (exact::collinear(Vec3s(t.corners[0]), Vec3s(t.corners[1]), Vec3s(t.corners[2])))
            return false;
        const FloatBox box = growth::float_box_of(t.corners);
        const exact::PlaneFilter plane(t.corners[0], t.corners[1], t.corners[2]);
        bool clear = true;
        const auto meets = [&](const CornerIds& ids, const Corners& corners) {
            int first = 0;
            bool one_side = true;
            for (std::size_t k = 0; k < 3; ++k) {
                if (ids[k] == t.ids[0] || ids[k] == t.ids[1] || ids[k] == t.ids[2])
                    continue;
                const int side = plane.side(corners[k]);
                one_side = one_side && side != 0 && (first == 0 || side == first);
                first = side;
            }
            return !(one_side && first != 0) &&
                   growth::improper_contact(t.corners, t.ids, corners, ids);
        };
        s.inner_tree.for_each_overlap(box, [&](int g) {
            if (!clear || g == f)
                return;
            const InnerTriangle other = inner_triangle(s, g);
            if (other.flat())
                return;
            if (share_all(t.ids, other.ids))
                clear = !same_turn(t.ids, other.ids);
            else
                clear = !meets(other.ids, other.corners);
        });
        s.outer_tree.for_each_overlap(box, [&](int g) {
            if (!clear)
                return;
            const CornerIds ids{s.mesh->corner(g, 0), s.mesh->corner(g, 1), s.mesh->corner(g, 2)};
            const Corners corners{s.point[std::size_t(ids[0])], s.point[std::size_t(ids[1])],
                                  s.point[std::size_t(ids[2])]};
            clear = share_all(t.ids, ids) || !meets(ids, corners);
        });
        if (!clear)
            return false;
    }
    return true;
}

void list_swept(const TaperState& s, const std::vector<int>& pieces, int n, const Vec3d& x,
                std::vector<Swept>& swept)
{
    const int last = (s.levels - 1) * s.faces();
    for (const int piece : pieces) {
        if (piece < last)
            continue;
        const InnerTriangle t = inner_triangle(s, piece - last);
        if (!t.flat() && (t.ids[0] == n || t.ids[1] == n || t.ids[2] == n))
            swept.push_back({t.ids, n, {t.corners[0], t.corners[1], t.corners[2], x}});
    }
}

namespace
{

/// Sorts what is swept by fans, those that share a node besides the centre, and calls
/// visit(first, last) for each.
template <class Visit> void for_each_fan(std::vector<Swept> swept, const Visit& visit)
{
    const auto linked = [](const Swept& a, const Swept& b) {
        for (const int i : a.nodes)
            for (const int j : b.nodes)
                if (i == j && i != a.centre)
                    return true;
        return false;
    };
    const std::size_t count = swept.size();
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
        end = begin + 1;
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t j = end; j < count; ++j)
                if (linked(swept[i], swept[j]))
                    std::swap(swept[j], swept[end++]);
        visit(swept.data() + begin, swept.data() + end);
    }
}

/// The tet's share of the winding number at p; `on_it` if that is on its surface.
int winding_of(const Swept& tet, const Vec3d& p, bool& on_it)
{
    const auto& [a, b, c, d] = tet.corners;
    const int turn = growth::orient(a, b, c, d);
    if (turn == 0)
        return 0;
    const std::array<int, 4> side{
        growth::orient(p, b, c, d) * turn, growth::orient(a, p, c, d) * turn,
        growth::orient(a, b, p, d) * turn, growth::orient(a, b, c, p) * turn};
    const int least = *std::min_element(side.begin(), side.end());
    on_it = on_it || least == 0;
    return least > 0 ? turn : 0;
}

} // namespace

bool passes_a_node(const TaperState& s, const std::vector<Swept>& swept)
{
    bool passes = false;
    for_each_fan(swept, [&](const Swept* first, const Swept* last) {
        if (passes)
            return;
        FloatBox all = FloatBox::around(Vec3s(first->corners[3]));
        for (const Swept* tet = first; tet != last; ++tet)
            for (const Vec3d& p : tet->corners)
                all.add(Vec3s(p));
        const auto of_fan = [&](int n) {
            return std::any_of(first, last, [&](const Swept& tet) {
                return std::find(tet.nodes.begin(), tet.nodes.end(), n) != tet.nodes.end();
            });
        };
        s.inner_tree.for_each_overlap(all, [&](int g) {
            if (passes)
                return;
            const InnerTriangle other = inner_triangle(s, g);
            if (other.flat())
                return;
            const auto passes_over = [&](const Vec3d& p) {
                int winding = 0;
                bool on_one = false;
                for (const Swept* tet = first; tet != last; ++tet)
                    winding += winding_of(*tet, p, on_one);
                return winding != 0 || on_one;
            };
            int of_it = 0;
            for (std::size_t i = 0; i < 3 && !passes; ++i) {
                const Vec3d& p = other.corners[i];
                const bool shared = other.ids[i] == first->centre || of_fan(other.ids[i]);
                of_it += shared;
                passes = !shared && all.contains(Vec3s(p)) && passes_over(p);
            }
            if (passes || of_it < 3)
                return;
            // Behind a triangle that another one faces there is no void to move into.
            passes = std::any_of(first, last, [&](const Swept& tet) {
                const auto& [a, b, c, x] = tet.corners;
                return std::find(other.ids.begin(), other.ids.end(), tet.centre) ==
                           other.ids.end() &&
                       share_all(other.ids, tet.nodes) && !same_turn(other.ids, tet.nodes) &&
                       growth::orient(a, b, c, x) < 0;
            });
            if (passes)
                return;
            // All of its nodes lie on what is swept over; a point of it tells, unless it is one of
            // the triangles that the change makes or one that faces it.
            const bool of_change = std::any_of(first, last, [&](const Swept& tet) {
                const auto has = [&](int n) {
                    return std::find(other.ids.begin(), other.ids.end(), n) != other.ids.end();
                };
                int common = 0;
                for (const int n : tet.nodes)
                    common += has(n);
                return common == 3 || (common >= 2 && has(tet.centre));
            });
            if (!of_change)
                passes = passes_over(growth::rounded(
                    (other.corners[0] + other.corners[1] + other.corners[2]) / 3.0));
        });
    });
    return passes;
}

bool within_caps(const TaperState& s, int n, const Vec3d& x)
{
    const auto& places = s.places[std::size_t(n)];
    return std::all_of(places.begin(), places.end(), [&](int place) {
        const auto v = std::size_t(place % s.vertices());
        return !exact::longer_than(Vec3s(s.point[v]), Vec3s(x), s.cap[v]);
    });
}

void update_tree(TaperState& s, const std::vector<int>& pieces)
{
    const int last = (s.levels - 1) * s.faces();
    for (const int piece : pieces)
        if (piece >= last)
            s.inner_tree.widen(std::size_t(piece - last),
                               growth::float_box_of(inner_triangle(s, piece - last).corners));
}

void rebuild_tree(TaperState& s)
{
    std::vector<FloatBox> boxes;
    for (int f = 0; f < s.faces(); ++f)
        boxes.push_back(growth::float_box_of(inner_triangle(s, f).corners));
    s.inner_tree.build(std::move(boxes));
    s.inner_tree.index_parents();
}

TaperFigures figures_of(const TaperState& s)
{
    TaperFigures figures;
    for (int piece = 0; piece < s.levels * s.faces(); ++piece)
        for_each_tet(s, piece, [&](const TetNodes& t) {
            const std::array<Vec3d, 4> p{s.point[std::size_t(t[0])], s.point[std::size_t(t[1])],
                                         s.point[std::size_t(t[2])], s.point[std::size_t(t[3])]};
            const double six = six_volumes(p[0], p[1], p[2], p[3]);
            const double shape = six > 0 ? amips(p, six) : 1e30;
            ++figures.tets;
            figures.volume6 += six;
            figures.worst = std::max(figures.worst, shape);
            figures.mean += shape;
            figures.cost += s.weights.tet + std::pow(shape, s.weights.exponent);
        });
    figures.mean /= static_cast<double>(std::max<std::size_t>(1, figures.tets));
    for (std::size_t n = std::size_t(s.vertices()); n < s.places.size(); ++n)
        figures.nodes += !s.places[n].empty();
    return figures;
}

} // namespace vdb_shell::taper

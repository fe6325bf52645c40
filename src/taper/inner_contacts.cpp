// SPDX-License-Identifier: Apache-2.0

// Takes: a state in which a change has been made. Gives: whether the inner surface still touches
// nothing, and whether it was taken past a part of itself on the way. Both are needed: a fan that
// jumps over a small part of the surface touches nothing afterwards, but covers twice what lies
// between (docs/theory.md, "Tapered shells"). All signs are exact.

#include "taper/inner_contacts.h"

#include "core/disjoint_sets.h"
#include "core/sort_unique.h"
#include "growth/grow_state.h"
#include "growth/predicates.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell::taper
{
namespace
{

using growth::CornerIds;
using growth::Corners;

/// A face on a surface of the stack, by the nodes that its corners are now.
struct InnerTriangle {
    CornerIds ids;
    Corners corners;

    InnerTriangle(const TaperState& s, int level, int face)
        : ids{s.corner(level, face, 0), s.corner(level, face, 1), s.corner(level, face, 2)},
          corners{s.at(ids[0]), s.at(ids[1]), s.at(ids[2])}
    {
    }
    /// It has lost its area, with a node that comes twice.
    bool gone() const { return ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0]; }
    bool has(int n) const { return ids[0] == n || ids[1] == n || ids[2] == n; }
};

/// Pieces of the last layer: only their inner triangles are those of the innermost surface.
int first_inner_piece(const TaperState& s)
{
    return (s.levels - 1) * s.faces();
}

/// By nodes: points that are one have one number, so no coordinates are compared.
bool same_corners(const CornerIds& s, const CornerIds& t)
{
    return std::is_permutation(s.begin(), s.end(), t.begin());
}

/// Whether two triangles of the same corners run round them the same way.
bool same_turn(const CornerIds& s, const CornerIds& t)
{
    const auto first = static_cast<std::size_t>(std::find(t.begin(), t.end(), s[0]) - t.begin());
    return s[1] == t[(first + 1) % 3];
}

/// One triangle held against many.
class Held
{
public:
    explicit Held(const InnerTriangle& t)
        : triangle_(t), plane_(t.corners[0], t.corners[1], t.corners[2])
    {
    }
    bool touches(const InnerTriangle& other) const
    {
        // With all corners that are not common strictly on one side of the plane, nothing but
        // common corners is in both.
        int side = 0;
        bool one_side = true;
        for (std::size_t k = 0; k < 3 && one_side; ++k) {
            if (triangle_.has(other.ids[k]))
                continue;
            const int now = plane_.side(other.corners[k]);
            one_side = now != 0 && (side == 0 || now == side);
            side = now;
        }
        return !(one_side && side != 0) &&
               growth::improper_contact(triangle_.corners, triangle_.ids, other.corners, other.ids);
    }

private:
    const InnerTriangle& triangle_;
    exact::PlaneFilter plane_;
};

bool triangle_clear(const TaperState& s, int face, const InnerTriangle& t)
{
    // Where all tets that have the triangle were dropped, nothing shows that it has an area.
    if (exact::collinear(Vec3s(t.corners[0]), Vec3s(t.corners[1]), Vec3s(t.corners[2])))
        return false;
    const FloatBox box = growth::float_box_of(t.corners);
    const Held held(t);
    bool clear = true;
    s.inner_tree.for_each_overlap(box, [&](int g) {
        if (!clear || g == face)
            return;
        const InnerTriangle other(s, s.levels, g);
        if (!other.gone())
            // Two that lie on each other may face each other: there the void has closed. Turned
            // alike they would have the shell on one side of them twice.
            clear = same_corners(t.ids, other.ids) ? !same_turn(t.ids, other.ids)
                                                   : !held.touches(other);
    });
    s.outer_tree.for_each_overlap(box, [&](int g) {
        if (!clear)
            return;
        const InnerTriangle outer(s, 0, g);
        // An inner triangle may be an outer one itself, where the shell has no thickness.
        clear = same_corners(t.ids, outer.ids) || !held.touches(outer);
    });
    return clear;
}

/// A swept tet as often as it is asked about points.
struct SweptTet {
    const Swept* of;
    FloatBox box;
    int turn; ///< its orientation; 0: flat

    explicit SweptTet(const Swept& swept) : of(&swept), box(FloatBox::around(Vec3s(of->corners[0])))
    {
        const auto& [a, b, c, d] = of->corners;
        for (const Vec3d& p : {b, c, d})
            box.add(Vec3s(p));
        turn = growth::orient(a, b, c, d);
    }
    /// Its share of the winding number at p; `on_it` is set if p is on its surface.
    int winding_at(const Vec3d& p, bool& on_it) const
    {
        // A flat tet covers nothing, and nothing can be inside it.
        if (turn == 0 || !box.contains(Vec3s(p)))
            return 0;
        const auto& [a, b, c, d] = of->corners;
        const std::array<int, 4> side{
            growth::orient(p, b, c, d) * turn, growth::orient(a, p, c, d) * turn,
            growth::orient(a, b, p, d) * turn, growth::orient(a, b, c, p) * turn};
        const int least = *std::min_element(side.begin(), side.end());
        // None of the four is negative and one is 0, so the point is on its surface.
        on_it = on_it || least == 0;
        return least > 0 ? turn : 0;
    }
};

bool among(const std::vector<int>& sorted, int value)
{
    return std::binary_search(sorted.begin(), sorted.end(), value);
}

/// Whether one of the faces has the corners of the triangle.
bool faces_one_of(const TaperState& s, const std::vector<int>& faces, const InnerTriangle& t)
{
    return std::any_of(faces.begin(), faces.end(), [&](int face) {
        return same_corners(t.ids, InnerTriangle(s, s.levels, face).ids);
    });
}

/// The swept tets of one fan: those that hang together by nodes other than the moving ones.
class SweptFan
{
public:
    SweptFan(const Swept* first, const Swept* last, const std::array<int, 2>& moving)
        : nodes_{moving[0], moving[1]}
    {
        for (const Swept* tet = first; tet != last; ++tet) {
            tets_.emplace_back(*tet);
            nodes_.insert(nodes_.end(), tet->nodes.begin(), tet->nodes.end());
        }
        sort_unique(nodes_);
        box_ = tets_.front().box;
        for (const SweptTet& tet : tets_)
            box_.add(tet.box);
    }

    /// Whether the fan went past a part of the inner surface; `changed` are the faces that have
    /// moved, ascending.
    bool passes(const TaperState& s, const std::vector<int>& changed) const
    {
        std::vector<int> others, on_fan;
        // What lies outside the box is not swept over, so the faces of few boxes stand for the
        // whole surface.
        s.inner_tree.for_each_overlap(box_, [&](int face) {
            const InnerTriangle t(s, s.levels, face);
            if (t.gone())
                return;
            int of_fan = 0;
            for (const int n : t.ids)
                among(nodes_, n) ? void(++of_fan) : others.push_back(n);
            // All of its nodes lie on what is swept over, where winding numbers mean nothing.
            if (of_fan == 3 && !among(changed, face))
                on_fan.push_back(face);
        });
        sort_unique(others);
        return std::any_of(others.begin(), others.end(),
                           [&](int n) { return winding_at(s.at(n)); }) ||
               std::any_of(on_fan.begin(), on_fan.end(), [&](int face) {
                   const InnerTriangle t(s, s.levels, face);
                   return !faces_one_of(s, changed, t) && passes(t);
               });
    }

private:
    /// The same of a triangle that has not moved, has no node of its own, and faces none that has.
    bool passes(const InnerTriangle& t) const
    {
        for (const SweptTet& tet : tets_)
            if (same_corners(t.ids, tet.of->nodes))
                // It faces an old triangle. Behind that one there is no void to move into, and
                // below nought means that the place lies behind.
                return tet.turn < 0;
        return winding_near_middle(t);
    }
    /// Whether it is swept over in its middle. That is no float32, so all floats around it are
    /// asked: a doubt makes a change fail, never pass.
    bool winding_near_middle(const InnerTriangle& t) const
    {
        const Vec3d middle = (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0;
        double size = 0;
        for (int k = 0; k < 3; ++k)
            size = std::max(size, std::abs(middle[k]));
        const double rounding = size * double(std::numeric_limits<float>::epsilon());
        if (winding_at(growth::rounded(middle)))
            return true;
        for (int k = 0; k < 3; ++k)
            for (const double by : {-rounding, rounding}) {
                Vec3d beside = middle;
                beside[k] += by;
                if (winding_at(growth::rounded(beside)))
                    return true;
            }
        return false;
    }
    bool winding_at(const Vec3d& p) const
    {
        if (!box_.contains(Vec3s(p)))
            return false;
        int winding = 0;
        bool on_it = false;
        for (const SweptTet& tet : tets_)
            winding += tet.winding_at(p, on_it);
        return winding != 0 || on_it;
    }
    std::vector<SweptTet> tets_;
    std::vector<int> nodes_; ///< moving ones and those of old triangles, ascending
    FloatBox box_{};
};

/// Brings swept tets of one fan together, and calls visit(first, last) for each fan until one
/// returns true; whether one did.
template <class Visit>
bool any_fan(const std::vector<Swept>& swept, const std::array<int, 2>& moving, const Visit& visit)
{
    const auto count = std::uint32_t(swept.size());
    DisjointSets fans(count);
    std::vector<std::pair<int, std::uint32_t>> uses;
    for (std::uint32_t i = 0; i < count; ++i)
        for (const int n : swept[i].nodes)
            if (n != moving[0] && n != moving[1])
                uses.emplace_back(n, i);
    std::sort(uses.begin(), uses.end());
    for (std::size_t i = 1; i < uses.size(); ++i)
        if (uses[i].first == uses[i - 1].first)
            fans.join(uses[i].second, uses[i - 1].second);
    // A root is its fan's first tet, so fans come in the order of those.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < count; ++i)
        order.emplace_back(fans.root_of(i), i);
    std::sort(order.begin(), order.end());
    std::vector<Swept> sorted;
    sorted.reserve(count);
    for (const auto& [root, i] : order)
        sorted.push_back(swept[i]);
    for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
        while (end < count && order[end].first == order[begin].first)
            ++end;
        if (visit(sorted.data() + begin, sorted.data() + end))
            return true;
    }
    return false;
}

} // namespace

void build_trees(TaperState& s)
{
    std::vector<FloatBox> outer;
    outer.reserve(s.mesh->faces.size());
    for (int f = 0; f < s.faces(); ++f)
        outer.push_back(growth::float_box_of(InnerTriangle(s, 0, f).corners));
    s.outer_tree.build(outer);
    rebuild_inner_tree(s);
}

void rebuild_inner_tree(TaperState& s)
{
    std::vector<FloatBox> boxes;
    boxes.reserve(s.mesh->faces.size());
    for (int f = 0; f < s.faces(); ++f)
        boxes.push_back(growth::float_box_of(InnerTriangle(s, s.levels, f).corners));
    s.inner_tree.build(boxes);
    // For widen, which goes from a leaf of the tree up to its root.
    s.inner_tree.index_parents();
}

void update_inner_tree(TaperState& s, const std::vector<int>& pieces)
{
    for (const int piece : pieces)
        if (const int face = piece - first_inner_piece(s); face >= 0)
            s.inner_tree.widen(std::size_t(face),
                               growth::float_box_of(InnerTriangle(s, s.levels, face).corners));
}

bool inner_triangles_clear(const TaperState& s, const std::vector<int>& pieces)
{
    return std::all_of(pieces.begin(), pieces.end(), [&](int piece) {
        const int face = piece - first_inner_piece(s);
        if (face < 0)
            return true;
        const InnerTriangle t(s, s.levels, face);
        // A triangle without area is no part of the surface; what is left of it are edges of
        // others, which are asked.
        return t.gone() || triangle_clear(s, face, t);
    });
}

void list_swept(const TaperState& s, const std::vector<int>& pieces, int n,
                std::vector<Swept>& swept)
{
    for (const int piece : pieces) {
        const int face = piece - first_inner_piece(s);
        if (face < 0)
            continue;
        const InnerTriangle t(s, s.levels, face);
        if (!t.gone() && t.has(n))
            swept.push_back({t.ids, {t.corners[0], t.corners[1], t.corners[2], Vec3d(0.0)}});
    }
}

bool passes_itself(const TaperState& s, const std::vector<Swept>& swept,
                   const std::vector<int>& pieces, const std::array<int, 2>& moving)
{
    // Pieces also change by their other corners; the triangles that moved have the moved node.
    std::vector<int> changed;
    for (const int piece : pieces)
        if (const int face = piece - first_inner_piece(s);
            face >= 0 && InnerTriangle(s, s.levels, face).has(moving[1]))
            changed.push_back(face);
    std::sort(changed.begin(), changed.end());
    return any_fan(swept, moving, [&](const Swept* first, const Swept* last) {
        return SweptFan(first, last, moving).passes(s, changed);
    });
}

} // namespace vdb_shell::taper

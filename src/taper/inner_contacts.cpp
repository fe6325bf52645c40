// SPDX-License-Identifier: Apache-2.0

// Takes: a state in which a change has been made. Gives: whether the inner surface still touches
// nothing, and whether it was taken past a part of itself on the way. Both are needed: a fan that
// jumps over a small part of the surface touches nothing afterwards, but covers twice what lies
// between (docs/theory.md, "Tapered shells"). All signs are exact.

#include "taper/inner_contacts.h"

#include "growth/grow_state.h"
#include "growth/predicates.h"

#include <algorithm>

namespace vdb_shell::taper
{
namespace
{

using growth::CornerIds;
using growth::Corners;

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

int first_inner_piece(const TaperState& s)
{
    return (s.levels - 1) * s.faces();
}

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
            clear = same_corners(t.ids, other.ids) ? !same_turn(t.ids, other.ids)
                                                   : !held.touches(other);
    });
    s.outer_tree.for_each_overlap(box, [&](int g) {
        if (!clear)
            return;
        const InnerTriangle outer(s, 0, g);
        clear = same_corners(t.ids, outer.ids) || !held.touches(outer);
    });
    return clear;
}

/// The tet's share of the winding number at p; `on_it` is set if p is on its surface.
int winding_of(const TetCorners& tet, const Vec3d& p, bool& on_it)
{
    const auto& [a, b, c, d] = tet;
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

/// The swept tets of one fan: those that share a node besides the moving ones.
class SweptFan
{
public:
    SweptFan(const Swept* first, const Swept* last, const std::array<int, 2>& moving)
        : first_(first), last_(last), moving_(moving)
    {
        for (const Swept* tet = first; tet != last; ++tet)
            for (const Vec3d& p : tet->corners)
                tet == first&&& p == tet->corners.data() ? void(box_ = FloatBox::around(Vec3s(p)))
                                                         : box_.add(Vec3s(p));
    }
    const FloatBox& box() const { return box_; }

    /// Whether the fan went past the triangle, which is as it is after the change.
    bool passes(const InnerTriangle& t) const
    {
        int on_fan = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            if (of_fan(t.ids[i]))
                ++on_fan;
            else if (box_.contains(Vec3s(t.corners[i])) && winding_at(t.corners[i]))
                return true;
        }
        if (on_fan < 3)
            return false;
        // All of its nodes lie on what is swept over, where winding numbers mean nothing.
        if (makes(t))
            return false;
        return moves_behind(t) ||
               winding_at(growth::rounded((t.corners[0] + t.corners[1] + t.corners[2]) / 3.0));
    }

private:
    bool moves(int n) const { return n == moving_[0] || n == moving_[1]; }
    bool of_fan(int n) const
    {
        return moves(n) || std::any_of(first_, last_, [n](const Swept& tet) {
                   return tet.nodes[0] == n || tet.nodes[1] == n || tet.nodes[2] == n;
               });
    }
    bool winding_at(const Vec3d& p) const
    {
        int winding = 0;
        bool on_it = false;
        for (const Swept* tet = first_; tet != last_; ++tet)
            winding += winding_of(tet->corners, p, on_it);
        return winding != 0 || on_it;
    }
    /// Whether the triangle is one that the change has made, or faces one: such a triangle has the
    /// node that took the others in, and two nodes of an old one.
    bool makes(const InnerTriangle& t) const
    {
        return t.has(moving_[1]) && std::any_of(first_, last_, [&](const Swept& tet) {
                   return std::count_if(tet.nodes.begin(), tet.nodes.end(),
                                        [&](int n) { return n != moving_[1] && t.has(n); }) >= 2;
               });
    }
    /// Whether it faces an old triangle and the fan went behind that one, where there is no void.
    bool moves_behind(const InnerTriangle& t) const
    {
        return std::any_of(first_, last_, [&](const Swept& tet) {
            const auto& [a, b, c, x] = tet.corners;
            return same_corners(t.ids, tet.nodes) && !same_turn(t.ids, tet.nodes) &&
                   growth::orient(a, b, c, x) < 0;
        });
    }

    const Swept *first_, *last_;
    std::array<int, 2> moving_;
    FloatBox box_{};
};

} // namespace

void build_trees(TaperState& s)
{
    std::vector<FloatBox> outer;
    for (int f = 0; f < s.faces(); ++f)
        outer.push_back(growth::float_box_of(InnerTriangle(s, 0, f).corners));
    s.outer_tree.build(std::move(outer));
    rebuild_inner_tree(s);
}

void rebuild_inner_tree(TaperState& s)
{
    std::vector<FloatBox> boxes;
    for (int f = 0; f < s.faces(); ++f)
        boxes.push_back(growth::float_box_of(InnerTriangle(s, s.levels, f).corners));
    s.inner_tree.build(std::move(boxes));
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

bool passes_itself(const TaperState& s, std::vector<Swept>& swept, const std::array<int, 2>& moving)
{
    const auto linked = [&](const Swept& a, const Swept& b) {
        for (const int i : a.nodes)
            for (const int j : b.nodes)
                if (i == j && i != moving[0] && i != moving[1])
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
        const SweptFan fan(swept.data() + begin, swept.data() + end, moving);
        bool passes = false;
        s.inner_tree.for_each_overlap(fan.box(), [&](int g) {
            if (passes)
                return;
            const InnerTriangle other(s, s.levels, g);
            passes = !other.gone() && fan.passes(other);
        });
        if (passes)
            return true;
    }
    return false;
}

} // namespace vdb_shell::taper

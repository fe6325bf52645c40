// SPDX-License-Identifier: Apache-2.0

// Takes: a state, and a move or a prism. Gives: whether a whole other component would come to lie
// in the shell. A component that touches no triangle lies inside with all of its points or with
// none, so one of them tells, its witness. Of few components all witnesses are looked at. Of many,
// each has two triangles in the trees of the contact tests, one outer and one inner, and those near
// a box are found there; so a component costs the others nothing that are not beside it.

#include "growth/other_components.h"

#include "growth/move_tests.h"

#include <algorithm>

namespace vdb_shell::growth
{
namespace
{

// Two walks through trees cost about as much as so many tests of a point against a box.
constexpr std::size_t kFew = 32;

/// Whether p lies in the closed tet, of either orientation: what a move sweeps over may have
/// either. A point on its surface counts as inside, so a doubt makes a move fail, never pass.
bool in_tet(const Corners& base, const Vec3d& apex, const Vec3d& p)
{
    const auto& [a, b, c] = base;
    const int s0 = orient(a, b, c, p), s1 = orient(a, c, apex, p), s2 = orient(a, apex, b, p),
              s3 = orient(b, apex, c, p);
    return (s0 >= 0 && s1 >= 0 && s2 >= 0 && s3 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0 && s3 <= 0);
}

/// Whether holds(p) for an outer or inner point p in the box that is a witness of another component
/// than `own`. It may be asked about a point more than once.
template <class Holds>
bool any_witness(const GrowState& s, int own, const Box& box, WitnessSearch search,
                 const Holds& holds)
{
    const Connectivity& m = *s.mesh;
    const auto tells = [&](const Vec3d& e) { return box.contains(e) && holds(e); };
    if (search == WitnessSearch::one_by_one || s.witness.size() <= kFew) {
        for (const int w : s.witness)
            if (m.component[w] != own && (tells(s.a[w]) || tells(s.b[w])))
                return true;
        return false;
    }
    bool found = false;
    const auto look_in = [&](const BoxTree& tree, const std::vector<Vec3d>& points) {
        tree.for_each_overlap_while(float_box(box), [&](int f) {
            for (int k = 0; k < 3 && m.component[m.corner(f, 0)] != own && !found; ++k)
                found = is_witness(s, m.corner(f, k)) && tells(points[m.corner(f, k)]);
            return !found;
        });
    };
    look_in(s.outer_tree, s.a);
    if (!found)
        look_in(s.inner_tree, s.b);
    return found;
}

bool alone(const GrowState& s)
{
    return s.mesh->components < 2 || !s.excused.empty();
}

} // namespace

bool is_witness(const GrowState& s, int v)
{
    return std::binary_search(s.witness.begin(), s.witness.end(), v);
}

bool swallows_component(const GrowState& s, int v, const Vec3d& x, WitnessSearch search)
{
    if (alone(s))
        return false;
    const Connectivity& m = *s.mesh;
    for (const FaceCorner& at : star(m, v)) {
        const Vec3d& p = s.b[m.corner(at.face, (at.local + 1) % 3)];
        const Vec3d& q = s.b[m.corner(at.face, (at.local + 2) % 3)];
        // A triangle of the star sweeps over the tet of its two resting corners and both places of
        // v. A component within it that touches no surface would come to lie in this one's shell,
        // and one of its points tells; the box is there to spare most of the exact tests.
        Box swept = box_of({s.b[v], p, q});
        swept.add(x);
        if (any_witness(s, m.component[v], swept, search, [&](const Vec3d& e) {
                return in_tet({s.b[v], x, p}, q, e);
            }))
            return true;
    }
    return false;
}

bool holds_component(const GrowState& s, int f, WitnessSearch search)
{
    if (alone(s))
        return false;
    Box box = box_of(outer_corners(s, f));
    box.add(box_of(inner_corners(s, f)));
    // By the present split. While the diagonals of neighbours do not conform yet, a point close to
    // a side may be in the tets of neither; the certificate at the end decides by winding numbers.
    return any_witness(
        s, s.mesh->component[s.mesh->corner(f, 0)], box, search, [&](const Vec3d& e) {
            for (const OrientedTet& tet : tables().three[s.order[f]])
                if (!dropped(s, f, tet.pillar) &&
                    in_tet({corner_of(s, f, tet.corner[0]), corner_of(s, f, tet.corner[1]),
                            corner_of(s, f, tet.corner[2])},
                           corner_of(s, f, tet.corner[3]), e))
                    return true;
            return false;
        });
}

} // namespace vdb_shell::growth

// SPDX-License-Identifier: Apache-2.0

// Takes: a shell whose pillars have just been placed. Gives: which prisms fail the exact tests of
// the certificate, conditions 2, 3, 5 and 6 of docs/theory.md, "The whole shell", so that their
// pillars can be shortened until none does. Only faces that have changed are tested again.

#include "growth/violations.h"

#include "core/marked.h"
#include "core/parallel.h"
#include "core/sort_unique.h"
#include "core/triangle_pairs.h"
#include "growth/move_tests.h"
#include "growth/other_components.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <optional>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

bool prism_fails(const GrowState& s, int f)
{
    return !prism_valid(s, f) || holds_component(s, f);
}

using Marks = std::vector<std::atomic<std::uint8_t>>;

// Only ones are ever written, and a test is left out only if all that it could mark is marked. So
// the marks are the same whichever thread comes first, and no order of memory is needed.
void mark(std::atomic<std::uint8_t>& entry)
{
    entry.store(1, std::memory_order_relaxed);
}

/// By vertex, for the corners of the faces that changed: whether doubles show for certain that the
/// inner triangles around it do not meet each other.
std::vector<std::uint8_t> embedded_fans(const GrowState& s,
                                        const std::vector<std::uint8_t>& changed)
{
    std::vector<std::uint8_t> embedded(s.b.size(), 0);
    for_each_index(embedded.size(), [&](std::size_t i) {
        const int v = static_cast<int>(i);
        const Slice<FaceCorner> around = star(*s.mesh, v);
        embedded[i] = std::any_of(around.begin(), around.end(),
                                  [&](const FaceCorner& at) { return changed[at.face] != 0; }) &&
                      inner_fan_surely_embedded(s, v);
    });
    return embedded;
}

/// The contact tests of the faces that changed and are not known to be bad yet.
class ContactSearch
{
public:
    ContactSearch(const GrowState& s, const std::vector<std::uint8_t>& tested,
                  const std::vector<std::uint8_t>& changed, Marks& bad)
        : s_(s), tested_(tested), embedded_(embedded_fans(s, changed)), bad_(bad)
    {
    }

    /// The same marks for a surface with crowds, where the boxes of nearly all triangles around one
    /// vertex overlap.
    void mark_in_crowds() const
    {
        const std::size_t faces = tested_.size();
        std::vector<Vec3s> points(s_.a.begin(), s_.a.end());
        points.insert(points.end(), s_.b.begin(), s_.b.end());
        // The outer triangles, then the inner ones.
        std::vector<Vec3I> triangles = s_.mesh->faces;
        for (int f = 0; f < s_.mesh->face_count(); ++f) {
            const CornerIds id = inner_ids(s_, f);
            triangles.emplace_back(id[0], id[1], id[2]);
        }
        const auto meet = [&](std::uint32_t i, std::uint32_t j) {
            if (j < faces)
                return false;
            const int g = static_cast<int>(j - faces);
            if (i < faces)
                return tested_[g] != 0 && InnerTriangle(s_, g).meets_outer(static_cast<int>(i));
            const int f = static_cast<int>(i - faces);
            return (tested_[f] || tested_[g]) && !share_embedded_fan(f, g) &&
                   InnerTriangle(s_, f).meets_inner(g);
        };
        for (const auto& [i, j] : overlapping_triangles(points, triangles, meet)) {
            mark(bad_[j - faces]);
            if (i >= faces)
                mark(bad_[i - faces]);
        }
    }

    /// Marks the faces of one range of groups of the inner tree that touch others. `most`: most
    /// faces are tested, so that each pair is better looked for from one of its faces alone.
    void mark_groups(std::size_t begin, std::size_t end, bool most) const
    {
        BoxTree::Near near;
        // Pairs come face by face, so the plane of the first one is computed once for all of its
        // pairs.
        std::optional<InnerTriangle> triangle;
        const auto of = [&](int f) -> const InnerTriangle& {
            if (!triangle || triangle->face() != f)
                triangle.emplace(s_, f);
            return *triangle;
        };
        const auto tested = [&](int f) { return tested_[f] != 0; };
        const auto mark_pair = [&](int f, int g) {
            // Only if it could mark one of them.
            if ((bad_[f] && bad_[g]) || share_embedded_fan(f, g) || !of(f).meets_inner(g))
                return;
            mark(bad_[f]);
            mark(bad_[g]);
        };
        for (std::size_t group = begin; group < end; ++group) {
            if (most)
                s_.inner_tree.for_each_pair_of(group, near, [&](int f, int g) {
                    if (tested(f) || tested(g))
                        mark_pair(f, g);
                });
            else
                s_.inner_tree.for_each_overlap_of(group, s_.inner_tree, near, tested,
                                                  [&](int f, int g) {
                                                      // Each pair once where both are tested.
                                                      if (f != g && (!tested(g) || f < g))
                                                          mark_pair(f, g);
                                                  });
            s_.inner_tree.for_each_overlap_of(group, s_.outer_tree, near, tested,
                                              [&](int f, int g) {
                                                  if (!bad_[f] && of(f).meets_outer(g))
                                                      mark(bad_[f]);
                                              });
        }
    }

private:
    bool share_embedded_fan(int f, int g) const
    {
        const Connectivity& m = *s_.mesh;
        for (int k = 0; k < 3; ++k)
            if (embedded_[m.corner(f, k)] && m.incident_to(g, m.corner(f, k)))
                return true;
        return false;
    }

    const GrowState& s_;
    const std::vector<std::uint8_t>& tested_;
    std::vector<std::uint8_t> embedded_;
    Marks& bad_;
};

/// Marks the triangles that touch others in a place where they should not, of those that `changed`
/// and are not marked yet.
void mark_contacts(const GrowState& s, const std::vector<std::uint8_t>& changed, Marks& bad)
{
    std::vector<std::uint8_t> tested(changed.size());
    for_each_index(tested.size(), [&](std::size_t f) { tested[f] = changed[f] && !bad[f]; });
    const ContactSearch search(s, tested, changed, bad);
    if (s.mesh->has_crowds)
        return search.mark_in_crowds();
    const auto asked = static_cast<std::size_t>(std::count(tested.begin(), tested.end(), 1));
    const bool most = 2 * asked > tested.size();
    for_each_range(
        s.inner_tree.groups(),
        [&](std::size_t begin, std::size_t end) { search.mark_groups(begin, end, most); }, 4);
}

/// By face, whether one of these witnesses may have come to lie in its prism.
std::vector<std::uint8_t> prisms_near(const GrowState& s, const std::vector<int>& witnesses)
{
    std::vector<FloatBox> points;
    points.reserve(witnesses.size());
    for (const int w : witnesses)
        points.push_back(float_box(box_of({s.b[w], s.b[w], s.b[w]})));
    BoxTree tree;
    tree.build(points);
    std::vector<std::uint8_t> near(s.mesh->faces.size(), 0);
    for_each_index(
        near.size(),
        [&](std::size_t i) {
            const int f = static_cast<int>(i);
            Box prism = box_of(outer_corners(s, f));
            prism.add(box_of(inner_corners(s, f)));
            tree.for_each_overlap_while(float_box(prism), [&](int) { return !(near[i] = 1); });
        },
        256);
    return near;
}

/// Those of the witnesses that can tell something, of which moved(vertex) is true.
template <class Moved> std::vector<int> witnesses_of(const GrowState& s, const Moved& moved)
{
    std::vector<int> found;
    if (s.mesh->components > 1)
        std::copy_if(s.witness.begin(), s.witness.end(), std::back_inserter(found), moved);
    return found;
}

} // namespace

std::vector<std::uint8_t> violating_faces(GrowState& s, const std::vector<std::uint8_t>& changed,
                                          bool first)
{
    first ? build_inner_tree(s) : refit_inner_tree(s, changed);
    Marks bad(changed.size());
    for_each_index(bad.size(), [&](std::size_t i) {
        const int f = static_cast<int>(i);
        if (changed[f] && prism_fails(s, f))
            mark(bad[f]);
    });
    // A face that fails already is not tested for contacts: its pillars will be shortened anyway,
    // and contact tests are the dearer ones.
    mark_contacts(s, changed, bad);
    std::vector<std::uint8_t> found(bad.size());
    for_each_index(
        found.size(), [&](std::size_t f) { found[f] = bad[f]; }, 4096);
    return found;
}

std::vector<int> violating_among(GrowState& s, const std::vector<int>& changed)
{
    for (const int f : changed)
        s.inner_tree.replace(static_cast<std::size_t>(f), float_box_of(inner_corners(s, f)));
    std::vector<std::vector<int>> bad_beside(changed.size());
    for_each_index(
        changed.size(),
        [&](std::size_t i) {
            const int f = changed[i];
            std::vector<int>& bad = bad_beside[i];
            if (prism_fails(s, f)) {
                bad.push_back(f);
                return;
            }
            const InnerTriangle triangle(s, f);
            const FloatBox box = float_box_of(triangle.corners());
            s.inner_tree.for_each_overlap(box, [&](int g) {
                if (g != f && triangle.meets_inner(g))
                    bad.push_back(g);
            });
            bool meets = !bad.empty();
            if (!meets)
                s.outer_tree.for_each_overlap_while(
                    box, [&](int g) { return !(meets = triangle.meets_outer(g)); });
            if (meets)
                bad.push_back(f);
        },
        16);
    std::vector<int> all;
    for (const std::vector<int>& bad : bad_beside)
        all.insert(all.end(), bad.begin(), bad.end());
    sort_unique(all);
    return all;
}

bool faces_valid(const GrowState& s, const std::vector<int>& faces)
{
    // Contact tests are the dearer ones.
    return std::none_of(faces.begin(), faces.end(), [&](int f) { return prism_fails(s, f); }) &&
           std::all_of(faces.begin(), faces.end(),
                       [&](int f) { return inner_triangle_clear(s, f); });
}

std::vector<std::uint8_t> free_corners_of(const GrowState& s, const std::vector<std::uint8_t>& bad)
{
    std::vector<std::uint8_t> corners(s.b.size(), 0);
    for (int f = 0; f < s.mesh->face_count(); ++f)
        for (int k = 0; bad[f] && k < 3; ++k) {
            const int v = s.mesh->corner(f, k);
            // A pin has nothing left to shorten.
            corners[v] = !s.pinned[v];
        }
    return corners;
}

std::vector<int> free_corners_of(const GrowState& s, const std::vector<int>& bad)
{
    std::vector<int> corners;
    for (const int f : bad)
        for (int k = 0; k < 3; ++k)
            if (const int v = s.mesh->corner(f, k); !s.pinned[v])
                corners.push_back(v);
    sort_unique(corners);
    return corners;
}

std::vector<std::uint8_t> faces_around(const GrowState& s, const std::vector<std::uint8_t>& moved)
{
    const Connectivity& m = *s.mesh;
    const std::vector<int> witnesses = witnesses_of(s, [&](int w) { return moved[w] != 0; });
    std::vector<std::uint8_t> faces =
        witnesses.empty() ? std::vector<std::uint8_t>(m.faces.size()) : prisms_near(s, witnesses);
    for_each_index(
        faces.size(),
        [&](std::size_t i) {
            const int f = static_cast<int>(i);
            if (moved[m.corner(f, 0)] || moved[m.corner(f, 1)] || moved[m.corner(f, 2)])
                faces[i] = 1;
        },
        4096);
    return faces;
}

std::vector<int> faces_around(const GrowState& s, const std::vector<int>& moved)
{
    std::vector<int> faces = faces_at(*s.mesh, moved);
    const std::vector<int> witnesses =
        witnesses_of(s, [&](int w) { return std::binary_search(moved.begin(), moved.end(), w); });
    if (witnesses.empty())
        return faces;
    const std::vector<int> near = marked(prisms_near(s, witnesses));
    faces.insert(faces.end(), near.begin(), near.end());
    sort_unique(faces);
    return faces;
}

} // namespace vdb_shell::growth

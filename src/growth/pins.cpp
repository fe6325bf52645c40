// SPDX-License-Identifier: Apache-2.0

// Takes: a valid shell with pinned vertices. Leaves: a valid shell in which those have a pillar
// that the exact tests allow one. A release is a change like any other: all prisms and inner
// triangles around the vertex pass the tests before and after it (docs/theory.md, "Growth"). Where
// the neighbours' pillars leave no direction, they are shortened first: short enough they always
// leave one to a vertex that the surface itself does not pin (docs/theory.md, "Pins that geometry
// demands").

#include "growth/pins.h"

#include "core/parallel.h"
#include "growth/move_tests.h"
#include "growth/other_components.h"
#include "mesh/most_visible.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace vdb_shell::growth
{
namespace
{

/// A plane through a_v with the ends of two pillars beside v, which bounds v's own pillar.
struct Bound {
    Vec3d normal;
    std::array<int, 2> inner; ///< the vertices whose inner ends it goes through, or -1
};

/// With these bounds, the direction that keeps farthest from the worst of them.
struct View {
    std::vector<Bound> bounds;
    Vec3d direction;
    double least; ///< cosine to the worst bound's normal
};

/// The direction that serves the tets on v's pillar best, with the neighbours where they are: each
/// of these tets is positive on one side of a plane through a_v, whatever the pillar's length.
View best_view(const GrowState& s, int v)
{
    View view;
    std::vector<Vec3d> normals;
    for (const FaceCorner& at : star(*s.mesh, v)) {
        const int j = s.mesh->corner(at.face, (at.local + 1) % 3);
        const int k = s.mesh->corner(at.face, (at.local + 2) % 3);
        for (const int inner_j : {-1, j})
            for (const int inner_k : {-1, k}) {
                const Vec3d& p = inner_j < 0 ? s.a[j] : s.b[j];
                const Vec3d& q = inner_k < 0 ? s.a[k] : s.b[k];
                const Vec3d n = (q - s.a[v]).cross(p - s.a[v]);
                if (!(n.lengthSqr() > 0))
                    continue;
                normals.push_back(n / n.length());
                view.bounds.push_back({normals.back(), {inner_j, inner_k}});
            }
    }
    view.direction = most_visible(normals);
    view.least = view.direction.lengthSqr() > 0 ? smallest_dot(normals, view.direction) : 0;
    return view;
}

/// The mean pillar beside v, about what it would have had without the pin.
double longest_try(const GrowState& s, int v)
{
    double sum = 0;
    for (const int u : neighbours(*s.mesh, v))
        sum += (s.b[u] - s.a[u]).length();
    return std::min(sum / std::max(1, neighbours(*s.mesh, v).size()),
                    s.schedule.pins.longest * s.diagonal);
}

std::vector<int> faces_at(const GrowState& s, int v)
{
    std::vector<int> faces;
    for (const FaceCorner& at : star(*s.mesh, v))
        faces.push_back(at.face);
    return faces;
}

/// The pillars beside a vertex, shortened where they leave it no direction.
class PillarsBeside
{
public:
    PillarsBeside(GrowState& s, int v) : s_(s), faces_(faces_at(s, v))
    {
        for (const int u : neighbours(*s.mesh, v))
            if (!s.pinned[u])
                pillars_.push_back({u, 0, s.b[u]});
    }

    /// Halves those whose ends have a bound that the view is nearer to than `least`. Their own tets
    /// stay positive (docs/theory.md, "Pins that geometry demands"). False: there are none, or they
    /// have been halved often enough.
    bool shorten(const View& view, double least, int most)
    {
        std::vector<int> blocking;
        for (const Bound& bound : view.bounds)
            if (bound.normal.dot(view.direction) < least)
                blocking.insert(blocking.end(), bound.inner.begin(), bound.inner.end());
        bool any = false;
        for (Pillar& p : pillars_) {
            const Vec3d arm = 0.5 * (s_.b[p.vertex] - s_.a[p.vertex]);
            if (p.halvings == most || !(arm.length() > shortest_pillar(s_)) ||
                std::find(blocking.begin(), blocking.end(), p.vertex) == blocking.end())
                continue;
            ++p.halvings;
            s_.b[p.vertex] = rounded(s_.a[p.vertex] + arm);
            const std::vector<int> more = faces_at(s_, p.vertex);
            faces_.insert(faces_.end(), more.begin(), more.end());
            any = true;
        }
        std::sort(faces_.begin(), faces_.end());
        faces_.erase(std::unique(faces_.begin(), faces_.end()), faces_.end());
        return any;
    }
    void restore()
    {
        for (const Pillar& p : pillars_)
            s_.b[p.vertex] = p.before;
    }
    /// Whether all prisms of the vertex, and of what was shortened, pass the tests.
    bool valid() const
    {
        return std::all_of(faces_.begin(), faces_.end(), [&](int f) {
            return prism_valid(s_, f) && inner_triangle_clear(s_, f) && !holds_component(s_, f);
        });
    }

private:
    struct Pillar {
        int vertex, halvings;
        Vec3d before;
    };
    GrowState& s_;
    std::vector<int> faces_;
    std::vector<Pillar> pillars_;
};

/// Gives v a pillar along d, of that length or one of its halves.
bool place(GrowState& s, int v, const Vec3d& d, double length, const PillarsBeside& beside)
{
    for (int i = 0; i < s.schedule.pins.lengths && length > shortest_pillar(s);
         ++i, length *= 0.5) {
        const Vec3d x = end_within_cap(s, v, d, length);
        if (x == s.a[v])
            break;
        // Contact tests see only where a triangle ends up, not what it has passed over.
        if (swallows_component(s, v, x))
            continue;
        s.b[v] = x;
        if (beside.valid())
            return true;
        s.b[v] = s.a[v];
    }
    return false;
}

bool release(GrowState& s, int v, double length, double visibility, PillarsBesidePin allowed)
{
    const PinSchedule& schedule = s.schedule.pins;
    const int shortenings = allowed == PillarsBesidePin::shortened ? schedule.shortenings : 0;
    PillarsBeside beside(s, v);
    // The tests have to see the vertex as released, so it is pinned again where they fail.
    s.pinned[v] = 0;
    const double clear = schedule.share_of_visibility * visibility;
    for (bool look = true; look;) {
        const View view = best_view(s, v);
        if (view.least > 0 && place(s, v, view.direction, length, beside))
            return true;
        // What is seen well and cannot be gone to has something else in the way.
        look = view.least < clear && beside.shorten(view, clear, shortenings);
    }
    beside.restore();
    s.pinned[v] = 1;
    return false;
}

/// Boxes that hold the inner triangles wherever these vertices may go, so that the tree need not be
/// refitted after each release. The tests need boxes that are large enough, not tight.
void box_in(GrowState& s, const std::vector<double>& longest)
{
    std::vector<std::uint8_t> beside(s.b.size(), 0);
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (longest[v] > 0)
            for (const int u : neighbours(*s.mesh, v))
                beside[u] = 1;
    std::vector<FloatBox> boxes(s.mesh->faces.size());
    for_each_index(boxes.size(), [&](std::size_t i) {
        const int f = static_cast<int>(i);
        double most = 0;
        for (int k = 0; k < 3; ++k)
            most = std::max(most, longest[s.mesh->corner(f, k)]);
        const double wider = most > 0 ? (1 + kRadiusMargin) * most + s.rounding : 0;
        boxes[i] = float_box_of(inner_corners(s, f), wider);
        // Pillars may be shortened beside a vertex that is to be released.
        if (beside[s.mesh->corner(f, 0)] || beside[s.mesh->corner(f, 1)] ||
            beside[s.mesh->corner(f, 2)])
            boxes[i].add(float_box_of(outer_corners(s, f), s.rounding));
    });
    s.inner_tree.refit(boxes);
}

} // namespace

int release_pins(GrowState& s, const std::vector<double>& visibility, PillarsBesidePin beside)
{
    // One after another in index order, never in parallel: each release changes what the next sees.
    std::vector<int> candidates;
    std::vector<double> longest(s.b.size(), 0.0);
    for (int v = 0; v < s.mesh->vertices; ++v)
        if (s.pinned[v] && visibility[v] > 0 && s.cap[v] > 0 && star(*s.mesh, v).size() > 0) {
            candidates.push_back(v);
            longest[v] = longest_try(s, v);
        }
    if (candidates.empty())
        return 0;
    box_in(s, longest);
    int released = 0;
    for (const int v : candidates)
        released += release(s, v, longest[v], visibility[v], beside);
    return released;
}

} // namespace vdb_shell::growth

// SPDX-License-Identifier: Apache-2.0

// Takes: a finished shell and the cores that it was kept out of. Gives: for each pillar whether it
// ended at a core and where on it, so that a solver can attach it there, and the figures for the
// report. Nothing is decided by it: feet and distances are computed in doubles, only what stands
// between is asked exactly.

#include "vdb_shell/obstacles/core_feet.h"

#include "core/box_pairs.h"
#include "core/exact.h"
#include "core/parallel.h"
#include "obstacles/nearest_core.h"
#include "vdb_shell/mesh/check_mesh.h"

#include <algorithm>
#include <cassert>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// The innermost triangles that have an area: in a tapered stack corners may be one point.
TriangleMesh innermost(const ShellStack& stack)
{
    TriangleMesh inner{stack.surface(stack.layers.size()), {}};
    for (const Vec3I& t : stack.triangles())
        if (!exact::collinear(inner.points[t[0]], inner.points[t[1]], inner.points[t[2]]))
            inner.triangles.push_back(t);
    return inner;
}

/// What of the shell stands in the way.
class Sight
{
public:
    explicit Sight(const TriangleMesh& inner) : inner_(inner)
    {
        tree_.build(triangle_boxes(inner.points, inner.triangles));
    }
    bool blocked(const Vec3s& from, const Vec3s& to) const
    {
        FloatBox box = FloatBox::around(from);
        box.add(to);
        bool met = false;
        tree_.for_each_overlap(box, [&](int t) {
            const Vec3I& c = inner_.triangles[std::size_t(t)];
            const exact::Triangle corners{inner_.points[c[0]], inner_.points[c[1]],
                                          inner_.points[c[2]]};
            // By place and not by vertex, for vertices may share the point.
            // The triangles at the foot touch the segment there, and do not stand in its way.
            const bool own = std::find(corners.begin(), corners.end(), from) != corners.end();
            met = met || (!own && exact::segment_touches_triangle(from, to, corners));
        });
        return met;
    }

private:
    const TriangleMesh& inner_;
    BoxTree tree_;
};

/// The weights of the corners for a point of the triangle; they add up to one.
Vec3s barycentric(const TriangleMesh& mesh, const Vec3I& t, const Vec3d& point)
{
    const Vec3d a(mesh.points[t[0]]), b(mesh.points[t[1]]), c(mesh.points[t[2]]);
    const Vec3d normal = (b - a).cross(c - a);
    const double area = normal.lengthSqr();
    // Clamped, since the point may be off the triangle by a rounding; the division below makes up
    // for it. Cores have no triangles without area (require_sound).
    const auto weight = [&](const Vec3d& p, const Vec3d& q) {
        return std::clamp((p - point).cross(q - point).dot(normal) / area, 0.0, 1.0);
    };
    const double u = weight(b, c), v = weight(c, a), w = weight(a, b), sum = u + v + w;
    return Vec3s(Vec3d(u, v, w) / sum);
}

/// The core of a triangle of joined_cores, and the first triangle of that core.
struct CoreOf {
    std::size_t core = 0, first = 0;
};
CoreOf core_of(const std::vector<CoreMesh>& cores, std::size_t triangle)
{
    CoreOf found;
    // The cores stand one after the other in joined_cores.
    while (triangle >= found.first + cores[found.core].mesh.triangles.size())
        found.first += cores[found.core++].mesh.triangles.size();
    return found;
}

} // namespace

std::vector<CoreFoot> find_core_feet(const ShellStack& stack, const Cores& cores,
                                     const CoreOptions& options)
{
    assert(stack.skin == 0 && !cores.given.empty());
    const TriangleMesh joined = joined_cores(cores.given), inner = innermost(stack);
    const NearestOnMesh on_cores(joined), on_kept_out(cores.kept_out);
    const Sight sight(inner);
    std::vector<CoreFoot> feet(inner.points.size());
    for_each_index(feet.size(), [&](std::size_t v) {
        const Vec3s& end = inner.points[v];
        const NearestPoint nearest = on_cores.nearest(Vec3d(end));
        feet[v].distance = float(nearest.distance);
        // A shell that is kept at a distance ends at the surface around the cores: what is left to
        // that one counts, while the foot is on the core itself.
        const double left =
            options.distance > 0 ? on_kept_out.nearest(Vec3d(end)).distance : nearest.distance;
        if (left > options.reach * pillar_length(stack, v) ||
            sight.blocked(end, Vec3s(nearest.point)))
            return;
        const CoreOf core = core_of(cores.given, nearest.triangle);
        feet[v].core = std::int32_t(core.core);
        feet[v].triangle = std::int32_t(nearest.triangle - core.first);
        feet[v].uvw = barycentric(joined, joined.triangles[nearest.triangle], nearest.point);
    });
    return feet;
}

void mark_core_stops(ShellStack& stack, const std::vector<CoreFoot>& feet)
{
    for (PrismShell& layer : stack.layers)
        for (std::size_t v = 0; v < layer.stop.size(); ++v)
            if (feet[v].core >= 0)
                // In every layer, for the reason is that of the pillar as a whole.
                layer.stop[v] = StopReason::core;
}

CoreReport report_cores(const ShellStack& stack, const Cores& cores, const CoreOptions& options,
                        const std::vector<CoreFoot>& feet)
{
    CoreReport report;
    report.distance = options.distance;
    report.kept_out_triangles = cores.kept_out.triangles.size();
    for (const CoreMesh& core : cores.given) {
        report.cores.push_back({core.name, core.mesh.triangles.size(),
                                check_mesh(core.mesh).components.size(),
                                signed_volume(core.mesh.points, core.mesh.triangles), 0});
        report.volume += report.cores.back().volume;
    }
    for (const CoreFoot& foot : feet)
        if (foot.core >= 0) {
            ++report.ended;
            ++report.cores[std::size_t(foot.core)].ended;
        }
    // The cores lie beyond the innermost surface, so what of the shell is nearest to them is on it.
    // Where that has vanished, the shell would fill all of the solid, the cores too.
    report.least_distance = least_distance(innermost(stack), joined_cores(cores.given));
    return report;
}

std::vector<CoreFoot> feet_of_tet_points(const ShellStack& stack, const TetMesh& tets,
                                         const std::vector<CoreFoot>& feet)
{
    if (feet.empty())
        return {};
    const std::vector<Vec3s>& inner = stack.surface(stack.layers.size());
    std::vector<CoreFoot> of_points(tets.points.size());
    for (std::size_t i = 0; i < of_points.size(); ++i)
        if (const std::uint32_t v = tets.source_vertex[i];
            // By place: a tet's point has the vertex of its pillar, on whichever surface it lies,
            // and only the innermost one has a foot.
            v < inner.size() && tets.points[i] == inner[v])
            of_points[i] = feet[v];
    return of_points;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes a closed surface and an angle, and leaves the curves of its sharp edges with the corners
// that end them. A curve is measured by its length, so that a vertex on it is one number: it can be
// moved along the curve and never leaves it. The trap is a closed curve without a corner, on which
// that number is not unique; any number of times round means the same point.

#include "resample/feature_curves.h"

#include "mesh/topology.h"
#include "mesh/triangle_corners.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

Vec3d cross_of(const TriangleMesh& mesh, std::uint32_t triangle)
{
    const auto c = triangle_corners(mesh, triangle);
    return (c[1] - c[0]).cross(c[2] - c[0]);
}

double angle_between(const Vec3d& a, const Vec3d& b)
{
    return std::atan2(a.cross(b).length(), a.dot(b));
}

/// The other ends of the feature edges of each vertex, ascending.
using Neighbours = std::vector<std::vector<std::uint32_t>>;

Neighbours sharp_neighbours(const TriangleMesh& mesh, double angle)
{
    Neighbours around(mesh.points.size());
    const EdgeUses uses = sorted_edge_uses(mesh.triangles);
    // Each edge of a closed manifold surface has two uses, which stand together.
    for (std::size_t i = 0; i + 1 < uses.size(); i += 2) {
        if (!(angle_between(cross_of(mesh, uses[i].triangle),
                            cross_of(mesh, uses[i + 1].triangle)) > angle))
            continue;
        const auto [a, b] = uses[i].edge;
        around[a].push_back(b);
        around[b].push_back(a);
    }
    return around;
}

bool is_corner(const TriangleMesh& mesh, const Neighbours& around, std::uint32_t v, double angle)
{
    if (around[v].size() != 2)
        return !around[v].empty();
    const Vec3d p(mesh.points[v]);
    return angle_between(p - Vec3d(mesh.points[around[v][0]]),
                         Vec3d(mesh.points[around[v][1]]) - p) > angle;
}

/// Walks from `first` over `second` to the next corner, or back to `first`.
FeatureCurve walk(const TriangleMesh& mesh, const Neighbours& around,
                  const std::vector<std::uint8_t>& corner, std::uint32_t first,
                  std::uint32_t second)
{
    FeatureCurve curve;
    const auto add = [&](std::uint32_t v) {
        const Vec3d p(mesh.points[v]);
        curve.at.push_back(curve.at.empty() ? 0.0
                                            : curve.at.back() + (p - curve.points.back()).length());
        curve.vertices.push_back(v);
        curve.points.push_back(p);
    };
    add(first);
    std::uint32_t before = first, v = second;
    add(v);
    while (!corner[v] && v != first) {
        const std::uint32_t next = around[v][0] == before ? around[v][1] : around[v][0];
        before = std::exchange(v, next);
        add(v);
    }
    curve.closed = !corner[first];
    return curve;
}

} // namespace

Vec3d FeatureCurve::point_at(double s) const
{
    if (closed)
        s -= std::floor(s / length()) * length();
    const auto after = std::upper_bound(at.begin(), at.end(), s);
    if (after == at.begin())
        return points.front();
    if (after == at.end())
        return points.back();
    const auto i = static_cast<std::size_t>(after - at.begin());
    return points[i - 1] + (points[i] - points[i - 1]) * ((s - at[i - 1]) / (at[i] - at[i - 1]));
}

double FeatureCurve::distance_from(double from, double to, const Vec3d& first,
                                   const Vec3d& last) const
{
    const Vec3d along = last - first;
    const double squared = along.lengthSqr();
    const double start = closed ? std::floor(from / length()) * length() : 0.0;
    double farthest = 0;
    // Once round and once more: the stretch may pass the beginning of a closed curve.
    for (int turn = 0; turn <= (closed ? 1 : 0); ++turn) {
        const double shift = start + turn * length();
        auto i = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), from - shift) -
                                          at.begin());
        for (; i < at.size() && at[i] + shift < to; ++i) {
            const Vec3d d = points[i] - first;
            const double t = squared > 0 ? std::clamp(d.dot(along) / squared, 0.0, 1.0) : 0.0;
            farthest = std::max(farthest, (d - along * t).length());
        }
    }
    return farthest;
}

namespace
{

/// The curves of these edges. First from all corners, then round the loops that have none; a curve
/// from corner to corner would be found from either end, and is taken from the one that comes
/// first.
FeatureCurves curves_of(const TriangleMesh& mesh, const Neighbours& around, double angle)
{
    FeatureCurves out;
    const auto count = static_cast<std::uint32_t>(mesh.points.size());
    out.corner.resize(count);
    std::vector<std::vector<std::uint8_t>> walked(count);
    for (std::uint32_t v = 0; v < count; ++v) {
        out.corner[v] = is_corner(mesh, around, v, angle);
        out.corners += out.corner[v];
        out.edges += around[v].size();
        walked[v].resize(around[v].size());
    }
    out.edges /= 2;
    const auto mark = [&](std::uint32_t v, std::uint32_t to) {
        const auto& ends = around[v];
        walked[v][std::size_t(std::find(ends.begin(), ends.end(), to) - ends.begin())] = 1;
    };
    for (const bool from_corners : {true, false})
        for (std::uint32_t v = 0; v < count; ++v)
            for (std::size_t k = 0; k < around[v].size(); ++k) {
                if (walked[v][k] || (from_corners && !out.corner[v]))
                    continue;
                out.curves.push_back(walk(mesh, around, out.corner, v, around[v][k]));
                const std::vector<std::uint32_t>& chain = out.curves.back().vertices;
                for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
                    mark(chain[i], chain[i + 1]);
                    mark(chain[i + 1], chain[i]);
                }
            }
    return out;
}

/// Takes the edges of short curves that end in nothing out of `around`; false if there are none.
bool drop_short_ends(const FeatureCurves& found, double least_length, Neighbours& around)
{
    bool any = false;
    const auto ends_freely = [&](std::uint32_t v) { return around[v].size() == 1; };
    std::vector<const FeatureCurve*> dropped;
    for (const FeatureCurve& curve : found.curves)
        if (curve.length() < least_length &&
            (ends_freely(curve.vertices.front()) || ends_freely(curve.vertices.back())))
            dropped.push_back(&curve);
    const auto forget = [&](std::uint32_t v, std::uint32_t w) {
        around[v].erase(std::find(around[v].begin(), around[v].end(), w));
    };
    for (const FeatureCurve* curve : dropped)
        for (std::size_t i = 0; i + 1 < curve->vertices.size(); ++i, any = true) {
            forget(curve->vertices[i], curve->vertices[i + 1]);
            forget(curve->vertices[i + 1], curve->vertices[i]);
        }
    return any;
}

} // namespace

FeatureCurves find_features(const TriangleMesh& mesh, double angle_radians, double least_length)
{
    Neighbours around = sharp_neighbours(mesh, angle_radians);
    FeatureCurves found = curves_of(mesh, around, angle_radians);
    // Where a branch has gone, what is left may be one longer curve, or end in nothing itself. Each
    // time round there are fewer edges, so this ends.
    while (drop_short_ends(found, least_length, around))
        found = curves_of(mesh, around, angle_radians);
    return found;
}

} // namespace vdb_shell

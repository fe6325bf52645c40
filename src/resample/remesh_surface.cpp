// SPDX-License-Identifier: Apache-2.0

// Takes patches of triangles that are to take the place of others, and puts those in that leave the
// surface valid. All operations of remeshing are such patches, so the tests stand here once, in the
// order of what they cost: angles, normals, contacts by exact predicates with all triangles near,
// and the distance to the input both ways at sampled points. The input's samples wander from patch
// to patch with the surface under them, as in Klein, Liebich and Strasser 1996, "Mesh reduction
// with error control", so errors do not add up. The trap is that distances are only sampled;
// callers measure the result.

#include "resample/remesh_surface.h"

#include "core/exact.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "resample/triangle_angle.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

// A triangle may face away from the input's normal next to its middle by 60 degrees, of which this
// is the cosine, or as far as the worst that it takes the place of. Half of what makes a fold.
constexpr double kLeastFacing = 0.5;
// Over this squared sine of its smallest angle a triangle has an area for certain: the cosine is
// off by some 1e-15, and so is this.
constexpr double kSurelyWide = 1e-12;

double cosine_of(const std::array<Vec3d, 3>& c)
{
    return cosine_of_smallest_angle(c[0], c[1], c[2]);
}

FloatBox box_around(const Vec3s& a, const Vec3s& b, const Vec3s& c)
{
    FloatBox box = FloatBox::around(a);
    box.add(b);
    box.add(c);
    return box;
}

/// The sign of the area of a triangle seen along an axis; 0 where doubles do not tell for certain.
int sign_along(int axis, const Vec3s& a, const Vec3s& b, const Vec3s& c)
{
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const Vec3d p(a), u = Vec3d(b) - p, v = Vec3d(c) - p;
    const double first = u[x] * v[y], second = v[x] * u[y], area = first - second;
    // Differences and products are each off by half a bit, 1.1e-16, at most.
    const double off = 1e-15 * (std::abs(first) + std::abs(second));
    return area > off ? 1 : area < -off ? -1 : 0;
}

} // namespace

RemeshSurface::RemeshSurface(const TriangleMesh& input, const FeatureCurves& features,
                             double tolerance, double spacing)
    : input_(input), features_(features), tolerance_(tolerance), scale_(1 / spacing),
      tree_(input, spacing), points_(input.points), kind_(points_.size(), VertexKind::free),
      on_input_(points_.size(), 1), size_(points_.size(), 0.0), star_(points_.size())
{
    std::vector<FloatBox> boxes;
    boxes.reserve(input.triangles.size());
    for (std::uint32_t t = 0; t < input.triangles.size(); ++t) {
        triangles_.emplace_back(0U);
        cosine_.push_back(0), facing_.push_back(0), changed_at_.push_back(0);
        const Vec3I& c = input.triangles[t];
        link(t, c, {cosine_of(corners_of(c)), 1.0});
        boxes.push_back(box_around(points_[c[0]], points_[c[1]], points_[c[2]]));
    }
    boxes_.build(std::move(boxes));
    for (std::uint32_t k = 0; k < features.curves.size(); ++k) {
        const FeatureCurve& curve = features.curves[k];
        for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
            const std::uint32_t a = curve.vertices[i], b = curve.vertices[i + 1];
            feature_edges_[key(a, b)] = {k, a, curve.at[i], curve.at[i + 1]};
            kind_[a] = kind_[b] = VertexKind::on_curve;
        }
    }
    for (std::size_t v = 0; v < kind_.size(); ++v)
        if (features.corner[v])
            kind_[v] = VertexKind::corner;
    place_samples(spacing);
}

std::array<Vec3d, 3> RemeshSurface::corners_of(const Vec3I& c) const
{
    return {point(c[0]), point(c[1]), point(c[2])};
}

Vec3d RemeshSurface::cross_of(const Vec3I& c) const
{
    const auto p = corners_of(c);
    return (p[1] - p[0]).cross(p[2] - p[0]);
}

RemeshSurface::Foot RemeshSurface::foot_of(const Vec3d& p) const
{
    const std::uint32_t t = tree_.nearest(p, 0.0F, seed_).triangle;
    const auto c = triangle_corners(input_, t);
    Foot foot;
    foot.point = nearest_on_triangle(c, p).point;
    foot.squared = (foot.point - p).lengthSqr();
    foot.normal = (c[1] - c[0]).cross(c[2] - c[0]);
    const double length = foot.normal.length();
    foot.normal = length > 0 ? foot.normal / length : Vec3d(0.0);
    return foot;
}

Refusal RemeshSurface::replace(const Patch& patch, const Vec3s& p, double cosine)
{
    hub_before_ = points_[patch.hub];
    farthest_before_ = -1;
    points_[patch.hub] = p;
    const Refusal refusal = refusal_of(patch, cosine);
    if (refusal == Refusal::none)
        commit(patch);
    else
        points_[patch.hub] = hub_before_;
    return refusal;
}

Refusal RemeshSurface::refusal_of(const Patch& patch, double cosine)
{
    if (!keeps_shape(patch, cosine))
        return Refusal::shape;
    if (!features_near(patch))
        return Refusal::far;
    if (!faces_as_before(patch))
        return Refusal::turned;
    if (touches(patch))
        return Refusal::contact;
    return keeps_near(patch) && samples_near(patch) ? Refusal::none : Refusal::far;
}

bool RemeshSurface::keeps_shape(const Patch& patch, double cosine)
{
    double before = -1, after = -1;
    for (const std::uint32_t t : patch.removed)
        before = std::max(before, cosine_[t]);
    shapes_.clear();
    for (const Vec3I& c : patch.added) {
        shapes_.push_back({cosine_of(corners_of(c)), 1.0});
        after = std::max(after, shapes_.back().cosine);
        if (1 - after * after < kSurelyWide &&
            exact::collinear(points_[c[0]], points_[c[1]], points_[c[2]]))
            return false;
    }
    return after <= cosine || after < before;
}

/// Whether a distance, squared, is within the tolerance, or no larger than the largest was before:
/// so that places where the surfaces are too far apart can be mended step by step.
bool RemeshSurface::is_near(const Patch& patch, double squared)
{
    if (squared <= tolerance_ * tolerance_ || patch.same_surface)
        return true;
    if (farthest_before_ < 0)
        farthest_before_ = farthest_before(patch);
    return squared <= farthest_before_;
}

double RemeshSurface::farthest_before(const Patch& patch) const
{
    const auto corners = [&](std::uint32_t t) {
        std::array<Vec3d, 3> c = corners_of(triangles_[t]);
        for (int k = 0; k < 3; ++k)
            if (triangles_[t][k] == patch.hub)
                c[std::size_t(k)] = Vec3d(hub_before_);
        return c;
    };
    double farthest = 0;
    for (const std::uint32_t t : patch.removed) {
        const std::array<Vec3d, 3> c = corners(t);
        farthest = std::max(farthest, foot_of((c[0] + c[1] + c[2]) / 3.0).squared);
        for (const std::uint32_t s : samples_of_[t]) {
            double nearest = std::numeric_limits<double>::infinity();
            for (const std::uint32_t other : patch.removed)
                nearest = std::min(nearest, squared_distance(corners(other), samples_[s]));
            farthest = std::max(farthest, nearest);
        }
    }
    return farthest;
}

/// Notes the distance of the middles on the way, which is nearly free.
bool RemeshSurface::faces_as_before(const Patch& patch)
{
    double before = kLeastFacing;
    for (const std::uint32_t t : patch.removed)
        before = std::min(before, facing_[t]);
    for (std::size_t i = 0; i < patch.added.size(); ++i) {
        const std::array<Vec3d, 3> c = corners_of(patch.added[i]);
        const Vec3d cross = cross_of(patch.added[i]);
        const Foot foot = foot_of((c[0] + c[1] + c[2]) / 3.0);
        if (!is_near(patch, foot.squared))
            return false;
        const double length = cross.length();
        shapes_[i].facing = length > 0 ? cross.dot(foot.normal) / length : 0.0;
        if (shapes_[i].facing < before && !patch.same_surface)
            return false;
    }
    return true;
}

/// Whether what goes and what comes covers the same part of one plane along two axes, once: both
/// are discs with the same border, and no triangle is turned over, so each point is covered as
/// often as before. Flat walls of machined parts are such planes.
bool RemeshSurface::stays_in_plane(const Patch& patch) const
{
    const Vec3s& any = points_[patch.added[0][0]];
    const auto before = [&](std::uint32_t v) { return v == patch.hub ? hub_before_ : points_[v]; };
    for (int axis = 0; axis < 3; ++axis) {
        int sign = 0; // of what comes
        const auto comes = [&](const Vec3I& c) {
            const int its = sign_along(axis, points_[c[0]], points_[c[1]], points_[c[2]]);
            const bool same = its != 0 && (sign == 0 || sign == its);
            sign = its;
            return same && points_[c[0]][axis] == any[axis] && points_[c[1]][axis] == any[axis] &&
                   points_[c[2]][axis] == any[axis];
        };
        // What goes is embedded, so in one plane all of it is turned the same way: one sign will
        // do, where doubles do not tell all of them.
        bool seen = false;
        const auto goes = [&](std::uint32_t t) {
            const Vec3I& c = triangles_[t];
            const Vec3s p = before(c[0]), q = before(c[1]), r = before(c[2]);
            seen = seen || sign_along(axis, p, q, r) == sign;
            return p[axis] == any[axis] && q[axis] == any[axis] && r[axis] == any[axis];
        };
        if (std::all_of(patch.added.begin(), patch.added.end(), comes) &&
            std::all_of(patch.removed.begin(), patch.removed.end(), goes) && seen)
            return true;
    }
    return false;
}

bool RemeshSurface::touches(const Patch& patch) const
{
    if (stays_in_plane(patch))
        return false;
    FloatBox all = FloatBox::around(points_[patch.added[0][0]]);
    for (const Vec3I& c : patch.added)
        all.add(box_around(points_[c[0]], points_[c[1]], points_[c[2]]));
    boxes_.overlaps(all, near_);
    const auto stays = [&](std::uint32_t t) {
        return std::find(patch.removed.begin(), patch.removed.end(), t) == patch.removed.end();
    };
    near_.erase(
        std::remove_if(near_.begin(), near_.end(), [&](std::uint32_t t) { return !stays(t); }),
        near_.end());
    for (std::size_t i = 0; i < patch.added.size(); ++i) {
        const Vec3I& c = patch.added[i];
        const FloatBox box = box_around(points_[c[0]], points_[c[1]], points_[c[2]]);
        for (const std::uint32_t t : near_)
            if (boxes_.box(t).overlaps(box) && exact::triangles_touch(points_, c, triangles_[t]))
                return true;
        for (std::size_t j = i + 1; j < patch.added.size(); ++j)
            if (exact::triangles_touch(points_, c, patch.added[j]))
                return true;
    }
    return false;
}

/// The middles of the new edges; those of the triangles have been looked at.
bool RemeshSurface::keeps_near(const Patch& patch)
{
    for (const Vec3I& c : patch.added)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = c[k], w = c[(k + 1) % 3];
            // Both triangles of an edge at the hub are new, and one of them is enough.
            if (v == patch.hub && !is_near(patch, foot_of(0.5 * (point(v) + point(w))).squared))
                return false;
        }
    return true;
}

bool RemeshSurface::features_near(const Patch& patch) const
{
    return std::all_of(patch.features.begin(), patch.features.end(), [&](const NewFeature& f) {
        const std::uint32_t to = f.edge.from == f.a ? f.b : f.a;
        return features_.curves[f.edge.curve].distance_from(
                   f.edge.s_from, f.edge.s_to, point(f.edge.from), point(to)) <= tolerance_;
    });
}

void RemeshSurface::unlink(std::uint32_t t)
{
    for (int k = 0; k < 3; ++k) {
        std::vector<std::uint32_t>& star = star_[triangles_[t][k]];
        star.erase(std::find(star.begin(), star.end(), t));
    }
    triangles_[t] = Vec3I(0U);
    boxes_.remove(t);
    --live_;
}

void RemeshSurface::link(std::uint32_t t, const Vec3I& corners, const Shape& shape)
{
    triangles_[t] = corners;
    cosine_[t] = shape.cosine;
    facing_[t] = shape.facing;
    for (int k = 0; k < 3; ++k)
        star_[corners[k]].push_back(t);
    ++live_;
}

void RemeshSurface::put(std::uint32_t t, const Vec3I& corners, const Shape& shape)
{
    link(t, corners, shape);
    changed_at_[t] = now_;
    boxes_.insert(t, box_around(points_[corners[0]], points_[corners[1]], points_[corners[2]]));
}

/// New triangles take the numbers of those that go, as far as these reach.
void RemeshSurface::commit(const Patch& patch)
{
    ++now_;
    for (const std::uint32_t t : patch.removed) {
        samples_of_[t].clear();
        unlink(t);
    }
    std::vector<std::uint32_t> place(patch.removed);
    while (place.size() < patch.added.size()) {
        if (free_triangles_.empty()) {
            place.push_back(static_cast<std::uint32_t>(triangles_.size()));
            triangles_.emplace_back(0U);
            cosine_.push_back(0), facing_.push_back(0), changed_at_.push_back(0);
            samples_of_.emplace_back();
        } else {
            place.push_back(free_triangles_.back());
            free_triangles_.pop_back();
        }
    }
    for (std::size_t i = patch.added.size(); i < place.size(); ++i)
        free_triangles_.push_back(place[i]);
    for (std::size_t i = 0; i < patch.added.size(); ++i)
        put(place[i], patch.added[i], shapes_[i]);
    for (const std::uint64_t edge : patch.forgotten)
        feature_edges_.erase(edge);
    for (const NewFeature& f : patch.features)
        feature_edges_[key(f.a, f.b)] = f.edge;
    for (std::size_t i = 0; i < handed_over_.size(); ++i)
        samples_of_[place[nearest_added_[i]]].push_back(handed_over_[i]);
}

} // namespace vdb_shell

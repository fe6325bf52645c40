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
#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "mesh/triangle_corners.h"
#include "resample/triangle_angle.h"
#include "resample/triangle_pieces.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

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

double squared_distance(const std::array<Vec3d, 3>& triangle, const Vec3d& p)
{
    return (nearest_on_triangle(triangle, p).point - p).lengthSqr();
}

/// What no point in the box is nearer than.
double squared_distance(const FloatBox& box, const Vec3d& p)
{
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double beyond = std::max({double(box.lo[k]) - p[k], p[k] - double(box.hi[k]), 0.0});
        sum += beyond * beyond;
    }
    return sum;
}

} // namespace

RemeshSurface::RemeshSurface(const TriangleMesh& input, const FeatureCurves& features,
                             double tolerance, double spacing)
    : input_(input), features_(features), tolerance_(tolerance), tree_(input, spacing),
      points_(input.points), kind_(points_.size(), VertexKind::free), on_input_(points_.size(), 1),
      size_(points_.size(), 0.0), star_(points_.size())
{
    for (std::uint32_t t = 0; t < input.triangles.size(); ++t) {
        triangles_.emplace_back(0U);
        cosine_.push_back(0), facing_.push_back(0);
        const Vec3I& c = input.triangles[t];
        put(t, c, {cosine_of(corners_of(c)), 1.0});
    }
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

/// The vertices, by their own numbers; then points inside of triangles and edges that are longer
/// than the spacing.
void RemeshSurface::place_samples(double spacing)
{
    for (const Vec3s& p : input_.points)
        samples_.emplace_back(p);
    samples_of_.resize(triangles_.size());
    std::vector<char> seen(samples_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const std::array<Vec3d, 3> c = corners_of(triangles_[t]);
        const auto add = [&](const Vec3d& p) {
            samples_of_[t].push_back(static_cast<std::uint32_t>(samples_.size()));
            samples_.push_back(p);
        };
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = triangles_[t][k], w = triangles_[t][(k + 1) % 3];
            if (!seen[v])
                samples_of_[t].push_back(v), seen[v] = 1;
            const Vec3d &p = c[std::size_t(k)], &q = c[std::size_t((k + 1) % 3)];
            const double pieces = v < w ? std::ceil((q - p).length() / spacing) : 1;
            for (double i = 1; i < pieces; ++i)
                add(p + (q - p) * (i / pieces));
        }
        if ((c[1] - c[0]).length() > spacing || (c[2] - c[1]).length() > spacing ||
            (c[0] - c[2]).length() > spacing)
            for_each_piece(
                c[0], c[1], c[2], spacing,
                [&](const Vec3d& x, const Vec3d& y, const Vec3d& z) { add((x + y + z) / 3.0); });
    }
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
    const Vec3s before = points_[patch.hub];
    points_[patch.hub] = p;
    const Refusal refusal = refusal_of(patch, cosine);
    if (refusal == Refusal::none)
        commit(patch);
    else
        points_[patch.hub] = before;
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
        if (foot.squared > tolerance_ * tolerance_)
            return false;
        const double length = cross.length();
        shapes_[i].facing = length > 0 ? cross.dot(foot.normal) / length : 0.0;
        if (shapes_[i].facing < before)
            return false;
    }
    return true;
}

bool RemeshSurface::touches(const Patch& patch) const
{
    FloatBox all = FloatBox::around(points_[patch.added[0][0]]);
    for (const Vec3I& c : patch.added)
        all.add(box_around(points_[c[0]], points_[c[1]], points_[c[2]]));
    grid_.overlaps(all, near_);
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
            if (grid_.box(t).overlaps(box) && exact::triangles_touch(points_, c, triangles_[t]))
                return true;
        for (std::size_t j = i + 1; j < patch.added.size(); ++j)
            if (exact::triangles_touch(points_, c, patch.added[j]))
                return true;
    }
    return false;
}

/// The middles of the new edges; those of the triangles have been looked at.
bool RemeshSurface::keeps_near(const Patch& patch) const
{
    for (const Vec3I& c : patch.added)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = c[k], w = c[(k + 1) % 3];
            // Both triangles of an edge at the hub are new, and one of them is enough.
            if (v == patch.hub &&
                foot_of(0.5 * (point(v) + point(w))).squared > tolerance_ * tolerance_)
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

bool RemeshSurface::samples_near(const Patch& patch) const
{
    std::vector<std::array<Vec3d, 3>> added;
    added.reserve(patch.added.size());
    for (const Vec3I& c : patch.added)
        added.push_back(corners_of(c));
    const double most = tolerance_ * tolerance_;
    // The boxes save most of the distances, which are half of what remeshing costs.
    const auto is_near = [&](std::size_t i, std::uint32_t s) {
        const Vec3I& c = patch.added[i];
        return squared_distance(box_around(points_[c[0]], points_[c[1]], points_[c[2]]),
                                samples_[s]) <= most &&
               squared_distance(added[i], samples_[s]) <= most;
    };
    for (std::size_t i = 0; i < patch.removed.size(); ++i)
        for (const std::uint32_t s : samples_of_[patch.removed[i]]) {
            // A moved triangle has its own place in both lists, and most likely its samples too.
            const std::size_t first = std::min(i, added.size() - 1);
            bool found = is_near(first, s);
            for (std::size_t j = 0; !found && j < added.size(); ++j)
                found = is_near(j, s);
            if (!found)
                return false;
        }
    return true;
}

void RemeshSurface::unlink(std::uint32_t t)
{
    for (int k = 0; k < 3; ++k) {
        std::vector<std::uint32_t>& star = star_[triangles_[t][k]];
        star.erase(std::find(star.begin(), star.end(), t));
    }
    triangles_[t] = Vec3I(0U);
    grid_.remove(t);
    --live_;
}

void RemeshSurface::put(std::uint32_t t, const Vec3I& corners, const Shape& shape)
{
    triangles_[t] = corners;
    cosine_[t] = shape.cosine;
    facing_[t] = shape.facing;
    for (int k = 0; k < 3; ++k)
        star_[corners[k]].push_back(t);
    grid_.insert(t, box_around(points_[corners[0]], points_[corners[1]], points_[corners[2]]));
    ++live_;
}

/// New triangles take the numbers of those that go, as far as these reach.
void RemeshSurface::commit(const Patch& patch)
{
    handed_over_.clear();
    for (const std::uint32_t t : patch.removed) {
        handed_over_.insert(handed_over_.end(), samples_of_[t].begin(), samples_of_[t].end());
        samples_of_[t].clear();
        unlink(t);
    }
    std::vector<std::uint32_t> place(patch.removed);
    while (place.size() < patch.added.size()) {
        if (free_triangles_.empty()) {
            place.push_back(static_cast<std::uint32_t>(triangles_.size()));
            triangles_.emplace_back(0U);
            cosine_.push_back(0), facing_.push_back(0);
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
    place.resize(patch.added.size());
    hand_over(place);
}

/// Each sample to the nearest of the triangles. The boxes save most of the distances.
void RemeshSurface::hand_over(const std::vector<std::uint32_t>& triangles)
{
    for (const std::uint32_t s : handed_over_) {
        std::uint32_t nearest = triangles.front();
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t t : triangles) {
            if (squared_distance(grid_.box(t), samples_[s]) >= least)
                continue;
            const double squared = squared_distance(corners_of(triangles_[t]), samples_[s]);
            if (squared < least)
                least = squared, nearest = t;
        }
        samples_of_[nearest].push_back(s);
    }
}

void RemeshSurface::settle_samples()
{
    std::vector<std::uint32_t> home(samples_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        for (const std::uint32_t s : samples_of_[t])
            home[s] = t;
    for_each_index(samples_.size(), [&](std::size_t s) {
        double least = squared_distance(corners_of(triangles_[home[s]]), samples_[s]);
        // Each step is strictly nearer, so this ends.
        for (bool nearer = true; nearer;) {
            nearer = false;
            const Vec3I corners = triangles_[home[s]];
            for (int k = 0; k < 3; ++k)
                for (const std::uint32_t t : star_[corners[k]]) {
                    if (squared_distance(grid_.box(t), samples_[s]) >= least)
                        continue;
                    const double squared = squared_distance(corners_of(triangles_[t]), samples_[s]);
                    if (squared < least)
                        least = squared, home[s] = t, nearer = true;
                }
        }
    });
    for (std::vector<std::uint32_t>& samples : samples_of_)
        samples.clear();
    for (std::uint32_t s = 0; s < home.size(); ++s)
        samples_of_[home[s]].push_back(s);
}

} // namespace vdb_shell

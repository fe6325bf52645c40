// SPDX-License-Identifier: Apache-2.0

// Takes points of the input and keeps each with the triangle that is nearest to it, while triangles
// come and go: where operations look whether the input is near enough to the surface, and where its
// vertices lie on the result. Samples wander from patch to patch with the surface under them.
// Points of a plane that many needles share are thinned out, for each would be compared with each
// triangle of its patch, again and again.

#include "core/parallel.h"
#include "mesh/nearest_on_triangle.h"
#include "resample/plane_cells.h"
#include "resample/remesh_surface.h"
#include "resample/triangle_pieces.h"

#include <algorithm>
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

constexpr std::uint32_t kNoTriangle = ~0U;
// Triangles that a thread takes at a time: some microseconds each.
constexpr std::size_t kGrain = 16;

} // namespace

/// The vertices, by their own numbers; then points inside of triangles and edges that are longer
/// than the spacing, unless there is one nearer than that in the same plane.
void RemeshSurface::place_samples(double spacing)
{
    for (const Vec3s& p : input_.points)
        samples_.emplace_back(p);
    samples_of_.resize(triangles_.size());
    std::vector<char> seen(samples_.size());
    PlaneCells cells(0.5 * spacing, 0.25 * tolerance_);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const std::array<Vec3d, 3> c = corners_of(triangles_[t]);
        for (int k = 0; k < 3; ++k)
            if (!std::exchange(seen[triangles_[t][k]], 1))
                samples_of_[t].push_back(triangles_[t][k]);
        const auto length = [&](std::size_t k) { return (c[(k + 1) % 3] - c[k]).length(); };
        if (std::max({length(0), length(1), length(2)}) <= spacing)
            continue;
        cells.set_plane(c);
        const auto add = [&](const Vec3d& p) {
            if (!cells.take(p))
                return;
            samples_of_[t].push_back(static_cast<std::uint32_t>(samples_.size()));
            samples_.push_back(p);
        };
        for (std::size_t k = 0; k < 3; ++k) {
            cells.take(c[k]);
            const std::size_t next = (k + 1) % 3;
            // The other side of the edge leaves it to this one.
            const bool own = triangles_[t][int(k)] < triangles_[t][int(next)];
            const double pieces = own ? std::ceil(length(k) / spacing) : 1;
            for (double i = 1; i < pieces; ++i)
                add(c[k] + (c[next] - c[k]) * (i / pieces));
        }
        for_each_piece(
            c[0], c[1], c[2], spacing,
            [&](const Vec3d& x, const Vec3d& y, const Vec3d& z) { add((x + y + z) / 3.0); });
    }
}

/// Notes the nearest of the new triangles for each sample on the way, where it is handed to.
bool RemeshSurface::samples_near(const Patch& patch)
{
    handed_over_.clear();
    for (const std::uint32_t t : patch.removed)
        handed_over_.insert(handed_over_.end(), samples_of_[t].begin(), samples_of_[t].end());
    around_.prepare(point(patch.hub), scale_, patch.added.size(),
                    [&](std::size_t i) { return corners_of(patch.added[i]); });
    nearest_added_.resize(handed_over_.size());
    for (std::size_t i = 0; i < handed_over_.size(); i += kLanes) {
        const std::size_t count = std::min(kLanes, handed_over_.size() - i);
        const EightNearest& nearest =
            around_.nearest(count, [&](std::size_t k) { return samples_[handed_over_[i + k]]; });
        for (std::size_t k = 0; k < count; ++k) {
            if (!is_near(patch, double(nearest.squared[k]) / (scale_ * scale_)))
                return false;
            nearest_added_[i + k] = static_cast<std::uint32_t>(nearest.triangle[k]);
        }
    }
    return true;
}

void RemeshSurface::settle_samples()
{
    // A sample can only have come nearer to another triangle where one at its own triangle's
    // corners is new.
    std::vector<std::uint8_t> at_new(points_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
        if (alive(t) && changed_at_[t] >= settled_at_)
            for (int k = 0; k < 3; ++k)
                at_new[triangles_[t][k]] = 1;
    settled_at_ = ++now_;
    std::vector<std::uint32_t> wandering;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const Vec3I& c = triangles_[t];
        if (alive(t) && (at_new[c[0]] || at_new[c[1]] || at_new[c[2]]))
            wandering.push_back(t);
    }
    // Their samples, and of each the triangle that it is to belong to.
    std::vector<std::vector<std::uint32_t>> samples(wandering.size()), homes(wandering.size());
    for_each_index(
        wandering.size(),
        [&](std::size_t i) {
            samples[i] = std::move(samples_of_[wandering[i]]);
            samples_of_[wandering[i]].clear();
            find_homes(wandering[i], samples[i], homes[i]);
        },
        kGrain);
    for (std::size_t i = 0; i < wandering.size(); ++i)
        for (std::size_t k = 0; k < samples[i].size(); ++k)
            samples_of_[homes[i][k]].push_back(samples[i][k]);
}

/// For each sample the triangle that it comes to when it goes on to a nearer neighbour of its
/// triangle as long as there is one.
void RemeshSurface::find_homes(std::uint32_t from, const std::vector<std::uint32_t>& samples,
                               std::vector<std::uint32_t>& homes) const
{
    std::vector<std::uint32_t> list;
    neighbours_of(from, list);
    TrianglesAround around;
    around.prepare(point(triangles_[from][0]), scale_, list.size(),
                   [&](std::size_t i) { return corners_of(triangles_[list[i]]); });
    homes.resize(samples.size());
    for (std::size_t i = 0; i < samples.size(); i += kLanes) {
        const std::size_t count = std::min(kLanes, samples.size() - i);
        const EightNearest& nearest =
            around.nearest(count, [&](std::size_t k) { return samples_[samples[i + k]]; });
        for (std::size_t k = 0; k < count; ++k) {
            homes[i + k] = list[std::size_t(nearest.triangle[k])];
            // Few go anywhere, and fewer go on from there.
            if (homes[i + k] != from)
                homes[i + k] = home_from(homes[i + k], samples_[samples[i + k]]);
        }
    }
}

std::uint32_t RemeshSurface::home_from(std::uint32_t t, const Vec3d& p) const
{
    std::vector<std::uint32_t> around;
    double least = squared_distance(corners_of(triangles_[t]), p);
    // Each step is strictly nearer, so this ends.
    for (std::uint32_t from = kNoTriangle; from != t;) {
        from = t;
        neighbours_of(from, around);
        for (const std::uint32_t other : around) {
            const double squared = squared_distance(corners_of(triangles_[other]), p);
            if (squared < least)
                least = squared, t = other;
        }
    }
    return t;
}

/// The triangle itself first, then those that share a corner with it.
void RemeshSurface::neighbours_of(std::uint32_t t, std::vector<std::uint32_t>& around) const
{
    around.assign(1, t);
    for (int k = 0; k < 3; ++k)
        for (const std::uint32_t other : star_[triangles_[t][k]])
            if (std::find(around.begin(), around.end(), other) == around.end())
                around.push_back(other);
}

void RemeshSurface::look_at(const Vec3d& p, std::uint32_t t)
{
    samples_of_[home_from(t, p)].push_back(static_cast<std::uint32_t>(samples_.size()));
    samples_.push_back(p);
}

} // namespace vdb_shell

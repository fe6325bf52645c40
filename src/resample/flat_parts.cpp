// SPDX-License-Identifier: Apache-2.0

// Takes: a surface and how thick a part of it may be that counts as flat. Gives: such parts. Each
// grows from the largest triangle that is left, whose plane is known best, over neighbours whose
// corners are near the plane; needles have next to no plane of their own, so that angles between
// neighbours tell nothing. The plane is that of all of the part so far, and what turns out to be
// too far from the last one leaves the part again. The trap are triangles that are thinner than
// what counts as flat, on an edge between two walls: they belong to both. Beside their longest side
// there is room for better ones, so they join the wall on that side as long as there is one.

#include "resample/flat_parts.h"

#include "core/exact.h"
#include "core/parallel.h"
#include "mesh/triangle_corners.h"
#include "mesh/triangle_height.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

/// The plane of some triangles, by the sum of their areas' vectors and the middle of their areas.
class Plane
{
public:
    void add(const std::array<Vec3d, 3>& corners)
    {
        const Vec3d cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        const double area = cross.length();
        cross_ += cross;
        area_ += area;
        moment_ += area / 3 * (corners[0] + corners[1] + corners[2]);
        normal_ = cross_;
        normal_.normalize();
        middle_ = moment_ / area_;
    }
    const Vec3d& normal() const { return normal_; }
    double height(const Vec3d& p) const { return normal_.dot(p - middle_); }

private:
    Vec3d cross_{0.0}, moment_{0.0}, normal_{0.0}, middle_{0.0};
    double area_ = 0;
};

/// Triangles from the largest to the smallest; those without area are left out.
std::vector<std::uint32_t> largest_first(const TriangleMesh& mesh)
{
    std::vector<double> squared(mesh.triangles.size());
    for (std::size_t t = 0; t < squared.size(); ++t) {
        const auto c = triangle_corners(mesh, t);
        squared[t] = (c[1] - c[0]).cross(c[2] - c[0]).lengthSqr();
    }
    std::vector<std::uint32_t> order(mesh.triangles.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return squared[a] != squared[b] ? squared[a] > squared[b] : a < b;
    });
    while (!order.empty() && !(squared[order.back()] > 0))
        order.pop_back();
    return order;
}

/// Of a triangle.
struct Height {
    int longest_side;
    double over_longest;
};

/// A part as it grows.
struct Growing {
    std::vector<std::uint32_t> triangles;
    Plane plane;
};

class Grower
{
public:
    Grower(const TriangleMesh& mesh, const std::vector<NeighboursAcross>& across, double thickness)
        : mesh_(mesh), across_(across), farthest_(kFarthest * thickness),
          height_(mesh.triangles.size())
    {
        found_.part_of.assign(mesh.triangles.size(), kInNoPart);
        for_each_index(height_.size(), [&](std::size_t t) {
            const openvdb::Vec3I& corners = mesh.triangles[t];
            const int side = longest_side(mesh, corners);
            height_[t] = {side, height_over(mesh, corners, side)};
        });
    }

    FlatParts grow()
    {
        const std::vector<std::uint32_t> order = largest_first(mesh_);
        for (const std::uint32_t seed : order)
            if (!is_thin(seed))
                start(seed, Thin::over_longest_side);
        for (std::uint32_t i = 0; i < growing_.size(); ++i)
            spread(i, Thin::over_any_side);
        for (const std::uint32_t seed : order)
            start(seed, Thin::over_any_side);
        for (std::uint32_t i = 0; i < growing_.size(); ++i)
            finish(i);
        return std::move(found_);
    }

private:
    enum class Thin : std::uint8_t { over_longest_side, over_any_side };

    bool is_far(const Plane& plane, const std::array<Vec3d, 3>& corners) const
    {
        return std::any_of(corners.begin(), corners.end(), [&](const Vec3d& p) {
            return !(std::abs(plane.height(p)) <= farthest_);
        });
    }

    bool is_thin(std::uint32_t t) const { return height_[t].over_longest <= farthest_; }

    void start(std::uint32_t seed, Thin thin)
    {
        if (found_.part_of[seed] != kInNoPart)
            return;
        found_.part_of[seed] = static_cast<std::uint32_t>(growing_.size());
        growing_.emplace_back();
        growing_.back().triangles.push_back(seed);
        growing_.back().plane.add(triangle_corners(mesh_, seed));
        spread(found_.part_of[seed], thin);
    }

    /// Over neighbours, those nearest to the first triangle first.
    void spread(std::uint32_t number, Thin thin)
    {
        Growing& part = growing_[number];
        for (std::size_t i = 0; i < part.triangles.size(); ++i) {
            const std::uint32_t from = part.triangles[i];
            for (const std::uint32_t t : across_[from]) {
                if (t == kNoNeighbour || found_.part_of[t] != kInNoPart)
                    continue;
                const auto corners = triangle_corners(mesh_, t);
                if (is_far(part.plane, corners))
                    continue;
                if (!is_thin(t)) {
                    const Vec3d cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                    if (!(cross.dot(part.plane.normal()) > 0))
                        continue;
                } else if (thin == Thin::over_longest_side &&
                           across_[t][std::size_t(height_[t].longest_side)] != from) {
                    continue;
                }
                found_.part_of[t] = number;
                part.triangles.push_back(t);
                part.plane.add(corners);
            }
        }
    }

    /// Without what is off the plane that it has come to.
    void finish(std::uint32_t number)
    {
        const Growing& growing = growing_[number];
        FlatPart part = seen_along_axis(growing.plane);
        double low = 0, high = 0; // the plane goes through the part
        double folded = 0;
        for (const std::uint32_t t : growing.triangles) {
            const auto corners = triangle_corners(mesh_, t);
            const bool turned = turns(mesh_, mesh_.triangles[t], part);
            found_.part_of[t] = kInNoPart;
            if (is_far(growing.plane, corners) || (!turned && !is_thin(t)))
                continue;
            part.triangles.push_back(t);
            for (const Vec3d& p : corners) {
                low = std::min(low, growing.plane.height(p));
                high = std::max(high, growing.plane.height(p));
            }
            folded = std::max(folded, turned ? 0.0 : height_[t].over_longest);
        }
        if (part.triangles.size() < 2)
            return;
        for (const std::uint32_t t : part.triangles)
            found_.part_of[t] = static_cast<std::uint32_t>(found_.parts.size());
        part.thickness =
            std::hypot((high - low) / std::abs(growing.plane.normal()[part.axis]), folded);
        found_.parts.push_back(std::move(part));
    }

    /// A part without triangles, seen along the axis that is nearest to the plane's normal.
    static FlatPart seen_along_axis(const Plane& plane)
    {
        const Vec3d& n = plane.normal();
        FlatPart part;
        for (int axis = 1; axis < 3; ++axis)
            if (std::abs(n[axis]) > std::abs(n[part.axis]))
                part.axis = axis;
        part.turn = n[part.axis] < 0 ? -1 : 1;
        return part;
    }

    // Of the thickness. Twice that is between the planes, sqrt(3) times as much along an axis, and
    // what is folded in the plane is off by as much once more: .9 in all.
    static constexpr double kFarthest = 0.25;

    const TriangleMesh& mesh_;
    const std::vector<NeighboursAcross>& across_;
    double farthest_; ///< from the plane
    std::vector<Height> height_;
    std::vector<Growing> growing_;
    FlatParts found_; ///< while parts grow, part_of counts those
};

} // namespace

bool turns(const TriangleMesh& mesh, const openvdb::Vec3I& corners, const FlatPart& part)
{
    return exact::turn_along(part.axis, mesh.points[corners[0]], mesh.points[corners[1]],
                             mesh.points[corners[2]]) == part.turn;
}

FlatParts flat_parts(const TriangleMesh& mesh, const std::vector<NeighboursAcross>& across,
                     double thickness)
{
    return Grower(mesh, across, thickness).grow();
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/eight_distances.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A few triangles around a place, asked by up to eight points at a time which of them is nearest.
/// In floats relative to the place: off by 1e-7 of how far triangles and points are from it.
class TrianglesAround
{
public:
    /// `corners(i)` are those of triangle i; `scale` makes lengths numbers near 1.
    template <class Corners>
    void prepare(const openvdb::Vec3d& place, double scale, std::size_t count,
                 const Corners& corners)
    {
        place_ = place, scale_ = scale;
        triangles_.resize(count);
        for (std::size_t i = list_.size(); i < count; ++i)
            list_.push_back(static_cast<std::uint32_t>(i));
        for (std::size_t i = 0; i < count; ++i) {
            std::array<openvdb::Vec3d, 3> c = corners(i);
            for (openvdb::Vec3d& p : c)
                p = (p - place_) * scale_;
            triangles_[i] = prepare_triangle(c);
        }
    }

    /// For `count` points, `point(k)` each; squared distances in units of scale. Precondition: 1 to
    /// kLanes of them.
    template <class Point> const EightNearest& nearest(std::size_t count, const Point& point)
    {
        for (std::size_t k = 0; k < kLanes; ++k) {
            // Lanes without a point of their own repeat the last one.
            const openvdb::Vec3d p = (point(std::min(k, count - 1)) - place_) * scale_;
            points_.x[k] = float(p[0]), points_.y[k] = float(p[1]), points_.z[k] = float(p[2]);
        }
        nearest_of(triangles_.data(), list_.data(), triangles_.size(), points_, nullptr, nearest_);
        return nearest_;
    }

private:
    openvdb::Vec3d place_{0.0};
    double scale_ = 1;
    std::vector<PreparedTriangle> triangles_;
    std::vector<std::uint32_t> list_; ///< 0, 1, 2, ...
    EightPoints points_{};
    EightNearest nearest_{};
};

} // namespace vdb_shell

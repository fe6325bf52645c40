// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace vdb_shell::growth
{

/// Many points against a few triangles' planes: exact::PlaneFilter, four points at a time.
class PlaneSides
{
public:
    static constexpr std::size_t kMostPoints = 32, kMostPlanes = 12;

    void add_point(const openvdb::Vec3d& p)
    {
        x_[points_] = p[0], y_[points_] = p[1], z_[points_] = p[2];
        ++points_;
    }
    void add_plane(const std::array<openvdb::Vec3d, 3>& corner) { plane_[planes_++] = corner; }
    /// Looks at all points and planes added so far.
    void compute();
    /// Sign of det(b-a, c-a, p-a) where doubles decide it for certain, else 0.
    std::int64_t side(std::size_t plane, std::size_t point) const { return side_[plane][point]; }

private:
    using Points = std::array<double, kMostPoints>;
    alignas(32) Points x_, y_, z_;
    std::array<std::array<openvdb::Vec3d, 3>, kMostPlanes> plane_;
    alignas(32) std::array<std::array<std::int64_t, kMostPoints>, kMostPlanes> side_;
    std::size_t points_ = 0, planes_ = 0;
};

} // namespace vdb_shell::growth

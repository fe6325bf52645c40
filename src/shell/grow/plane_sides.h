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
    const std::array<openvdb::Vec3d, 3>& plane(std::size_t i) const { return plane_[i]; }
    /// Looks at all points and planes added so far.
    void compute();
    /// Whether doubles show for certain that the points, a bit for each, lie on one side of the
    /// plane, none in it.
    bool on_one_side(std::size_t plane, std::uint32_t points) const
    {
        return (plus_[plane] & points) == points || (minus_[plane] & points) == points;
    }

private:
    using Points = std::array<double, kMostPoints>;
    alignas(32) Points x_, y_, z_;
    std::array<std::array<openvdb::Vec3d, 3>, kMostPlanes> plane_;
    /// Points with det(b-a, c-a, p-a) > 0, and with < 0.
    std::array<std::uint32_t, kMostPlanes> plus_, minus_;
    std::size_t points_ = 0, planes_ = 0;
};

} // namespace vdb_shell::growth

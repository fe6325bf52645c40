// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <unordered_set>

namespace vdb_shell
{

/// Cells of points, apart for each plane that the points are said to lie in: needles of one plane
/// would have samples by the hundred in the same place.
class PlaneCells
{
public:
    /// Planes are told apart by normals, and by how far they are from the origin.
    PlaneCells(double cell, double apart) : cell_(cell), apart_(apart) {}
    void set_plane(const std::array<openvdb::Vec3d, 3>& c)
    {
        openvdb::Vec3d normal = (c[1] - c[0]).cross(c[2] - c[0]);
        const double length = normal.length();
        normal = length > 0 ? normal / length : openvdb::Vec3d(0.0);
        plane_ = {std::round(normal[0] * kNormals), std::round(normal[1] * kNormals),
                  std::round(normal[2] * kNormals), std::round(normal.dot(c[0]) / apart_)};
    }
    /// Whether the point is the first of its cell and its plane.
    bool take(const openvdb::Vec3d& p)
    {
        return taken_
            .insert({plane_[0], plane_[1], plane_[2], plane_[3], std::floor(p[0] / cell_),
                     std::floor(p[1] / cell_), std::floor(p[2] / cell_)})
            .second;
    }

private:
    // Normals are told apart by half a degree.
    static constexpr double kNormals = 100;
    using Key = std::array<double, 7>;
    struct Hash {
        std::size_t operator()(const Key& key) const
        {
            std::size_t hash = 0;
            for (const double k : key)
                hash = (hash ^ std::hash<double>()(k)) * 0x9E3779B97F4A7C15U;
            return hash;
        }
    };
    double cell_, apart_;
    std::array<double, 4> plane_{};
    std::unordered_set<Key, Hash> taken_; ///< asked, never walked through
};

} // namespace vdb_shell

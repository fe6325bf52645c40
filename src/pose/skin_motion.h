// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/interrupter.h"

#include <openvdb/Types.h>
#include <openvdb/math/Mat3.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// The motion of a skin, carried on into space: at each place the rigid motion that fits the skin
/// best, where a piece of skin weighs by the solid angle under which that place sees it from its
/// own side, over the distance squared. Far pieces are taken together (Barnes and Hut 1986), by the
/// rest shape alone, so the carried points move as continuously as the skin does.
class SkinMotion
{
public:
    SkinMotion() = default;
    SkinMotion(const std::vector<openvdb::Vec3s>& rest,
               const std::vector<openvdb::Vec3I>& triangles);

    /// Sums over the pieces of skin for one pose.
    struct Frame {
        struct Sums {
            openvdb::Vec3d centre{0.0};
            openvdb::math::Mat3<double> moment = openvdb::math::Mat3<double>::zero();
        };
        openvdb::Vec3d origin{0.0};
        std::vector<Sums> sums; ///< by node
    };
    Frame frame(const std::vector<openvdb::Vec3s>& posed) const;

    enum class Side { inside, outside };
    /// Where a place on that side of the skin goes in that pose.
    openvdb::Vec3d carry(const Frame& frame, const openvdb::Vec3d& place, Side side) const;

private:
    struct Node {
        openvdb::Vec3d centre{0.0};      ///< mean, weighted by area, from origin_
        openvdb::Vec3d area_normal{0.0}; ///< sum of areas times normals
        double area = 0, radius = 0;
        std::uint32_t begin = 0, end = 0; ///< in order_
        std::uint32_t right = 0; ///< 0: a leaf, of one vertex; the left child is the next node
    };
    void build(std::uint32_t begin, std::uint32_t end);

    openvdb::Vec3d origin_{0.0};
    std::vector<openvdb::Vec3d> place_, normal_; ///< by vertex; area times normal
    std::vector<double> area_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace vdb_shell

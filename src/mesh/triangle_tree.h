// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/raw_vector.h"
#include "core/simd.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Finds the triangle nearest to a point, in floats, eight boxes or triangles at a time. A tree
/// of our own: a query may stop short of the very nearest, so its answer depends on the tree's
/// shape, which for the same bits on any number of threads must not depend on how a library builds
/// it. Boxes are turned with the surface: from deep inside, boxes along the axes around pieces of a
/// slanted wall seem nearer than the wall by as much as they are thick, and then all those within
/// many voxels of the foot have to be looked into.
class TriangleTree
{
public:
    /// Lengths inside the tree are in units of `unit`, relative to the middle of the mesh.
    TriangleTree(const TriangleMesh& mesh, double unit);

    /// Where the last query ended: the next one nearby begins there.
    using Seed = std::uint32_t;
    static constexpr Seed kNoSeed = ~0U;

    struct Found {
        std::uint32_t triangle;
        float squared; ///< of its distance
    };
    /// A triangle no farther than `tolerance` (in units) more than the nearest. Without tolerance
    /// the distance does not depend on the seed, to the last bit.
    Found nearest(const openvdb::Vec3d& point, float tolerance, Seed& seed) const;

    using LaneFloats = std::array<float, kLanes>;
    /// Boxes of eight children, each in a frame of its own; a child that is not there has an
    /// infinite box. Children have successive numbers.
    struct alignas(kLanesAlignment) Node {
        std::array<std::array<LaneFloats, 3>, 3> axis;
        std::array<LaneFloats, 3> low, high;
        std::uint32_t first_child; ///< from kLeafBit on a block
    };
    /// Boxes picked from several nodes.
    struct alignas(kLanesAlignment) Picked {
        std::array<std::array<LaneFloats, 3>, 3> axis;
        std::array<LaneFloats, 3> low, high;
        std::array<std::uint32_t, kLanes> child;
    };
    /// What can be nearest to the points of a ball: many queries near each other begin here.
    struct Nearby {
        openvdb::Vec3d centre{0.0};
        double radius = -1; ///< of the ball; less than 0: nothing yet
        Seed seed = kNoSeed;
        std::vector<Picked> picked;
        std::size_t count = 0; ///< of what is picked
    };
    /// Both in world units.
    void gather(const openvdb::Vec3d& centre, double radius, Nearby& nearby) const;
    /// The squared distance of a point in the ball to the nearest triangle, in units: a pure
    /// function of mesh and point.
    float squared_distance(const openvdb::Vec3d& point, Nearby& nearby) const;

    /// The triangles no farther from a place than `radius`, each once, in the order of the tree;
    /// both in world units. What is farther by rounding may be among them: nothing that is within
    /// is left out if the radius has 2e-6 of the mesh's diagonal to spare.
    void list_within(const openvdb::Vec3d& centre, double radius,
                     std::vector<std::uint32_t>& triangles) const;

    /// Prepared triangles, by component: corners, outward normals of their sides in the plane,
    /// inverse squares of the sides' lengths.
    struct alignas(kLanesAlignment) Block {
        std::array<std::array<LaneFloats, 3>, 3> corner, beyond;
        std::array<LaneFloats, 3> inverse, normal;
        LaneFloats bias; ///< 1 for a triangle without a normal: no point projects into it
        std::array<std::uint32_t, kLanes> triangle;
    };

    /// What queries read.
    struct Arrays {
        openvdb::Vec3d middle{0.0};
        double unit = 1;
        RawVector<Node> nodes;
        RawVector<Block> blocks;
        std::uint32_t root = 0;
    };
    /// Of the numbers of nodes, marks those of blocks.
    static constexpr std::uint32_t kLeafBit = 1U << 31;

private:
    Arrays arrays_;
};

} // namespace vdb_shell

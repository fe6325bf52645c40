// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/eight_distances.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Finds the triangle nearest to a point, in floats, four boxes or triangles at a time. A tree of
/// our own: a query may stop short of the very nearest, so its answer depends on the tree's shape,
/// which for the same bits on any number of threads must not depend on how a library builds it.
class TriangleTree
{
public:
    /// Lengths inside the tree are in units of `unit`, relative to the middle of the mesh.
    TriangleTree(const TriangleMesh& mesh, double unit);

    /// A triangle no farther than `tolerance` (in units) more than the nearest: without some
    /// tolerance the middle of a sphere would have to look at all triangles.
    std::uint32_t nearest(const openvdb::Vec3d& point, float tolerance) const;

private:
    /// Boxes of four children, by axis. A child is a node, or from kLeafBit on a block of four
    /// triangles.
    struct Node {
        std::array<Four, 3> low, high;
        std::array<std::uint32_t, 4> child;
    };
    /// Four prepared triangles, by component.
    struct Block {
        struct Side {
            Four x, y, z, ex, ey, ez, inverse, mx, my, mz;
        };
        std::array<Side, 3> side;
        Four nx, ny, nz, bias;
        std::array<std::uint32_t, 4> triangle;
    };
    struct Item {
        openvdb::Vec3f low, high;
        std::uint32_t triangle;
    };
    static constexpr std::uint32_t kLeafBit = 1U << 31, kNone = ~0U;

    std::uint32_t build(const TriangleMesh& mesh, std::vector<Item>& items, std::size_t begin,
                        std::size_t end);
    std::uint32_t add_block(const TriangleMesh& mesh, const std::vector<Item>& items,
                            std::size_t begin, std::size_t end);
    // Templates, for they are inlined only when they are not exported.
    template <typename N>
    static Four box_distances(const N& node, const std::array<Four, 3>& point);
    template <typename B> static Four distances(const B& block, const std::array<Four, 3>& point);
    std::array<openvdb::Vec3d, 3> corners(const TriangleMesh& mesh, std::uint32_t triangle) const;

    openvdb::Vec3d middle_;
    double unit_;
    std::vector<Node> nodes_;
    std::vector<Block> blocks_;
    std::uint32_t root_ = kNone;
};

} // namespace vdb_shell

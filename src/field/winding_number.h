// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

using TriangleCorners = std::array<openvdb::Vec3d, 3>;

/// The generalised winding number of a triangle soup: how often its triangles turn around a point,
/// 1 inside a closed surface that is oriented outward, a fraction where there are gaps (Jacobson
/// et al.). Near triangles by their solid angles, far ones and far clusters by their dipole (Barill
/// et al., first order): the error was up to 0.02 on closed meshes.
class WindingNumber
{
public:
    explicit WindingNumber(std::vector<TriangleCorners> triangles);

    /// The turns around points that are near each other: what is far from all of them is looked up
    /// once. In floats relative to the points' middle.
    void around(const openvdb::Vec3d* points, std::size_t count, float* turns) const;

    /// In the order of the tree: triangles that are near each other stand near each other.
    const std::vector<TriangleCorners>& triangles() const { return triangles_; }

    /// A cluster of triangles: a node of the tree, or a leaf of it.
    struct Node {
        openvdb::Vec3d centre{0.0};      ///< mean, weighted by area
        openvdb::Vec3d area_normal{0.0}; ///< sum of areas times normals
        double radius = 0;               ///< largest distance of a corner from the centre
        std::uint32_t begin = 0, end = 0;
        std::uint32_t right = 0; ///< 0: a leaf; the left child stands next to its parent
    };
    /// The root first; none without triangles.
    const std::vector<Node>& nodes() const { return nodes_; }
    /// As above, of the triangles in these nodes only.
    void around(const std::vector<std::uint32_t>& nodes, const openvdb::Vec3d* points,
                std::size_t count, float* turns) const;

    /// From this many radii on, a cluster counts as one dipole. The error of the field comes from
    /// this number.
    static constexpr double kFar = 3.0;

private:
    struct Surroundings;
    /// A triangle from afar.
    struct Dipole {
        openvdb::Vec3d centre, area_normal;
        double far = 0; ///< from this distance on it counts as one
    };
    void build(std::uint32_t begin, std::uint32_t end);
    void summarise(Node& node) const;
    void look_around(std::uint32_t node, Surroundings& from) const;

    std::vector<TriangleCorners> triangles_;
    std::vector<Dipole> dipoles_; ///< of the triangles
    std::vector<Node> nodes_;
};

} // namespace vdb_shell

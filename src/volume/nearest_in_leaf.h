// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "mesh/eight_distances.h"
#include "mesh/triangle_tree.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

// The nearest of a list of triangles for each voxel of a leaf (8 x 8 x 8), and the lists of
// triangles that can be nearest to any voxel of it.

namespace vdb_shell
{

/// What all leaves read: the triangles made ready for floats, about the middle of the mesh and in
/// voxels.
class DistanceSurface
{
public:
    /// Precondition: at least one triangle.
    DistanceSurface(const TriangleMesh& mesh, double voxel_size);

    const TriangleMesh& mesh() const { return mesh_; }
    double voxel_size() const { return voxel_; }
    const TriangleTree& tree() const { return tree_; }
    const PreparedTriangle* prepared() const { return prepared_.data(); }
    /// Two distances of floats may be told in the wrong order where they differ by less, voxels.
    double slack_voxels() const { return slack_; }
    /// A place in index space, as floats have it.
    openvdb::Vec3f about_middle(const openvdb::Vec3d& index) const
    {
        return openvdb::Vec3f(index - middle_);
    }
    /// World units, in doubles.
    double distance(const openvdb::Coord& voxel, std::uint32_t triangle) const;

private:
    const TriangleMesh& mesh_;
    double voxel_;
    openvdb::Vec3d middle_; ///< in index space
    double slack_;
    TriangleTree tree_;
    std::vector<PreparedTriangle> prepared_;
};

/// Searches leaf after leaf; one for each thread.
class NearestInLeaf
{
public:
    static constexpr std::size_t kVoxels = 512;
    using List = std::vector<std::uint32_t>;
    /// A bit for each voxel that is asked for, a word for each x.
    using Mask = std::array<std::uint64_t, 8>;
    struct Voxels {
        std::array<std::uint32_t, kVoxels> triangle;
        std::array<double, kVoxels> distance; ///< world units, in doubles
    };

    explicit NearestInLeaf(const DistanceSurface& surface) : surface_(surface) {}

    /// Fills those voxels of the mask with the nearest triangle of the list, the smallest index
    /// where several are as near, and the distance to it. Neither depends on what else is in the
    /// list. Precondition: the list is not empty, and has no triangle twice.
    void nearest_of_list(const openvdb::Coord& origin, const Mask& mask, const List& list,
                         Voxels& found);

    /// Every triangle that can be nearest to a voxel of the mask, each once. `known`: some
    /// triangles, whose distances bound those that are looked for; may be empty.
    void list_nearest(const openvdb::Coord& origin, const Mask& mask, const List& known,
                      List& list);

private:
    void descend(std::size_t level, const openvdb::Coord& corner, const List& list, Voxels& found);
    void take_nearest(const openvdb::Coord& corner, const List& list, Voxels& found);
    void thin_out(const List& list, const std::array<float, kLanes>& limit);
    EightPoints points_at(const openvdb::Coord& corner, int side) const;
    bool wanted(const openvdb::Coord& corner, int side) const;

    const DistanceSurface& surface_;
    openvdb::Coord origin_;
    Mask mask_{};
    std::array<std::array<List, kLanes>, 3> lists_; ///< by level, of each of the eight blocks
    std::vector<float> squared_;
    std::vector<std::uint8_t> within_;
    TriangleTree::Seed seed_ = TriangleTree::kNoSeed;
};

} // namespace vdb_shell

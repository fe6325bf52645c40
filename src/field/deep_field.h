// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "field/field_sampler.h"
#include "mesh/triangle_tree.h"

namespace vdb_shell
{

/// The inside of a level set beyond its narrow band, computed only where it is read: a voxel's
/// value is minus its distance to the surface, as the dense grid would have it.
class DeepField
{
public:
    /// The precondition of mesh_to_narrow_band holds for the mesh, and `band` is its result, or
    /// that of a finer surface.
    DeepField(const TriangleMesh& mesh, const openvdb::FloatGrid& band)
        : mesh_(mesh), band_(band), voxel_(band.voxelSize()[0]), tree_(mesh, voxel_)
    {
    }

    const openvdb::FloatGrid& band() const { return band_; }
    double voxel() const { return voxel_; }

    /// Value of a voxel inside; a pure function of mesh and voxel.
    /// `base` is the least corner of the cell in whose stencil the voxel is, and `nearby` is kept
    /// from one voxel to the next.
    float value(const openvdb::Coord& at, const openvdb::Coord& base,
                TriangleTree::Nearby& nearby) const;
    /// The point of the surface nearest to a place, to a twentieth of a voxel in distance.
    openvdb::Vec3d nearest_point(const openvdb::Vec3d& world, TriangleTree::Seed& seed) const;

private:
    const TriangleMesh& mesh_;
    const openvdb::FloatGrid& band_;
    double voxel_;
    TriangleTree tree_;
};

/// The voxels of a deep field for one thread, which remembers those it has computed.
class DeepVoxels
{
public:
    explicit DeepVoxels(const DeepField& field)
        : field_(field), band_(field.band().getConstAccessor()),
          known_(openvdb::FloatGrid::create()), accessor_(known_->getAccessor())
    {
    }
    /// The voxels read next are those around this one.
    void about(const openvdb::Coord& base) { base_ = base; }
    bool probe(const openvdb::Coord& at, float& value)
    {
        if (band_.probeValue(at, value))
            return true;
        if (value > 0)
            return false;
        if (accessor_.probeValue(at, value))
            return true;
        value = field_.value(at, base_, nearby_);
        accessor_.setValue(at, value);
        return true;
    }

private:
    const DeepField& field_;
    openvdb::FloatGrid::ConstAccessor band_;
    openvdb::FloatGrid::Ptr known_;
    openvdb::FloatGrid::Accessor accessor_;
    openvdb::Coord base_;
    TriangleTree::Nearby nearby_;
};

using DeepSampler = StencilSampler<DeepVoxels>;

} // namespace vdb_shell

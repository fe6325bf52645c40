// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <array>
#include <cstddef>
#include <utility>

namespace vdb_shell
{

/// What a field says at one point.
struct FieldSample {
    double phi = 0;
    openvdb::Vec3d gradient{0.0}; ///< central differences, interpolated trilinearly, per world unit
    bool in_band = false;         ///< every voxel that was read is active
};

/// The voxels of a grid.
class GridVoxels
{
public:
    explicit GridVoxels(const openvdb::FloatGrid& grid) : accessor_(grid.getConstAccessor()) {}
    void about(const openvdb::Coord&) const {}
    bool probe(const openvdb::Coord& at, float& value) const
    {
        return accessor_.probeValue(at, value);
    }

private:
    openvdb::FloatGrid::ConstAccessor accessor_;
};

/// Reads a level set at world points; Voxels has bool probe(Coord, float&), true where the voxel is
/// active, and about(Coord), told the cell before its stencil is probed. The gradient is
/// OpenTissue's: central differences at the eight voxels around the point, interpolated
/// trilinearly, left at the length that comes out (half the stencil's slope across a medial sheet;
/// method of the paper's authors). One object per thread.
template <typename Voxels> class StencilSampler
{
public:
    StencilSampler(const openvdb::math::Transform& transform, Voxels voxels)
        : transform_(transform), voxels_(std::move(voxels))
    {
    }

    FieldSample at(const openvdb::Vec3d& world)
    {
        // A step may be of any length; voxels are whole numbers, and no grid reaches so far.
        const openvdb::Vec3d far(1e9);
        const openvdb::Vec3d index = openvdb::math::maxComponent(
            -far, openvdb::math::minComponent(transform_.worldToIndex(world), far));
        const openvdb::Coord base = openvdb::Coord::floor(index);
        if (!fetched_ || base != base_)
            fetch(base);
        const openvdb::Vec3d f = index - base.asVec3d();
        FieldSample sample;
        sample.in_band = in_band_;
        openvdb::Vec3d gradient(0.0);
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                for (int k = 0; k < 2; ++k) {
                    const double weight =
                        (i ? f[0] : 1 - f[0]) * (j ? f[1] : 1 - f[1]) * (k ? f[2] : 1 - f[2]);
                    sample.phi += weight * value(i, j, k);
                    gradient += 0.5 * weight *
                                openvdb::Vec3d(value(i + 1, j, k) - value(i - 1, j, k),
                                               value(i, j + 1, k) - value(i, j - 1, k),
                                               value(i, j, k + 1) - value(i, j, k - 1));
                }
        sample.gradient = transform_.baseMap()->applyIJT(gradient);
        return sample;
    }

private:
    // The point's cell has corners 0 and 1 on each axis; the stencil reaches from -1 to 2.
    static std::size_t slot(int i, int j, int k)
    {
        const int n = (i + 1) * 16 + (j + 1) * 4 + (k + 1);
        return static_cast<std::size_t>(n);
    }
    double value(int i, int j, int k) const { return values_[slot(i, j, k)]; }

    void fetch(const openvdb::Coord& base)
    {
        base_ = base;
        voxels_.about(base);
        fetched_ = in_band_ = true;
        for (int i = -1; i <= 2; ++i)
            for (int j = -1; j <= 2; ++j)
                for (int k = -1; k <= 2; ++k) {
                    const int beyond = (i < 0 || i > 1) + (j < 0 || j > 1) + (k < 0 || k > 1);
                    if (beyond > 1)
                        continue;
                    float read = 0;
                    in_band_ &= voxels_.probe(base.offsetBy(i, j, k), read);
                    values_[slot(i, j, k)] = read;
                }
    }

    const openvdb::math::Transform& transform_;
    Voxels voxels_;
    // Two steps of half a voxel mostly fall into one cell: the stencil is read once for both.
    openvdb::Coord base_;
    bool fetched_ = false, in_band_ = false;
    std::array<double, 64> values_{};
};

class FieldSampler : public StencilSampler<GridVoxels>
{
public:
    explicit FieldSampler(const openvdb::FloatGrid& grid)
        : StencilSampler(grid.transform(), GridVoxels(grid))
    {
    }
};

} // namespace vdb_shell

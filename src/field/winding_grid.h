// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "field/winding_number.h"

#include <cmath>
#include <utility>
#include <vector>

namespace vdb_shell
{

// More than the half that the winding number reaches on the face of a single sheet, with room for
// the error of the far dipoles. For closed surfaces any value between does, since it jumps from 0
// to 1 there.
inline constexpr double kInsideWinding = 0.6;

/// By how much a winding number is short of the inside, in turns; negative in the solid. The
/// absolute value lets a component be inside out.
inline double short_of_inside(float turns)
{
    return kInsideWinding - std::abs(double(turns));
}

/// The winding number of triangles at voxels, each computed once.
class WindingGrid
{
public:
    explicit WindingGrid(std::vector<TriangleCorners> triangles) : number_(std::move(triangles)) {}

    const WindingNumber& number() const { return number_; }
    std::vector<float> at(const std::vector<openvdb::Coord>& voxels);

private:
    WindingNumber number_;
    openvdb::FloatGrid turns_;
};

/// The active voxels of a tree, leaf by leaf.
std::vector<openvdb::Coord> active_voxels(const openvdb::MaskTree& tree);

} // namespace vdb_shell

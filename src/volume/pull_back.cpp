// SPDX-License-Identifier: Apache-2.0

// Takes a place in a shell; gives the derivative of the way from the pose to rest there, and what
// that does to vectors.

#include "volume/pull_back.h"

#include "vdb_shell/core/error.h"

#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Mat3d;
using openvdb::Vec3d;

/// Of a singular matrix the identity: where a prism is pressed flat the way back says nothing of
/// directions, and a vector that stays is better than one that is infinite.
Mat3d inverse(const Mat3d& matrix)
{
    return matrix.det() == 0.0 ? Mat3d::identity() : matrix.inverse(0.0);
}

} // namespace

Pullback pull_back(const ShellMap& rest, const ShellMap& posed, const ShellPlace& place)
{
    Pullback back;
    back.rest = rest.point_of(place);
    const Mat3d at_pose = posed.jacobian_of(place);
    // On a pinned pillar the share inwards says nothing, and there is nothing to be undone.
    if (at_pose.det() != 0.0)
        back.by_pose = rest.jacobian_of(place) * at_pose.inverse(0.0);
    // A pose that is not certified may have tets that are turned inside out: they cover a volume
    // all the same, and mass is not negative.
    back.volume_ratio = std::abs(back.by_pose.det());
    return back;
}

VectorMap vector_map(const openvdb::GridBase& grid, VectorRule rule)
{
    switch (rule) {
    case VectorRule::keep:
        return VectorMap::keep;
    case VectorRule::transform:
        return VectorMap::forward;
    case VectorRule::rotate:
        return VectorMap::rotate;
    case VectorRule::by_type:
        break;
    }
    switch (grid.getVectorType()) {
    case openvdb::VEC_INVARIANT:
        return VectorMap::keep;
    // As gradients and normals are: they are carried by the transposed of the derivative of the way
    // back.
    case openvdb::VEC_COVARIANT:
        return VectorMap::normal;
    case openvdb::VEC_COVARIANT_NORMALIZE:
        return VectorMap::unit_normal;
    case openvdb::VEC_CONTRAVARIANT_RELATIVE:
        return VectorMap::forward;
    case openvdb::VEC_CONTRAVARIANT_ABSOLUTE:
        break;
    }
    throw InvalidOption("grid \"" + grid.getName() +
                        "\": its vectors are absolute places (contravariant absolute), which a "
                        "deformed volume cannot carry; say what to do with --vectors");
}

Vec3d carried_vector(const Vec3d& vector, VectorMap map, const Mat3d& by_pose)
{
    switch (map) {
    case VectorMap::keep:
        return vector;
    case VectorMap::forward:
        return inverse(by_pose) * vector;
    // A normal stays square to a surface that is stretched, which a vector that is stretched with
    // it does not. `by_pose` is the derivative of rest by pose, so its transposed carries from rest
    // to the pose.
    case VectorMap::normal:
        return by_pose.transpose() * vector;
    case VectorMap::unit_normal: {
        Vec3d normal = by_pose.transpose() * vector;
        normal.normalize(0.0);
        return normal;
    }
    case VectorMap::rotate: {
        Mat3d turn, stretch;
        // The turning part of the derivative, without its stretch: the vector keeps its length.
        return openvdb::math::polarDecomposition(inverse(by_pose), turn, stretch) ? turn * vector
                                                                                  : vector;
    }
    }
    return vector;
}

void require_inside(const std::string& grid, double outside, double most_outside)
{
    if (outside > most_outside)
        throw InvalidOption("grid \"" + grid + "\": " + std::to_string(100 * outside) +
                            " % of it lies outside the shell at rest, more than the " +
                            std::to_string(100 * most_outside) +
                            " % of --most-outside; make the shell thicker, fill its core, or build "
                            "it on both sides");
}

} // namespace vdb_shell

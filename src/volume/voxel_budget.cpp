// SPDX-License-Identifier: Apache-2.0

// Takes tets and a voxel size, gives an estimate of what grids over them take. It has two steps,
// for the faces that bound the tets are only looked for where a bound that costs nothing to speak
// of is too large.

#include "volume/voxel_budget.h"

#include "core/available_memory.h"
#include "core/fail.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

/// Leaves have 8^3 voxels and are made whole.
constexpr double kVoxelsAlongLeaf = 8;
/// A surface meets leaves within that many voxels on either side on average, as in level_set.cpp.
constexpr double kLeafReach = 6;
/// A tet in a column of leaves (tet_columns.h), in a list that is sorted into another one.
constexpr double kJobBytes = 24;

/// Of what the tets take, in voxels of the wanted size.
struct Extent {
    double solid = 0;   ///< volume
    double columns = 0; ///< of leaves, over the boxes of all tets
    double leaves = 0;  ///< of those columns, all voxels
};

Extent extent_of(const TetMesh& tets, double voxel)
{
    Extent extent;
    for (const openvdb::Vec4I& tet : tets.tets) {
        std::array<Vec3d, 4> corner;
        for (int k = 0; k < 4; ++k)
            corner[std::size_t(k)] = Vec3d(tets.points[tet[k]]) / voxel;
        Vec3d low = corner[0], high = corner[0];
        for (const Vec3d& at : corner) {
            low = openvdb::math::minComponent(low, at);
            high = openvdb::math::maxComponent(high, at);
        }
        const Vec3d size = high - low;
        extent.solid +=
            std::abs(
                (corner[1] - corner[0]).dot((corner[2] - corner[0]).cross(corner[3] - corner[0]))) /
            6;
        const double columns = (size[0] / kVoxelsAlongLeaf + 1) * (size[1] / kVoxelsAlongLeaf + 1);
        extent.columns += columns;
        extent.leaves += columns * (size[2] / kVoxelsAlongLeaf + 1) * std::pow(kVoxelsAlongLeaf, 3);
    }
    return extent;
}

/// Of the faces that belong to one tet only.
double boundary_area(const TetMesh& tets)
{
    std::vector<std::array<std::uint32_t, 3>> faces;
    faces.reserve(4 * tets.tets.size());
    for (const openvdb::Vec4I& tet : tets.tets)
        for (int left_out = 0; left_out < 4; ++left_out) {
            std::array<std::uint32_t, 3> face{};
            for (int k = 0, n = 0; k < 4; ++k)
                if (k != left_out)
                    face[std::size_t(n++)] = tet[k];
            std::sort(face.begin(), face.end());
            faces.push_back(face);
        }
    std::sort(faces.begin(), faces.end());
    double area = 0;
    for (std::size_t begin = 0, end = 0; begin < faces.size(); begin = end) {
        while (end < faces.size() && faces[end] == faces[begin])
            ++end;
        const Vec3d a(tets.points[faces[begin][0]]);
        if (end - begin == 1)
            area += 0.5 * (Vec3d(tets.points[faces[begin][1]]) - a)
                              .cross(Vec3d(tets.points[faces[begin][2]]) - a)
                              .length();
    }
    return area;
}

double longest_side(const TetMesh& tets)
{
    const Bounds bounds = bounds_of(tets.points);
    const Vec3d size = bounds.high - bounds.low;
    return std::max({size[0], size[1], size[2]});
}

} // namespace

void require_voxels_inside(const openvdb::Int32Grid& inside, const TetMesh& tets,
                           const std::string& name)
{
    if (inside.tree().leafCount() == 0)
        fail<GeometryError>(name, ": voxel larger than the shell: no voxel centre lies in a tet, ",
                            "voxel size ", inside.voxelSize()[0], ", longest side ",
                            longest_side(tets));
}

void require_voxels_fit(const TetMesh& tets, double voxel_size, double bytes,
                        const std::string& name)
{
    if (!(voxel_size > 0) || !std::isfinite(voxel_size))
        fail<InvalidOption>(name, ": voxel size ", voxel_size, " is not positive and finite");
    const Bounds bounds = bounds_of(tets.points);
    const Vec3d size = bounds.high - bounds.low;
    const double longest = longest_side(tets);
    if (voxel_size >= longest)
        fail<GeometryError>(name, ": voxel larger than the shell: voxel size ", voxel_size,
                            ", longest side ", longest);
    // Beyond that voxels have no numbers, and making the columns says of which point.
    constexpr double kMostVoxels = 1 << 30;
    if (!(longest / voxel_size < kMostVoxels))
        return;
    const Extent extent = extent_of(tets, voxel_size);
    double box = 1;
    for (int axis = 0; axis < 3; ++axis)
        box *= size[axis] / voxel_size + 2 * kVoxelsAlongLeaf;
    const double free = available_memory(), jobs = extent.columns * kJobBytes;
    // Many tets share a leaf, so their boxes are a bound that is often far too large.
    if (std::min(extent.leaves, box) * bytes + jobs <= free)
        return;
    // Half of the box of a tet is over columns that it does not meet.
    const double voxels =
        std::min(extent.solid + boundary_area(tets) / (voxel_size * voxel_size) * kLeafReach, box);
    const double estimate = voxels * bytes + 0.5 * jobs;
    if (!(estimate <= free))
        fail<GeometryError>(name, ": voxel size ", voxel_size, " needs an estimated ",
                            estimate / kBytesPerGib, " GiB, over the ", free / kBytesPerGib,
                            " GiB that are free; enlarge the voxels (--voxel-size)");
}

} // namespace vdb_shell

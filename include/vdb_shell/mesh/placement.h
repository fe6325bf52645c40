// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"

#include <vector>

namespace vdb_shell
{

/// Where the coordinates of a mesh stand in those of the file that it was read from:
/// file = origin + unit * mesh. float32 has 24 binary digits: far from the origin few of them are
/// left for the object itself, and OpenVDB's transforms hold no voxels under 1.5e-5. An object is
/// therefore read about an origin of its own and in a unit of its own when asked.
struct Placement {
    openvdb::Vec3d origin{0.0};
    double unit = 1.0; ///< a power of two, so that it is undone without rounding

    bool moves() const { return origin != openvdb::Vec3d(0.0) || unit != 1.0; }
    /// In double; exact unless the sum needs more than 53 binary digits.
    openvdb::Vec3d in_file(const openvdb::Vec3s& point) const
    {
        return origin + unit * openvdb::Vec3d(point);
    }
    /// The origin in units of the mesh: what the transforms of a .vdb are moved by.
    openvdb::Vec3d shift() const { return origin / unit; }
};

/// The placement for an object in `box`, in the file's coordinates. `recentre`: the origin is the
/// point of the lattice spaced by the first power of two over the longest side that is nearest to
/// the middle of the box: a number of few digits, and 0 for what stands at the origin already.
/// `rescale`: the unit is the largest power of two that is not over the longest side. A box without
/// extent keeps unit and origin.
Placement placement_for(const Bounds& box, bool recentre, bool rescale);

/// Points of a mesh that stands as `own` says become those of one that stands as `placement` says.
/// Through the file's coordinates in doubles: digits that the two frames keep are not lost in
/// between. Where neither moves the points keep their bits.
void bring_into(const Placement& placement, const Placement& own,
                std::vector<openvdb::Vec3s>& points);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/describe.h"

#include <openvdb/Types.h>

namespace vdb_shell
{

enum class UpAxis { y, z };
const NameTable<UpAxis>& names(UpAxis);

/// From where a picture is taken, without perspective.
struct ViewOptions {
    UpAxis up = UpAxis::y;
    /// About the up axis, from the front: along -z where y is up, along y where z is up. Grows
    /// counter-clockwise seen from above.
    double azimuth_radians = 0.6;
    double elevation_radians = 0.3; ///< pi / 2: from above
    int turntable = 0;              ///< frames of one revolution; 0: the view stays
    int turntable_frame = 0;        ///< the view is turned by this frame's share of a revolution
};
OptionList describe(ViewOptions& options);

/// Right-handed and orthonormal.
struct ViewAxes {
    openvdb::Vec3d right, up, towards; ///< the last one points at the viewer

    openvdb::Vec3d in_view(const openvdb::Vec3d& p) const
    {
        return {p.dot(right), p.dot(up), p.dot(towards)};
    }
};
ViewAxes view_axes(const ViewOptions& options);

} // namespace vdb_shell

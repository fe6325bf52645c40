// SPDX-License-Identifier: Apache-2.0

// Takes the angles of a view, gives its axes. All pictures that are not plain sections use them.

#include "vdb_shell/write/view.h"

#include "vdb_shell/options/option.h"

#include <openvdb/math/Math.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

constexpr double kPi = openvdb::math::pi<double>();

} // namespace

const NameTable<UpAxis>& names(UpAxis)
{
    static const NameTable<UpAxis> table{{"y", UpAxis::y}, {"z", UpAxis::z}};
    return table;
}

/// Rounded up to the digits that messages show, so that the bound itself can be typed.
constexpr double kQuarterTurn = 1.5708;

OptionList describe(ViewOptions& o)
{
    return in_group(
        "Output", {option("view_up", o.up, "--view-up", "Axis that points up in a picture in space")
                       .needing("--picture surface cut-away"),
                   option("azimuth_radians", o.azimuth_radians, "--view-azimuth",
                          "Turn of the view about that axis, from the front")
                       .needing("--picture surface cut-away")
                       .in(Unit::radians),
                   option("elevation_radians", o.elevation_radians, "--view-elevation",
                          "Height of the view above the horizon")
                       .needing("--picture surface cut-away")
                       .in(Unit::radians)
                       .within(at_least(-kQuarterTurn).at_most(kQuarterTurn)),
                   option("turntable", o.turntable, "--turntable",
                          "Frames of one revolution about the up axis; 0 for none")
                       .needing("--picture surface cut-away")
                       .in(Unit::count)
                       .within(at_least(0)),
                   option("turntable_frame", o.turntable_frame, "--turntable-frame",
                          "The frame of the revolution; '%d' in a call with --frames")
                       .needing("--turntable")});
}

ViewAxes view_axes(const ViewOptions& options)
{
    const double turn =
        options.turntable > 0 ? 2 * kPi * options.turntable_frame / options.turntable : 0.0;
    const double azimuth = options.azimuth_radians + turn,
                 elevation = std::clamp(options.elevation_radians, -kPi / 2, kPi / 2);
    const double sine = std::sin(azimuth), cosine = std::cos(azimuth);
    const double level = std::cos(elevation), height = std::sin(elevation);
    ViewAxes axes;
    // At azimuth 0 seen from +z where y is up, and from -y where z is: the front, in programs of
    // either kind.
    if (options.up == UpAxis::y) {
        axes.right = {cosine, 0.0, -sine};
        axes.towards = {sine * level, height, cosine * level};
    } else {
        axes.right = {cosine, sine, 0.0};
        axes.towards = {sine * level, -cosine * level, height};
    }
    // Square to both and right-handed, so pictures are not mirrored.
    axes.up = axes.towards.cross(axes.right);
    return axes;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes the box of what is drawn, gives the size of its picture and the way from the one to the
// other. Sections and pictures in space have the same margins.

#include "write/picture_frame.h"

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

constexpr double kMargin = 0.03; ///< of the longer side, on each side

} // namespace

PictureFrame frame_of(const openvdb::Vec2d& low, const openvdb::Vec2d& high, int longer_pixels)
{
    PictureFrame frame;
    frame.low = low;
    const double wide = high[0] - low[0], tall = high[1] - low[1];
    const double longer = std::max(wide, tall);
    frame.margin = kMargin * longer_pixels;
    // The margin is a part of the picture's size and not added to it, so a picture is as wide as
    // was asked.
    const double room = longer_pixels - 2.0 * frame.margin;
    frame.scale = longer > 0.0 ? room / longer : 1.0;
    const auto pixels = [&](double side) {
        const double size = std::round(side * frame.scale + 2.0 * frame.margin);
        return std::clamp(int(size), kSmallestWidth, longer_pixels);
    };
    frame.width = pixels(wide);
    frame.height = pixels(tall);
    return frame;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

namespace vdb_shell
{

/// Pixels along a side. The upper end bounds the memory of the picture: 16384 squared pixels of
/// three bytes are 805 MB. The lower end also holds for the shorter side, so that a flat shape
/// stays visible.
inline constexpr int kSmallestWidth = 16, kLargestWidth = 16384;

/// What all pictures of tets have in common: samples per pixel and direction, the colour of edges.
constexpr int kSamples = 3;
inline const openvdb::Vec3f edge_colour(0.16f, 0.20f, 0.26f);

/// World units to pixels, y downwards.
struct PictureFrame {
    openvdb::Vec2d low{0.0, 0.0};
    double scale = 1.0, margin = 0.0;
    int width = 0, height = 0;

    // World y grows upwards, rows of a picture downwards, so y is turned round here. That mirrors
    // the outlines: whoever needs their orientation has to take it before this step.
    openvdb::Vec2d place(const openvdb::Vec2d& p) const
    {
        return {(p[0] - low[0]) * scale + margin, height - margin - (p[1] - low[1]) * scale};
    }
};

/// The longer side gets all pixels that were wanted, the shorter one as many as its share needs;
/// the scale is the same for both, so angles stay right. A box without extent (all points at one
/// place) keeps a scale of 1, because the division would give infinity.
PictureFrame frame_of(const openvdb::Vec2d& low, const openvdb::Vec2d& high, int longer_pixels);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "write/image.h"

#include <openvdb/Types.h>

#include <array>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// Seen along z: x to the right, y up, z towards the viewer.
struct ShadedTriangle {
    std::array<openvdb::Vec3d, 3> corner;
    /// How far the corners lie on the viewer's side of the cutting plane; what lies there is left
    /// out.
    std::array<double, 3> in_front{-1.0, -1.0, -1.0};
    openvdb::Vec3f colour{1.0f};
    std::uint8_t edges = 7; ///< bit k: the side from corner k to the next one is drawn
    bool lit = true;        ///< else it has its colour as it is, as a cut has
};

/// The window that is drawn, in the triangles' unit.
struct ShadedFrame {
    openvdb::Vec2d low{0.0}, high{0.0};
    int longer_pixels = 0; ///< of its longer side, with the margin
};

Image draw_shaded(const std::vector<ShadedTriangle>& triangles, const ShadedFrame& frame);

} // namespace vdb_shell

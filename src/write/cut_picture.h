// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "write/plane_cut.h"

#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// What is drawn, in pixels, y downwards.
struct CutDrawing {
    std::vector<CutPolygon> tets;
    std::vector<CutSegment> outer, inner;
    int width = 0, height = 0;
};

/// Of a prism's tint, and of kCoreTint.
openvdb::Vec3f tint_colour(std::uint8_t tint);

/// 8-bit RGB, rows from the top.
std::vector<std::uint8_t> draw_cut(const CutDrawing& drawing);

} // namespace vdb_shell

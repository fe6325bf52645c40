// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/options/describe.h"
#include "vdb_shell/shell/tessellate.h"

#include <filesystem>

namespace vdb_shell
{
class OutputSet;

enum class Axis {
    x,
    y,
    z,
    widest, ///< the one of the three across which the plane cuts most of the solid
    view    ///< towards the viewer: of a picture in space alone
};
const NameTable<Axis>& names(Axis);

struct CrossSectionOptions {
    Axis axis = Axis::widest; ///< normal of the cutting plane
    double position = 0.5;    ///< share of the bounding box along the axis
    int width_pixels = 1024;  ///< of the longer side of the picture
};
OptionList describe(CrossSectionOptions& options);

/// Draws the shell cut by a plane, as a PNG: prisms in alternating tints, tet edges, the outer and
/// inner outlines, places that more than one tet covers in red. Throws WriteError; InvalidOption
/// for a width outside [16, 16384], a position outside [0, 1], and
/// Axis::view.
void write_cross_section(const std::filesystem::path& path, const PrismShell& shell,
                         const TetMesh& tets, const CrossSectionOptions& options = {},
                         OutputSet* with = nullptr);

} // namespace vdb_shell

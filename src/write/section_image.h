// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/cross_section.h"
#include "write/image.h"

namespace vdb_shell
{

/// The box that a plane's share is of, and the box that is drawn.
struct SectionFrame {
    /// Of the outer surface: the same share cuts the same place of the object whatever the shell
    /// below looks like.
    Bounds surface;
    Bounds all; ///< inverted prisms may stick out of the surface and are to be seen
};
/// Throws InvalidOption for a shell without vertices.
SectionFrame section_frame(const PrismShell& shell);
Bounds joined(const Bounds& a, const Bounds& b);

/// What write_cross_section draws. Precondition: the axis is x, y or z.
Image draw_cross_section(const PrismShell& shell, const TetMesh& tets,
                         const CrossSectionOptions& options, const SectionFrame& shown);

} // namespace vdb_shell

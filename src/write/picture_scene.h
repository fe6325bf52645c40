// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/write/picture.h"
#include "write/shaded_picture.h"

#include <vector>

namespace vdb_shell
{

/// What a picture in space is drawn from, in the view's axes.
struct PictureSubject {
    const ShellStack& stack;
    const TetMesh& tets; ///< those of a core with them
};
/// `surface`: the box that the plane's share is of. Precondition: not PictureKind::section.
std::vector<ShadedTriangle> picture_scene(const PictureSubject& subject,
                                          const PictureOptions& options, const Bounds& surface);

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/houdini/geometry.h"
#include "vdb_shell/write/input_points.h"

#include <cstddef>
#include <string>

namespace vdb_shell::houdini
{

/// Appends the vertices of the surface before remeshing as points of no primitive, in point group
/// `input_points`, with the attributes `input_corners` and `input_weights`, which all other points
/// get too. Precondition: there are some; they are consistent.
void append_input_points(const InputPoints& input, HoudiniGeometry& geometry);

/// Of the last `count` points. Throws ReadError for a corner that is none of the `vertices`.
InputPoints read_input_points(const HoudiniGeometry& geometry, std::size_t count,
                              std::size_t vertices, const std::string& name);

} // namespace vdb_shell::houdini

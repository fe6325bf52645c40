// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/resample/remesh.h"

#include <openvdb/Types.h>

#include <cstddef>
#include <string>
#include <vector>

namespace vdb_shell
{

/// The vertices of a surface before it was remeshed, each bound to a triangle of the shell's
/// surface: what moves the shell moves them by the same sum (docs/file_format.md, "The surface
/// before remeshing").
struct InputPoints {
    std::vector<openvdb::Vec3s> points;  ///< where they were
    std::vector<openvdb::Vec3I> corners; ///< vertices of the shell's surface
    std::vector<openvdb::Vec3s> weights; ///< of the corners, barycentric

    bool empty() const { return points.empty(); }
};

/// Weights are rounded to floats.
InputPoints input_points_of(const RemeshMap& map);

/// Throws InvalidOption unless the lists are equally long, corners below `vertices`, and all
/// numbers finite.
void require_consistent(const InputPoints& input, std::size_t vertices);

} // namespace vdb_shell

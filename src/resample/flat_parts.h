// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "resample/neighbours_across.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace vdb_shell
{

constexpr std::uint32_t kInNoPart = std::numeric_limits<std::uint32_t>::max();

/// Triangles that lie in one plane, or nearly.
struct FlatPart {
    std::vector<std::uint32_t> triangles; ///< two or more
    /// Seen along this axis its triangles turn the same way, exactly: 1 if they do so as the other
    /// two axes do, else -1. Some that are hardly thicker than a line need not.
    int axis = 0, turn = 1;
    /// Of two surfaces of its corners that have its boundary and of which one turns that way
    /// everywhere, no point is farther from the other one.
    double thickness = 0;
};

struct FlatParts {
    std::vector<FlatPart> parts;
    std::vector<std::uint32_t> part_of; ///< by triangle, or kInNoPart
};

/// The parts of the surface that are no thicker than that, the one around the largest triangle
/// first. A triangle is in one of them at most. Precondition: `across` is that of the mesh.
FlatParts flat_parts(const TriangleMesh& mesh, const std::vector<NeighboursAcross>& across,
                     double thickness);

/// Whether the three corners turn that way, seen along that axis. Exact.
bool turns(const TriangleMesh& mesh, const openvdb::Vec3I& corners, const FlatPart& part);

} // namespace vdb_shell

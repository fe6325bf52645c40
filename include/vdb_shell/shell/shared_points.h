// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/mesh/triangle_mesh.h"
#include "vdb_shell/shell/shell_stack.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vdb_shell
{

/// A *place* is a vertex on a surface of a stack: surface * vertices + vertex. Several places may
/// share one point. Gives for each place the first one that shares its point, itself if it is that.
///
/// Untapered: the two ends of a pinned pillar share a point, and no others. Tapered: all places
/// that are equal as numbers do, so the two ends of a pinned pillar again (-0 is 0 here, as it is
/// to PrismShell::pinned).
/// Precondition: as many places as 32 bits can number.
std::vector<std::uint32_t> first_places(const ShellStack& stack);
/// The same of `count` layers that lie on each other as in a stack.
std::vector<std::uint32_t> first_places(const PrismShell* layers, std::size_t count, bool tapered);

/// The innermost surface. Of a tapered stack: a point for each that it has, triangles of three
/// different points, and none of those that lie on each other and face each other. It is empty
/// where the shell fills the solid.
TriangleMesh inner_surface(const ShellStack& stack);

} // namespace vdb_shell

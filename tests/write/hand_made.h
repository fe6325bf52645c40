// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/write/vdb_file.h"

#include <set>

namespace vdb_shell::test
{

/// A shell put together without the stages that make shells.
struct HandMade {
    PrismShell shell;
    PrismSplit split;
    TetMesh tets;
};

/// The inner surface is the outer one scaled about the centre of its box by `scale`; pinned
/// vertices stay. Split by vertex index.
HandMade hand_made_shell(const TriangleMesh& surface, double scale,
                         const std::set<std::uint32_t>& pinned = {});

/// All of a .vdb for it: a small level set of a sphere, the true depth grid, texts.
ShellFile hand_made_file(const HandMade& made, double voxel_size);

/// Same bytes, element for element.
template <typename T> bool same_bits(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() && std::equal(reinterpret_cast<const char*>(a.data()),
                                              reinterpret_cast<const char*>(a.data() + a.size()),
                                              reinterpret_cast<const char*>(b.data()));
}

/// Same topology, active states and bits of every value.
bool same_grid(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b);

} // namespace vdb_shell::test

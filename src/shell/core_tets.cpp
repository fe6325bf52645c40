// SPDX-License-Identifier: Apache-2.0

// Takes: the tets of a shell and those that fill it. Gives: one mesh. Nothing is compared: the
// core's corners name points of the shell by index, so the two hang together as they stand.

#include "vdb_shell/shell/core_tets.h"

#include "vdb_shell/shell/shell_stack.h"

#include <cassert>

namespace vdb_shell
{

static_assert(kCoreLayer > ShellStack::kMostLayers, "no surface of a stack has the core's number");

TetMesh joined_tets(const TetMesh& shell, const CoreTets& core)
{
    assert(core.source_vertex.size() == core.points.size());
    TetMesh all = shell;
    for (std::size_t i = 0; i < core.points.size(); ++i) {
        all.points.push_back(core.points[i]);
        all.source_vertex.push_back(core.source_vertex[i]);
        all.layer.push_back(core.source_vertex[i] == CoreTets::kNoVertex ? kCoreLayer : 0);
    }
    for (const openvdb::Vec4I& tet : core.tets) {
        all.tets.push_back(tet);
        all.prism.push_back(kCorePrism);
        all.prism_layer.push_back(kCoreLayer);
    }
    return all;
}

bool has_core(const TetMesh& tets)
{
    // They come last.
    return !tets.prism_layer.empty() && tets.prism_layer.back() == kCoreLayer;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes a closed surface and leaves one of fewer triangles, for which nothing bounds the distance
// and which may cross itself. That is enough for growth, which takes such a surface only for a
// start: what it makes of the hint is tested exactly on the surface itself. Idea and sources:
// edge_collapse.cpp.

#include "vdb_shell/resample/coarsen.h"

#include "resample/edge_collapse.h"

namespace vdb_shell
{

Coarsened coarsen(const TriangleMesh& mesh, std::size_t triangles)
{
    CollapseLimits limits;
    limits.fewest_triangles = triangles;
    return collapse_edges(mesh, limits);
}

} // namespace vdb_shell

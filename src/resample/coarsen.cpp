// SPDX-License-Identifier: Apache-2.0
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

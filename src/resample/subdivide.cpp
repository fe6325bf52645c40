// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/subdivide.h"

#include "resample/edge_split.h"
#include "vdb_shell/core/error.h"

#include <cmath>
#include <string>
#include <utility>

namespace vdb_shell
{

TriangleMesh subdivide(const TriangleMesh& mesh, const SubdivideOptions& options)
{
    // Indices of tets and points are 32 bits wide, and a tet mesh has about three of them each.
    constexpr double kMostTriangles = 1U << 30U;
    const double count = static_cast<double>(mesh.triangles.size()) * std::pow(4.0, options.levels);
    if (options.levels < 0 || count >= kMostTriangles)
        throw InvalidOption("subdivide: levels is " + std::to_string(options.levels) + " for " +
                            std::to_string(mesh.triangles.size()) +
                            " triangles, must not be negative and give less than 2^30 triangles");
    TriangleMesh out = mesh;
    for (int level = 0; level < options.levels; ++level) {
        const EdgeList edges = edges_of(out.triangles);
        const std::vector<char> all(edges.ends.size(), 1);
        out = split_edges(out, edges, all, std::vector<std::uint8_t>(out.triangles.size())).mesh;
    }
    return out;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/resample/subdivide.h"

#include "resample/edge_split.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include <cmath>
#include <string>
#include <utility>

namespace vdb_shell
{

OptionList describe(SubdivideOptions& o)
{
    return in_group("Resampling", {option("levels", o.levels, "--subdivide",
                                          "Cut every triangle into four, this many times over")
                                       .in(Unit::count)
                                       .within(at_least(0))});
}

TriangleMesh subdivide(const TriangleMesh& mesh, const SubdivideOptions& options)
{
    require_in_range(options, "subdivide");
    // Indices of tets and points are 32 bits wide, and a tet mesh has about three of them each.
    constexpr double kMostTriangles = 1U << 30U;
    const double count = static_cast<double>(mesh.triangles.size()) * std::pow(4.0, options.levels);
    if (count >= kMostTriangles)
        throw InvalidOption("subdivide: levels is " + std::to_string(options.levels) + " for " +
                            std::to_string(mesh.triangles.size()) +
                            " triangles, must give less than 2^30 triangles");
    TriangleMesh out = mesh;
    for (int level = 0; level < options.levels; ++level) {
        const EdgeList edges = edges_of(out.triangles);
        const std::vector<char> all(edges.ends.size(), 1);
        out = split_edges(out, edges, all, std::vector<std::uint8_t>(out.triangles.size())).mesh;
    }
    return out;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes a surface and cuts each triangle into four at the middles of its edges, several times over.
// The shape stays, but for the rounding of the middles to float32 (edge_split.cpp), which on
// triangles of a few units in the last place can make the surface touch itself: the result has to
// be checked again.

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
    // A shell has three tets for a triangle, and their indices are 32 bits wide: 3 * 2^30 is under
    // 2^32.
    constexpr double kMostTriangles = 1U << 30U;
    // In double, because four to the number of levels overflows any integer for a careless option.
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

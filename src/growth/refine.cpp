// SPDX-License-Identifier: Apache-2.0

// Takes: a finished shell, with the reasons that ended its pillars. Gives: the triangles whose
// cutting is predicted to win most, by the measure that the user chose. A prediction decides only
// where triangles are spent; the shell that is grown afterwards is tested as any other. The cutting
// itself is resample/refine_triangles.h. Same result for any number of threads: sums over triangles
// are serial.

#include "vdb_shell/growth/refine.h"

#include "core/parallel.h"
#include "growth/void_volumes.h"
#include "mesh/topology.h"
#include "mesh/triangle_area.h"

#include <algorithm>
#include <numeric>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;

std::vector<double> areas_of(const PrismShell& shell)
{
    std::vector<double> areas(shell.triangles.size());
    for (std::size_t t = 0; t < areas.size(); ++t)
        areas[t] = triangle_area(shell.outer, shell.triangles[t]);
    return areas;
}

/// By how much each pillar is shorter than its neighbours' mean, where the shape holds it back.
std::vector<double> shortfalls(const PrismShell& shell)
{
    const VertexTriangles around = triangles_around_vertices(shell.outer.size(), shell.triangles);
    std::vector<double> missing(shell.outer.size());
    for_each_index(missing.size(), [&](std::size_t v) {
        // More vertices would not let it grow where it is the user who holds it.
        if (shell.stop[v] == StopReason::none || shell.stop[v] == StopReason::thickness)
            return;
        double sum = 0;
        std::size_t count = 0;
        for (const std::uint32_t t : around.around(v))
            for (int k = 0; k < 3; ++k)
                if (shell.triangles[t][k] != v)
                    sum += shell.length(shell.triangles[t][k]), ++count;
        missing[v] = count ? std::max(0.0, sum / double(count) - shell.length(v)) : 0.0;
    });
    return missing;
}

std::vector<double> contact_gain(const PrismShell& shell)
{
    const std::vector<double> missing = shortfalls(shell);
    // About the volume that the prism would hold more if its pillars were as long as those beside
    // them.
    std::vector<double> gain = areas_of(shell);
    for (std::size_t t = 0; t < gain.size(); ++t) {
        const Vec3I& c = shell.triangles[t];
        gain[t] *= (missing[c[0]] + missing[c[1]] + missing[c[2]]) / 3;
    }
    return gain;
}

} // namespace

const char* name_of(RefineEnd end)
{
    switch (end) {
    case RefineEnd::target_fill:
        return "target_fill";
    case RefineEnd::max_tets:
        return "max_tets";
    case RefineEnd::small_gain:
        return "small_gain";
    case RefineEnd::nothing:
        return "nothing";
    case RefineEnd::rounds:
        break;
    }
    return "rounds";
}

std::vector<double> refinement_gain(const PrismShell& shell, RefineBy by)
{
    switch (by) {
    case RefineBy::voids:
        return void_volumes(shell);
    case RefineBy::area:
        return areas_of(shell);
    case RefineBy::contacts:
        break;
    }
    return contact_gain(shell);
}

std::vector<std::uint32_t> triangles_to_cut(const std::vector<double>& gain, double share)
{
    std::vector<std::uint32_t> order(gain.size());
    std::iota(order.begin(), order.end(), 0U);
    // Ties by index, so that the result does not depend on the sort.
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return gain[a] > gain[b]; });
    const double wanted = share * std::accumulate(gain.begin(), gain.end(), 0.0);
    // The fewest triangles that have the wanted share: those of the largest gain first.
    double sum = 0;
    std::size_t count = 0;
    while (count < order.size() && gain[order[count]] > 0 && sum < wanted)
        sum += gain[order[count++]];
    order.resize(count);
    return order;
}

double RefineReport::gain_per_tet(std::size_t round) const
{
    // A round may make fewer tets than the one before, where triangles were left out for rounding.
    if (round == 0 || rounds[round].tets <= rounds[round - 1].tets)
        return 0;
    return (rounds[round].fill - rounds[round - 1].fill) /
           double(rounds[round].tets - rounds[round - 1].tets);
}

} // namespace vdb_shell

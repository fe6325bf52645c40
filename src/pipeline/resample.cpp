// SPDX-License-Identifier: Apache-2.0

// Takes: the surface of a result, before or after its shell was built. Leaves: the surface
// retriangulated, decimated, remeshed and subdivided as the options say, or refined in rounds
// together with its shell. A round cuts the triangles whose cutting is predicted to gain most, and
// growth goes on from the shell there is. The best round is kept and not the last, as a round may
// lose fill. The report's check is made anew for the surface that results, because coordinates have
// been rounded.

#include "pipeline/resample.h"

#include "vdb_shell/core/error.h"

#include "pipeline/sides.h"

#include <limits>
#include <utility>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;

/// Triangles that the bound on tets leaves room for, if no pillar were pinned: three tets a prism,
/// in each layer on each side.
std::size_t most_triangles(const ShellOptions& options)
{
    if (!options.refine.max_tets)
        return std::numeric_limits<std::size_t>::max();
    const std::size_t sides = options.side == Side::both ? 2 : 1;
    const std::size_t layers = sides * static_cast<std::size_t>(most_layers(options.layers));
    return *options.refine.max_tets / (3 * layers);
}

/// The layer under the surface: the one whose voids refinement can fill.
const PrismShell& inward_layer(const ShellResult& result)
{
    return result.stack.layers.back();
}

RefineRound figures_of(const ShellResult& result, const ShellOptions& options)
{
    RefineRound round;
    round.triangles = result.surface.triangles.size();
    // Layers are cut later, each into as many tets.
    round.tets =
        make_tets(result.stack).tets.size() * static_cast<std::size_t>(most_layers(options.layers));
    // Of the layer inside alone: layers outside do not fill the solid.
    const double shell = tet_volume(make_tets(inward_layer(result), result.stack.splits.back()));
    round.fill = shell / signed_volume(result.surface.points, result.surface.triangles);
    return round;
}

/// Why no further round is made; nothing when one is.
std::optional<RefineEnd> end_of(const RefineReport& report, const RefineOptions& options)
{
    const std::vector<RefineRound>& rounds = report.rounds;
    const std::size_t made = rounds.size() - 1;
    if (options.target_fill && rounds[made].fill >= *options.target_fill)
        return RefineEnd::target_fill;
    if (made > 0 && options.min_gain > 0 &&
        rounds[made].fill - rounds[made - 1].fill < options.min_gain)
        return RefineEnd::small_gain;
    if (made >= static_cast<std::size_t>(options.rounds))
        return RefineEnd::rounds;
    return std::nullopt;
}

/// The old pillars, and between them those in the middles of the halved edges. Their inner ends are
/// the middles of the old inner edges, rounded; growth mends what is not valid in that before it
/// goes on.
GrowStart start_on(const RefinedMesh& refined, const PrismShell& shell)
{
    GrowStart start{GrowFrom::shell, shell.inner, {}};
    for (const auto& [a, b] : refined.halved)
        start.inner.emplace_back(0.5 * (Vec3d(shell.inner[a]) + Vec3d(shell.inner[b])));
    return start;
}

/// Cuts triangles of the surface; false when none could be cut, and the report says why.
bool cut_triangles(ShellResult& result, const ShellOptions& options, RefineReport& report,
                   GrowStart& start, Interrupter* interrupter)
{
    std::vector<double> gain = refinement_gain(inward_layer(result), options.refine.by);
    // Cores are no part of the surface, and gain nothing.
    for (std::size_t t = 0; t < gain.size(); ++t)
        if (result.core_vertices.holds(result.surface.triangles[t][0]))
            gain[t] = 0;
    RefinedMesh refined =
        refine_triangles(result.surface, triangles_to_cut(gain, options.refine.share),
                         most_triangles(options), interrupter);
    report.rounds.back().cut = refined.cut;
    report.rounds.back().barred_edges = refined.barred_edges;
    if (refined.halved.empty()) {
        report.end = refined.out_of_room ? RefineEnd::max_tets : RefineEnd::nothing;
        return false;
    }
    start = start_on(refined, inward_layer(result));
    result.surface = std::move(refined.mesh);
    return true;
}

RefineReport refine(ShellResult& result, const ShellOptions& options,
                    const openvdb::FloatGrid* thickness_grid, Interrupter* interrupter)
{
    // A raw shell's fill counts overlaps twice, so a higher one need not be better. Its last round
    // is kept.
    const bool fill_tells = options.grow.method != Method::raw;
    RefineReport report;
    report.rounds.push_back(figures_of(result, options));
    // A copy of all but the level set, which is shared: no round changes it, as lines outward
    // restore it after use. The report is copied as well, so that its figures are those of the
    // round that is kept.
    ShellResult best = result;
    while (true) {
        if (const std::optional<RefineEnd> end = end_of(report, options.refine)) {
            report.end = *end;
            break;
        }
        GrowStart start;
        if (!cut_triangles(result, options, report, start, interrupter))
            break;
        // The stages of a round have a clock of their own, whose costs are dropped: in the report
        // they are one stage, "refine", and would be counted twice otherwise.
        std::vector<StageCost> costs;
        StageClock clock(costs, interrupter);
        build_sides(result, options, thickness_grid, clock, interrupter, start);
        report.rounds.push_back(figures_of(result, options));
        // The next round goes on from this one all the same: its triangles are finer, and a later
        // round may gain from that.
        if (fill_tells && report.rounds.back().fill <= report.rounds[report.kept].fill)
            continue;
        report.kept = report.rounds.size() - 1;
        best = result;
    }
    result = std::move(best);
    return report;
}

/// Contacts that the surface has beforehand would remain whatever a stage does, which tests its own
/// result for contacts.
void require_embedded(const ShellResult& result, const std::string& stage)
{
    if (!result.report.mesh.embedded())
        throw GeometryError(result.report.source + ": " + stage +
                            " needs a surface that does not cross itself; " +
                            std::to_string(result.report.mesh.self_intersections.count) +
                            " pairs of triangles cross or touch");
}

void retriangulate_surface(ShellResult& result, const ShellOptions& options,
                           Interrupter* interrupter)
{
    require_embedded(result, "retriangulation");
    RetriangulateResult turned = retriangulate(result.surface, options.retriangulate, interrupter);
    result.report.retriangulate = turned.report;
    if (turned.report.flips == 0)
        return; // the surface is what it was
    result.surface = std::move(turned.mesh);
    result.report.mesh = check_mesh(result.surface, interrupter);
}

void decimate_surface(ShellResult& result, const ShellOptions& options, Interrupter* interrupter)
{
    require_embedded(result, "decimation");
    DecimateResult decimated = decimate(result.surface, options.decimate, interrupter);
    result.surface = std::move(decimated.mesh);
    result.report.decimate = decimated.report;
    result.report.mesh = check_mesh(result.surface, interrupter);
}

void remesh_surface(ShellResult& result, const ShellOptions& options, Interrupter* interrupter)
{
    require_embedded(result, "remeshing");
    RemeshResult remeshed = remesh(result.surface, options.remesh, interrupter);
    remeshed.map.input_points = std::move(result.surface.points);
    result.surface = std::move(remeshed.mesh);
    result.remesh_map = std::move(remeshed.map);
    result.report.remesh = remeshed.report;
    result.report.mesh = check_mesh(result.surface, interrupter);
}

} // namespace

void resample_surface(ShellResult& result, const ShellOptions& options, StageClock& clock,
                      Interrupter* interrupter)
{
    if (options.retriangulate.wanted)
        clock.run("retriangulate", [&] { retriangulate_surface(result, options, interrupter); });
    if (options.decimate.triangles)
        clock.run("decimate", [&] { decimate_surface(result, options, interrupter); });
    if (options.remesh.wanted())
        clock.run("remesh", [&] { remesh_surface(result, options, interrupter); });
    if (options.subdivide.levels == 0)
        return;
    clock.run("subdivide", [&] {
        result.report.subdivided_from = result.surface.triangles.size();
        result.surface = subdivide(result.surface, options.subdivide);
        result.report.mesh = check_mesh(result.surface, interrupter);
        require_usable(result.report.mesh, options.check,
                       result.report.source + " after --subdivide");
    });
}

void build_and_refine(ShellResult& result, const ShellOptions& options, const GrowStart& start,
                      const openvdb::FloatGrid* thickness_grid, StageClock& clock,
                      Interrupter* interrupter)
{
    build_sides(result, options, thickness_grid, clock, interrupter, start);
    if (options.refine.rounds == 0)
        return;
    clock.run("refine", [&] {
        const RefineReport report = refine(result, options, thickness_grid, interrupter);
        result.report.refine = report;
        result.report.mesh = check_mesh(result.surface, interrupter);
    });
}

} // namespace vdb_shell

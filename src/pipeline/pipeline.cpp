// SPDX-License-Identifier: Apache-2.0

// Takes: a mesh or a level set, and the options of all stages. Gives: the shell with everything
// that was made on the way, and its report. Here alone do stages meet: each takes const references
// and returns a value, and this file says in which order and under which names they are timed
// (docs/architecture.md). The certificate comes after the last stage that moves a point, so it
// speaks of what is written. Options are validated before the first stage, so that no run fails
// late for a reason that was known at the start.

#include "vdb_shell/pipeline.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option_value.h"

#include "core/grid_instances.h"
#include "pipeline/core_stages.h"
#include "pipeline/figures.h"
#include "pipeline/prepare_surface.h"
#include "pipeline/resample.h"
#include "pipeline/sides.h"
#include "pipeline/taper_to_bounds.h"
#include "report/stage_clock.h"
#include "step/thickness.h"

#include <utility>
#include <vector>

namespace vdb_shell
{
namespace
{

void make_layers(ShellResult& r, const ShellOptions& options, Interrupter* interrupter)
{
    LayerResult cut = cut_layers(r.stack, options.layers, prism_test_of(options.grow), interrupter);
    r.stack = std::move(cut.stack);
    if (options.layers.layers != 1)
        r.report.cut = cut.report;
}

/// Tapers when asked; makes the tets and certifies them. The tests of single changes are exact, but
/// no proof for every degenerate case, so what is not certified is undone: the user gets a
/// certified shell all the same.
void taper_and_certify(ShellResult& r, const ShellOptions& options,
                       const openvdb::FloatGrid* thickness_grid, StageClock& clock,
                       Interrupter* interrupter)
{
    const auto certify = [&] {
        clock.run("tets", [&] { r.tets = make_tets(r.stack); });
        clock.run("certificate", [&] {
            r.report.certificate = certify_stack(r.stack, prism_test_of(options.grow), interrupter);
        });
    };
    if (!options.taper.wanted) {
        certify();
        return;
    }
    ShellStack untapered = r.stack;
    clock.run("taper", [&] {
        taper_to_bounds(r, options, largest_lengths(r.surface, options.line_step, thickness_grid),
                        interrupter);
    });
    certify();
    if (r.report.certificate->certified() && !shares_core_point(r.stack, r.core_vertices))
        return;
    r.stack = std::move(untapered);
    r.report.taper->undone = true;
    certify();
}

/// Fills what the shell leaves empty, when asked. Only a certified shell has a void of which
/// anything is known.
void fill_when_asked(ShellResult& r, const ShellOptions& options, StageClock& clock,
                     Interrupter* interrupter)
{
    if (!options.core_fill.wanted())
        return;
    if (!r.report.certificate->certified())
        throw GeometryError(r.report.source + ": its shell is not certified, so that --core-fill " +
                            name_in_table(options.core_fill.program) +
                            " has nothing sound to fill");
    clock.run("core fill", [&] {
        // Cores are holes of what is filled.
        CoreFill made = fill_core(r.stack, r.tets, options.core_fill, interrupter, holes_of(r));
        r.core = std::move(made.core);
        r.report.core_fill = std::move(made.report);
    });
}

/// Makes the level set that the lines step through; a given one is taken where it is fit for that.
/// In every other case the report says why not, for the lengths then come from another field than
/// the user's own.
void make_field(ShellResult& r, const ShellOptions& options, const GrowStart& start,
                const openvdb::FloatGrid* given, const openvdb::FloatGrid* thickness_grid,
                Interrupter* interrupter)
{
    const LevelSetOptions band = band_for(options, r.surface, thickness_grid);
    std::string& origin = r.report.field.origin;
    const std::string dense_for = why_not_sparse(options, r, start, thickness_grid);
    origin = dense_for.empty() ? "a narrow band made of the surface, deeper where lines end"
                               : "made of the surface, dense for " + dense_for;
    if (given && r.cores) {
        origin += ", for the given one has no cores";
    } else if (given) {
        // A given band outside is as wide as its maker needed, which need not be as deep as lines
        // outward go, and beyond it no distance is known.
        const std::string hindrance = options.side == Side::inward
                                          ? why_not_steppable(*given, r.surface, band)
                                          : "nothing is known outside its band";
        if (hindrance.empty()) {
            origin = "as given";
            // A copy, because smoothing changes the level set in place and the given one is the
            // caller's.
            r.level_set = given->deepCopy();
            return;
        }
        origin += ", for of the given one " + hindrance;
    }
    r.report.field.sparse = dense_for.empty();
    r.level_set = dense_for.empty() ? mesh_to_narrow_band(r.surface, band, interrupter)
                                    : mesh_to_level_set(r.surface, band, interrupter);
}

/// Growth sets out from the surface where lines have no length, the paper's method has only these.
void require_inside(const ShellResult& r)
{
    if (!has_inside(*r.level_set))
        throw GeometryError(r.report.source + ": no voxel centre lies inside, voxel size " +
                            text_of(r.level_set->voxelSize()[0]) +
                            ", so that --method raw has nothing to step through; a smaller "
                            "--voxel-size or a larger --resolution");
}

/// All stages from the check on. `given` may be null.
void build_from_surface(ShellResult& r, const TriangleMesh& mesh, const ShellOptions& options,
                        const openvdb::FloatGrid* given, const openvdb::FloatGrid* thickness_grid,
                        const std::vector<CoreMesh>& cores, Interrupter* interrupter)
{
    StageClock clock(r.report.stages, interrupter);
    prepare_surface(r, mesh, options, clock, interrupter);
    resample_surface(r, options, clock, interrupter);
    require_enough_tets(r.surface, options.wanted);
    join_with_cores(r, cores, options, clock, interrupter);
    GrowStart start;
    clock.run("coarsen", [&] { start = start_of_growth(options, r.surface, interrupter); });
    clock.run("level set",
              [&] { make_field(r, options, start, given, thickness_grid, interrupter); });
    if (options.grow.method == Method::raw)
        require_inside(r);
    clock.run("smooth", [&] {
        r.report.field.smooth =
            smooth_level_set(*r.level_set, r.surface, options.smooth, interrupter);
    });
    build_and_refine(r, options, start, thickness_grid, clock, interrupter);
    clock.run("layers", [&] { make_layers(r, options, interrupter); });
    taper_and_certify(r, options, thickness_grid, clock, interrupter);
    part_from_cores(r, options, clock);
    fill_when_asked(r, options, clock, interrupter);
    // What is certified as a whole has no overlaps, so the search would only cost time. It serves
    // surfaces that cross themselves, and the raw method.
    if (!r.report.certificate->certified())
        clock.run("overlaps", [&] { r.report.overlaps = find_overlaps(r.tets, interrupter); });
    clock.run("figures", [&] {
        measure_result(r, interrupter);
        judge_result(r, options, largest_lengths(r.surface, options.line_step, thickness_grid));
    });
    clock.run("coverage", [&] {
        // Layers outside are held against what the outermost surface encloses, since the input's
        // own volume holds none of them.
        const TriangleMesh solid = options.side == Side::inward
                                       ? solid_to_fill(r)
                                       : TriangleMesh{r.stack.surface(0), r.stack.triangles()};
        r.report.coverage = estimate_coverage(solid, r.tets, options.coverage, interrupter);
    });
}

} // namespace

ShellResult build_shell(const TriangleMesh& mesh, const ShellOptions& options,
                        const std::string& name, const openvdb::FloatGrid* thickness_grid,
                        Interrupter* interrupter, const std::vector<CoreMesh>& cores)
{
    require_sensible(options, thickness_grid != nullptr);
    if (!cores.empty())
        require_cores_possible(options);
    require_program(options.core_fill);
    ShellResult r;
    r.report.source = name;
    build_from_surface(r, mesh, options, nullptr, thickness_grid, cores, interrupter);
    return r;
}

ShellResult build_shell_from_level_set(const openvdb::FloatGrid& field, const ShellOptions& options,
                                       const std::string& name,
                                       const openvdb::FloatGrid* thickness_grid,
                                       Interrupter* interrupter, const std::vector<CoreMesh>& cores)
{
    require_sensible(options, thickness_grid != nullptr);
    if (!cores.empty())
        require_cores_possible(options);
    require_program(options.core_fill);
    if (options.wrap.wanted)
        throw InvalidOption(name + ": a wrap is for triangles; the surface of a level set is "
                                   "closed, manifold and embedded as it is");
    require_level_set(field, name);
    ShellResult r;
    r.report.source = name;
    TriangleMesh surface;
    StageClock(r.report.stages, interrupter).run("contour", [&] {
        r.report.contour.emplace();
        surface = contour(field, options.contour, &*r.report.contour, interrupter);
    });
    build_from_surface(r, surface, options, &field, thickness_grid, cores, interrupter);
    return r;
}

} // namespace vdb_shell

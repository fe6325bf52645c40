// SPDX-License-Identifier: Apache-2.0

// Takes an embedded surface and a bound on the distance, and keeps the bound. The collapses hold it
// at sampled points only, so the distance is measured on the result, both ways, and where it is too
// large all is done anew from the input with a stricter bound. The last resort is the input itself,
// at distance zero. The trap is that the measure is sampled as well: it can be too small by a share
// of the spacing (surface_distance.cpp).

#include "vdb_shell/resample/decimate.h"

#include "core/stage_progress.h"
#include "resample/attempts.h"
#include "resample/simplify.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace vdb_shell
{
namespace
{

constexpr int kMostAttempts = 12;

void measure(DecimateReport& report, const TriangleMesh& input, const TriangleMesh& result,
             double spacing, Interrupter* interrupter)
{
    report.triangles = result.triangles.size();
    report.input_to_result = surface_distance(input, result, spacing, interrupter);
    report.result_to_input = surface_distance(result, input, spacing, interrupter);
}

} // namespace

OptionList describe(DecimateOptions& o)
{
    return in_group("Resampling",
                    {option("triangles", o.triangles, "--decimate-to",
                            "Collapse edges down to this many triangles first")
                         .in(Unit::count)
                         .within(at_least(kFewestTriangles)),
                     option("tolerance", o.tolerance, "--decimate-tolerance",
                            "Farthest that decimation may part the surfaces, world units")
                         .in(Unit::world_length)
                         .within(above(0))
                         .needing("--decimate-to")});
}

void require_sensible(const DecimateOptions& options)
{
    require_in_range(options, "decimate");
}

DecimateResult decimate(const TriangleMesh& mesh, const DecimateOptions& options,
                        Interrupter* interrupter)
{
    require_sensible(options);
    assert(options.triangles);
    const StageProgress progress(interrupter, "decimate");
    const double diagonal = diagonal_of(bounds_of(mesh.points));
    const double tolerance = options.tolerance.value_or(diagonal);
    const double spacing =
        std::max(diagonal / kSamplesAlongDiagonal, std::min(tolerance / 4, diagonal));
    DecimateResult out;
    DecimateReport& report = out.report;
    report.before = mesh.triangles.size();
    report.wanted = *options.triangles;
    const bool bounded = options.tolerance.has_value();
    // Without a tolerance the collapses keep no samples at all, which saves their time and memory.
    double tried = bounded ? tolerance : std::numeric_limits<double>::infinity();
    for (int attempt = 0; attempt < kMostAttempts; ++attempt, tried *= kStricter) {
        Simplified left = simplify(
            mesh,
            {tried, std::numeric_limits<double>::infinity(), *options.triangles, false, bounded},
            interrupter);
        measure(report, mesh, left.mesh, spacing, interrupter);
        report.repeats += left.repeats;
        if (!bounded ||
            std::max(report.input_to_result.max, report.result_to_input.max) <= tolerance) {
            out.mesh = std::move(left.mesh);
            return out;
        }
        ++report.repeats;
    }
    out.mesh = mesh;
    measure(report, mesh, out.mesh, spacing, interrupter);
    return out;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0

// Takes: the surface and the cores, or what was built of both together. Leaves: both together, or
// the shell of the surface alone, with what there is to tell of the cores. All stages in between
// see one surface, some of whose vertices are pinned (docs/theory.md, "Cores").

#include "pipeline/core_stages.h"

#include "obstacles/offset_surface.h"

#include <utility>

namespace vdb_shell
{

void join_with_cores(ShellResult& result, const std::vector<CoreMesh>& cores,
                     const ShellOptions& options, StageClock& clock, Interrupter* interrupter)
{
    if (cores.empty())
        return;
    clock.run("cores", [&] {
        result.cores =
            prepare_cores(result.surface, result.report.source, cores, options.cores, interrupter);
        const TriangleMesh& kept_out = result.cores->kept_out;
        result.core_vertices = {std::uint32_t(result.surface.points.size()),
                                std::uint32_t(kept_out.points.size())};
        result.surface = join_cores(std::move(result.surface), kept_out);
    });
}

void part_from_cores(ShellResult& result, const ShellOptions& options, StageClock& clock)
{
    if (!result.cores)
        return;
    clock.run("feet on cores", [&] {
        const VertexRange range = std::exchange(result.core_vertices, {});
        const std::size_t triangles = result.surface.triangles.size();
        result.surface = drop_cores(std::move(result.surface), range);
        result.stack = drop_cores(std::move(result.stack), range);
        drop_cores(result.directions.inward, range);
        drop_cores(result.directions.visibility, range);
        drop_cores(result.lengths.length, range);
        drop_cores(result.lengths.reason, range);
        drop_cores(result.lengths.steps, range);
        // Prisms of cores have no tets, so these are the same, with other numbers.
        result.tets = make_tets(result.stack);
        if (result.report.refine)
            result.report.mesh = check_mesh(result.surface);
        if (result.report.taper)
            result.report.taper->prisms_by_tets[0] -=
                result.stack.layers.size() * (triangles - result.surface.triangles.size());
        result.core_feet = find_core_feet(result.stack, *result.cores, options.cores);
        mark_core_stops(result.stack, result.core_feet);
        result.report.cores =
            report_cores(result.stack, *result.cores, options.cores, result.core_feet);
    });
}

TriangleMesh holes_of(const ShellResult& result)
{
    return result.cores ? without_unused_points(joined_cores(result.cores->given)) : TriangleMesh{};
}

TriangleMesh solid_to_fill(const ShellResult& result)
{
    return result.cores ? join_cores(result.surface, joined_cores(result.cores->given))
                        : result.surface;
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
// Mean-curvature flow of a level set, after the paper's section 2 ("regularize by a curvature
// flow"), and the distances made anew afterwards. The flow runs on a narrow band, and the depth
// that the inside had before is built again from the new zero crossing; values of before and after
// are never mixed. The steps are small: a sphere of radius R has the radius sqrt(R^2 - 2 n dx^2 /
// 3) after n of them, with voxels of size dx. The report says how far the surface moved.

#include "vdb_shell/field/smooth.h"

#include "core/latched_interrupter.h"
#include "core/parallel.h"
#include "core/stage_progress.h"
#include "field/field_sampler.h"
#include "vdb_shell/core/error.h"
#include "vdb_shell/options/option.h"
#include "vdb_shell/options/option_value.h"

#include <openvdb/tools/LevelSetFilter.h>
#include <openvdb/tools/LevelSetRebuild.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace vdb_shell
{

namespace
{

using Filter = openvdb::tools::LevelSetFilter<openvdb::FloatGrid, openvdb::FloatGrid, Interrupter>;

float deepest_value(const openvdb::FloatGrid& grid)
{
    float deepest = 0;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf)
        for (auto value = leaf->cbeginValueOn(); value; ++value)
            deepest = std::min(deepest, *value);
    return deepest;
}

void flow(openvdb::FloatGrid& level_set, int iterations, LatchedInterrupter& latched)
{
    Filter filter(level_set, &latched);
    // The flow moves every level set by its own curvature, the deep ones the most, and the tracker
    // carries distances inward by only a few voxels a step. So deep values would be wrong after it
    // in any case, and it runs on the narrow band alone.
    filter.prune();
    for (int i = 0; i < iterations; ++i) {
        filter.meanCurvature();
        if (latched.wasInterrupted(80 * (i + 1) / iterations))
            throw Cancelled();
    }
}

SmoothReport drift_of(const TriangleMesh& mesh, const openvdb::FloatGrid& level_set)
{
    std::vector<double> drift(mesh.points.size());
    for_each_range(drift.size(), [&](std::size_t begin, std::size_t end) {
        FieldSampler field(level_set);
        for (std::size_t v = begin; v < end; ++v)
            drift[v] = std::abs(field.at(openvdb::Vec3d(mesh.points[v])).phi);
    });
    SmoothReport report;
    // The sum is made after the parallel loop and in the order of the vertices, since the sum of
    // doubles depends on their order.
    for (const double d : drift) {
        report.mean_drift += d / static_cast<double>(drift.size());
        report.max_drift = std::max(report.max_drift, d);
    }
    return report;
}

} // namespace

OptionList describe(SmoothOptions& o)
{
    return in_group("Level set",
                    {option("iterations", o.iterations, "--smooth", "Steps of mean-curvature flow")
                         .in(Unit::count)
                         .within(at_least(0))});
}

SmoothReport smooth_level_set(openvdb::FloatGrid& level_set, const TriangleMesh& mesh,
                              const SmoothOptions& options, Interrupter* interrupter)
{
    const StageProgress progress(interrupter, "smooth");
    require_in_range(options, "smooth");
    const std::string iterations = std::to_string(options.iterations);
    if (!level_set.hasUniformVoxels() || level_set.getGridClass() != openvdb::GRID_LEVEL_SET)
        throw GeometryError("smooth: grid '" + level_set.getName() +
                            "' is not a level set with uniform voxels");
    if (options.iterations == 0)
        return drift_of(mesh, level_set);

    const double voxel = level_set.voxelSize()[0];
    // Measured before the flow, which cuts the inside down to a narrow band.
    const float deepest = deepest_value(level_set);
    if (deepest >= 0)
        throw GeometryError("smooth: no voxel centre lies inside the surface, voxel size " +
                            text_of(voxel) + "; a smaller --voxel-size or a larger --resolution");
    const auto exterior_voxels = static_cast<float>(level_set.background() / voxel);
    const auto interior_voxels = static_cast<float>(-deepest / voxel + 1);
    LatchedInterrupter latched(interrupter);
    flow(level_set, options.iterations, latched);
    // The flow shrinks closed surfaces, so with enough steps they vanish.
    if (deepest_value(level_set) >= 0)
        throw GeometryError("smooth: " + iterations +
                            " iterations of mean-curvature flow have eaten the whole surface");
    Interrupter* const tool = &latched;
    const auto rebuilt = openvdb::tools::levelSetRebuild(level_set, 0.0f, exterior_voxels,
                                                         interior_voxels, nullptr, tool);
    if (latched.stopped())
        throw Cancelled();
    level_set.setTree(rebuilt->treePtr());
    return drift_of(mesh, level_set);
}

} // namespace vdb_shell

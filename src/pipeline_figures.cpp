// SPDX-License-Identifier: Apache-2.0
#include "pipeline_figures.h"

#include <openvdb/tools/Count.h>

#include <algorithm>
#include <numeric>

namespace vdb_shell
{
namespace
{

void measure_field(FieldReport& report, const openvdb::FloatGrid& level_set)
{
    report.voxel_size = level_set.voxelSize()[0];
    report.active_voxels = level_set.activeVoxelCount();
    report.memory_bytes = level_set.memUsage();
    report.interior_depth = -double(openvdb::tools::minMax(level_set.tree()).min());
}

void measure_lines(LineReport& report, const ShellResult& result, double voxel_size)
{
    const std::vector<double>& visibility = result.directions.visibility;
    report.min_visibility = *std::min_element(visibility.begin(), visibility.end());
    report.blind_vertices = static_cast<std::size_t>(
        std::count_if(visibility.begin(), visibility.end(), [](double v) { return v <= 0.0; }));
    report.steps =
        std::accumulate(result.lengths.steps.begin(), result.lengths.steps.end(), std::size_t(0));
    for (const StopReason reason : result.shell.stop)
        ++report.stops[static_cast<std::size_t>(reason)];

    std::vector<double> lengths(result.shell.outer.size());
    for (std::size_t v = 0; v < lengths.size(); ++v)
        lengths[v] = result.shell.length(v);
    report.stuck_vertices =
        static_cast<std::size_t>(std::count(lengths.begin(), lengths.end(), 0.0));
    report.length = spread_of(lengths);
    for (double& length : lengths)
        length /= voxel_size;
    report.length_voxels = spread_of(std::move(lengths));
}

} // namespace

void measure_result(ShellResult& result)
{
    ShellReport& report = result.report;
    measure_field(report.field, *result.level_set);
    measure_lines(report.lines, result, report.field.voxel_size);
    report.prisms = result.shell.triangles.size();
    report.pinned_vertices = report.lines.stuck_vertices;
    report.ripples = result.split.ripples;
    report.signs = count_tet_signs(result.tets);
    report.conformity = check_conformity(result.shell, result.tets);
    report.quality = measure_quality(result.tets);
    report.solid_volume = signed_volume(result.surface.points, result.surface.triangles);
    report.shell_volume = tet_volume(result.tets);
    report.fill = report.shell_volume / report.solid_volume;
}

} // namespace vdb_shell

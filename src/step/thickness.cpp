// SPDX-License-Identifier: Apache-2.0
// The largest length of each vertex: the user's thickness, the value of a painted grid at the
// vertex, or the smaller of the two. Both are in world units. Later stages rely on each being a
// number and not negative; infinity stands for "no bound" and only ever comes from a thickness that
// was not given.

#include "step/thickness.h"

#include "core/parallel.h"
#include "core/text_stream.h"
#include "core/voxel_numbers.h"
#include "vdb_shell/core/error.h"

#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vdb_shell
{
namespace
{

std::vector<double> sample_thickness(const TriangleMesh& mesh, const openvdb::FloatGrid& grid)
{
    std::vector<double> sampled(mesh.points.size());
    for_each_range(sampled.size(), [&](std::size_t begin, std::size_t end) {
        const auto accessor = grid.getConstAccessor();
        for (std::size_t v = begin; v < end; ++v) {
            const auto index = grid.transform().worldToIndex(openvdb::Vec3d(mesh.points[v]));
            sampled[v] = has_voxel_numbers(index)
                             ? double(openvdb::tools::BoxSampler::sample(accessor, index))
                             : double(grid.background());
        }
    });
    // This is a loop of its own after the parallel one, so that the vertex in the message is always
    // the first faulty one.
    for (std::size_t v = 0; v < sampled.size(); ++v)
        if (!(std::isfinite(sampled[v]) && sampled[v] >= 0)) {
            OutText message;
            message << "thickness grid '" << grid.getName() << "': value " << sampled[v]
                    << " at vertex " << v << " " << mesh.points[v]
                    << ", must be finite and not negative";
            throw GeometryError(message.str());
        }
    return sampled;
}

} // namespace

std::vector<double> largest_lengths(const TriangleMesh& mesh, const LineStepOptions& options,
                                    const openvdb::FloatGrid* thickness_grid)
{
    const double thickness = options.thickness.value_or(std::numeric_limits<double>::infinity());
    if (!thickness_grid)
        return std::vector<double>(mesh.points.size(), thickness);
    std::vector<double> lengths = sample_thickness(mesh, *thickness_grid);
    for (double& length : lengths)
        length = std::min(length, thickness);
    return lengths;
}

} // namespace vdb_shell

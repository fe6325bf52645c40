// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/openvdb.h>
#include <openvdb/tools/GridTransformer.h>

#include <chrono>
#include <functional>

// What the probes of volumes measure with, and compare to.

namespace vdb_shell
{

inline double seconds(const std::function<void()>& work)
{
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// OpenVDB's own resampling, trilinear.
struct Resampling {
    double seconds = 1e30;
    std::size_t voxels = 1;

    double per_voxel() const { return seconds / double(voxels); }
    /// Keeps the least time of all calls: the machine does other things as well.
    void measure(const openvdb::FloatGrid& source)
    {
        const auto turned = openvdb::FloatGrid::create();
        // Turned a little, so that it has to interpolate.
        turned->setTransform(source.transform().copy());
        turned->transform().postRotate(0.1, openvdb::math::Z_AXIS);
        const double time = vdb_shell::seconds(
            [&] { openvdb::tools::resampleToMatch<openvdb::tools::BoxSampler>(source, *turned); });
        seconds = time < seconds ? time : seconds;
        voxels = turned->activeVoxelCount();
    }
};

} // namespace vdb_shell

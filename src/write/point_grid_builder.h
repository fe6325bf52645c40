// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/point_grid_instances.h"

#include <cstdint>
#include <string>
#include <vector>

namespace vdb_shell
{

/// A grid of points under construction. Columns are plain vectors with an entry for each point, in
/// the order of `positions`, so that what OpenVDB needs to store them is compiled once for each
/// type and not once for each attribute. Precondition: openvdb::initialize().
class PointGridBuilder
{
public:
    /// The voxel is chosen for points on surfaces about as large as their box.
    PointGridBuilder(const char* name, const std::vector<openvdb::Vec3s>& positions);

    void add(const std::string& name, const std::vector<std::int32_t>& column);
    void add(const std::string& name, const std::vector<float>& column);
    void add(const std::string& name, const std::vector<openvdb::Vec3s>& column);
    /// `stride` entries for each point. Each element stands under its own name as well, `name`0 and
    /// so on: VEX has no integer tuples.
    void add_tuples(const std::string& name, openvdb::Index stride,
                    const std::vector<std::int32_t>& column);
    /// 0 or 1 for each point; shorts, because that is the type which OpenVDB's setGroup takes.
    void add_group(const std::string& name, const std::vector<short>& member);

    openvdb::points::PointDataGrid::Ptr take() const { return grid_; }

private:
    openvdb::tools::PointIndexGrid::Ptr index_; ///< the order in which voxels took the points
    openvdb::points::PointDataGrid::Ptr grid_;
};

} // namespace vdb_shell

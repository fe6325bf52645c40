// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"
#include "core/point_grid_instances.h"

#include <openvdb/io/Compression.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

// OpenVDB's templates that tests make grids with, compiled once: each takes half a minute. The same
// goes for Grid<>::create() of any type but float, so other grids come from OpenVDB's registry.

namespace vdb_shell::test
{

/// A level set of a sphere about the origin, with a band of three voxels.
openvdb::FloatGrid::Ptr sphere_level_set(float radius, float voxel_size);

/// An empty grid of those values, named as OpenVDB's trees name them: "vec3s", "int32", "mask".
openvdb::GridBase::Ptr empty_grid(const std::string& value_type, const std::string& name);

/// Writes a .vdb anew through OpenVDB with something changed. `compression` are OpenVDB's flags.
void rewrite_vdb(const std::filesystem::path& path,
                 const std::function<void(openvdb::GridPtrVec&, openvdb::MetaMap&)>& change,
                 std::uint32_t compression = openvdb::io::COMPRESS_ZIP);

/// A grid of points with exact positions, in voxels of that size.
openvdb::points::PointDataGrid::Ptr point_grid(const std::vector<openvdb::Vec3s>& positions,
                                               double voxel_size);

/// T is one of std::uint8_t, std::int32_t, std::int64_t, float, Vec3s, Vec3i.
template <typename T>
void append_attribute(openvdb::points::PointDataTree& tree, const std::string& name, const T& value,
                      openvdb::Index stride = 1);

void append_group(openvdb::points::PointDataTree& tree, const std::string& name);
void rename_attribute(openvdb::points::PointDataTree& tree, const std::string& from,
                      const std::string& to);
void drop_attribute(openvdb::points::PointDataTree& tree, const std::string& name);

} // namespace vdb_shell::test

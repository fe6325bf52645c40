// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/point_grid_instances.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace vdb_shell
{

/// A column's values for some points at a time, as a pointer, so that what OpenVDB needs to store
/// them is compiled once for each type and not once for each attribute.
template <typename T> struct PointValues {
    std::size_t stride;
    const void* get;
    /// Lists `stride` values for each of the points.
    void (*list)(const PointValues& column, const openvdb::PointIndex32* points, std::size_t count,
                 T* values);
};

template <typename T, typename Get>
PointValues<T> point_values(const Get& get, std::size_t stride = 1)
{
    return {stride, std::addressof(get),
            [](const PointValues<T>& column, const openvdb::PointIndex32* points, std::size_t count,
               T* values) {
                const Get& value_of = *static_cast<const Get*>(column.get);
                for (std::size_t i = 0; i < count; ++i)
                    for (std::size_t k = 0; k < column.stride; ++k)
                        *values++ = T(value_of(column.stride * points[i] + k));
            }};
}

/// A grid of points under construction. The entries of its columns are asked for point by point, in
/// any order and from any thread: of ten million triangles all columns as vectors would take
/// gigabytes. Precondition: openvdb::initialize().
class PointGridBuilder
{
public:
    /// The voxel is chosen for points on surfaces about as large as their box.
    PointGridBuilder(const char* name, const std::vector<openvdb::Vec3s>& positions);

    /// get(i) for the point at positions[i]; T is a std::int32_t, a float or a Vec3s.
    template <typename T, typename Get> void add(const std::string& name, const Get& get)
    {
        append({name}, point_values<T>(get));
    }
    template <typename T> void add(const std::string& name, const std::vector<T>& column)
    {
        add<T>(name, [&](std::size_t i) { return column[i]; });
    }
    /// get(stride * i + k) is element k of point i, a whole number. Each element stands under its
    /// own name as well, `name`0 and so on: VEX has no integer tuples.
    template <typename Get>
    void add_tuples(const std::string& name, std::size_t stride, const Get& get)
    {
        std::vector<std::string> names{name};
        for (std::size_t k = 0; k < stride; ++k)
            names.push_back(name + std::to_string(k));
        append(names, point_values<std::int32_t>(get, stride));
    }
    /// 0 or 1 for each point; shorts, because that is the type which OpenVDB's setGroup takes.
    void add_group(const std::string& name, const std::vector<short>& member);

    openvdb::points::PointDataGrid::Ptr take() const { return grid_; }

private:
    /// All values under the first name, and element k of each point under the name after k + 1.
    template <typename T>
    void append(const std::vector<std::string>& names, const PointValues<T>& column);

    openvdb::tools::PointIndexGrid::Ptr index_; ///< the order in which voxels took the points
    openvdb::points::PointDataGrid::Ptr grid_;
};

} // namespace vdb_shell

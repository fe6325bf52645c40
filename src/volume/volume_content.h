// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/grid_instances.h"

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

namespace vdb_shell
{

/// How much a volume holds, and how much of that where.
struct Content {
    double sum = 0;                ///< of the values of active voxels; of floats only
    double whole = 0, outside = 0; ///< see DeformOptions::most_outside

    double outside_share() const { return whole > 0 ? outside / whole : 0.0; }
};

/// visit(place, value) for each active voxel, also those of tiles, in the order of the tree.
template <typename Grid, typename Visit> void for_each_active(const Grid& grid, const Visit& visit)
{
    for (auto value = grid.cbeginValueOn(); value; ++value) {
        if (value.isVoxelValue()) {
            visit(value.getCoord(), *value);
            continue;
        }
        for (const openvdb::Coord& place : value.getBoundingBox())
            visit(place, *value);
    }
}

/// What a value counts for. Asked for each voxel, so the grid is asked for its class only once:
/// OpenVDB finds that by comparing strings.
template <typename Grid> class Magnitude
{
    using Value = typename Grid::ValueType;

public:
    explicit Magnitude(const Grid& grid)
        : level_set_(grid.getGridClass() == openvdb::GRID_LEVEL_SET),
          voxel_size_(grid.voxelSize()[0])
    {
    }
    double operator()(const Value& value) const
    {
        if constexpr (std::is_same_v<Value, float>) {
            if (level_set_)
                return std::abs(value) < voxel_size_ ? 1.0 : 0.0;
            return std::abs(double(value));
        } else if constexpr (std::is_integral_v<Value>) {
            return 1.0;
        } else {
            return openvdb::Vec3d(value).length();
        }
    }

private:
    bool level_set_;
    double voxel_size_;
};

/// `inside`: its active voxels, on the same lattice, are in the shell. In the order of the tree, so
/// that sums are the same each time.
template <typename Grid> Content content_of(const Grid& grid, const openvdb::Int32Grid& inside)
{
    Content content;
    const Magnitude<Grid> magnitude_of(grid);
    auto tet = inside.getConstAccessor();
    for_each_active(grid, [&](const openvdb::Coord& place, const typename Grid::ValueType& value) {
        const double magnitude = magnitude_of(value);
        content.whole += magnitude;
        if (!tet.isValueOn(place))
            content.outside += magnitude;
        if constexpr (std::is_same_v<typename Grid::ValueType, float>)
            content.sum += double(value);
    });
    return content;
}

inline double sum_of_values(const openvdb::FloatGrid& grid)
{
    double sum = 0;
    for_each_active(grid, [&](const openvdb::Coord&, float value) { sum += double(value); });
    return sum;
}

/// Whether a voxel in the box is active, up to the leaf that it is in.
template <typename Grid> bool any_active(const Grid& grid, const openvdb::CoordBBox& box)
{
    constexpr int kLeaf = 8;
    const auto& tree = grid.tree();
    const openvdb::Coord low = box.min() & ~(kLeaf - 1);
    for (int x = low.x(); x <= box.max().x(); x += kLeaf)
        for (int y = low.y(); y <= box.max().y(); y += kLeaf)
            for (int z = low.z(); z <= box.max().z(); z += kLeaf) {
                const openvdb::Coord place(x, y, z);
                const auto* leaf = tree.probeConstLeaf(place);
                if (leaf ? !leaf->isEmpty() : tree.isValueOn(place))
                    return true;
            }
    return false;
}

} // namespace vdb_shell

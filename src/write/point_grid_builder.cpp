// SPDX-License-Identifier: Apache-2.0

// Takes positions and the values of columns; gives an OpenVDB grid of points with these attributes.
// OpenVDB decides the order of points inside a grid: rows are visited in the order of the index
// grid, because that is the order in which createPointDataGrid laid the points down. Trap: an
// attribute cannot be appended to a tree without leaves, so a grid without points gets none.

#include "write/point_grid_builder.h"

#include "core/parallel.h"
#include "vdb_shell/mesh/triangle_mesh.h"

#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointGroup.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3s;
using openvdb::points::PointDataGrid;
using openvdb::points::PointDataTree;
using openvdb::tools::PointIndexGrid;

constexpr double kPointsPerVoxel = 4.0;

/// Voxels of which each holds a few points, if they lie near a surface as large as the box's.
openvdb::math::Transform::Ptr transform_for(const std::vector<Vec3s>& positions)
{
    auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    if (positions.empty())
        return transform;
    const Bounds bounds = bounds_of(positions);
    const Vec3d e = bounds.high - bounds.low;
    // The points lie on surfaces, not in a volume. So the voxel is chosen for a number of points
    // per area, with the box's own surface in place of the shell's.
    const double area = 2.0 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]);
    const double longest = std::max({e[0], e[1], e[2]});
    const double from_area = std::sqrt(kPointsPerVoxel * area / double(positions.size()));
    // A box without area is that of a line or of a point, where the estimate above gives 0; the
    // points are then counted along the longest side.
    const double voxel = std::max(from_area, longest / double(positions.size()));
    // OpenVDB refuses maps whose determinant is next to zero.
    constexpr double kSmallestVoxel = 1e-4;
    transform = openvdb::math::Transform::createLinearTransform(
        voxel > 0.0 ? std::max(voxel, kSmallestVoxel) : 1.0);
    // Starting at the box keeps voxel coordinates small wherever the shell lies.
    transform->postTranslate(bounds.low);
    return transform;
}

} // namespace

PointGridBuilder::PointGridBuilder(const char* name, const std::vector<Vec3s>& positions)
{
    const auto transform = transform_for(positions);
    const openvdb::points::PointAttributeVector<Vec3s> list(positions);
    index_ = openvdb::tools::createPointIndexGrid<PointIndexGrid>(list, *transform);
    grid_ = openvdb::points::createPointDataGrid<openvdb::points::NullCodec, PointDataGrid>(
        *index_, list, *transform);
    grid_->setName(name);
}

/// Leaves are filled in parallel; each writes its own arrays and reads shared data only.
template <typename T>
void PointGridBuilder::append(const std::vector<std::string>& names, const PointValues<T>& column)
{
    using Array = openvdb::points::TypedAttributeArray<T>;
    PointDataTree& tree = grid_->tree();
    if (!tree.cbeginLeaf())
        return;
    std::vector<std::size_t> place; // of each array among those of a leaf, the same in all leaves
    for (const std::string& name : names) {
        openvdb::points::appendAttribute<T>(tree, name, openvdb::zeroVal<T>(),
                                            name == names.front() ? openvdb::Index(column.stride)
                                                                  : 1);
        place.push_back(tree.cbeginLeaf()->attributeSet().find(name));
    }
    std::vector<PointDataTree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    const auto fill = [&](PointDataTree::LeafNodeType& leaf, std::vector<T>& values) {
        const auto& points = index_->tree().probeConstLeaf(leaf.origin())->indices();
        values.resize(points.size() * column.stride);
        column.list(column, points.data(), points.size(), values.data());
        for (std::size_t i = 0; i < names.size(); ++i) {
            // The typed array and not a handle, which calls a function for each value.
            auto& array = Array::cast(leaf.attributeArray(place[i]));
            array.expand(/*fill=*/false);
            const std::size_t first = i == 0 ? 0 : i - 1, step = i == 0 ? 1 : column.stride;
            openvdb::Index to = 0;
            for (std::size_t at = first; at < values.size(); at += step)
                array.setUnsafe(to++, values[at]);
            // Floats are left as they are: compacting takes -0 and 0 for the same value.
            if (std::is_integral_v<T>)
                // Equal numbers all over a leaf, as layers and pins mostly are, are stored once.
                array.compact();
        }
    };
    for_each_range(
        leaves.size(),
        [&](std::size_t begin, std::size_t end) {
            std::vector<T> values;
            for (std::size_t i = begin; i < end; ++i)
                fill(*leaves[i], values);
        },
        4);
}

template void PointGridBuilder::append(const std::vector<std::string>&,
                                       const PointValues<std::int32_t>&);
template void PointGridBuilder::append(const std::vector<std::string>&, const PointValues<float>&);
template void PointGridBuilder::append(const std::vector<std::string>&, const PointValues<Vec3s>&);

void PointGridBuilder::add_group(const std::string& name, const std::vector<short>& member)
{
    openvdb::points::appendGroup(grid_->tree(), name);
    if (!grid_->tree().empty())
        openvdb::points::setGroup(grid_->tree(), index_->tree(), member, name);
}

} // namespace vdb_shell

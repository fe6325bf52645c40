// SPDX-License-Identifier: Apache-2.0

// Takes positions and columns of values; gives an OpenVDB grid of points with these attributes.
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

/// `elements` values a point, which begin `stride` apart.
template <typename T> struct Column {
    const T* values;
    std::size_t stride;
    openvdb::Index elements;
};

/// Leaves are filled in parallel; each writes its own arrays and reads shared data only.
template <typename T>
void append(const PointIndexGrid& index, PointDataTree& tree, const std::string& name,
            const Column<T>& column)
{
    const auto first = tree.cbeginLeaf();
    if (!first)
        return;
    openvdb::points::appendAttribute<T>(tree, name, openvdb::zeroVal<T>(), column.elements);
    // Attributes are appended to all leaves alike, so the place is the same in each.
    const auto position = tree.cbeginLeaf()->attributeSet().find(name);
    std::vector<PointDataTree::LeafNodeType*> leaves;
    tree.getNodes(leaves);
    const auto fill = [&](std::size_t k) {
        // The typed array and not a handle, which calls a function for each value.
        auto& array =
            openvdb::points::TypedAttributeArray<T>::cast(leaves[k]->attributeArray(position));
        array.expand(/*fill=*/false);
        openvdb::Index to = 0;
        for (const auto point : index.tree().probeConstLeaf(leaves[k]->origin())->indices()) {
            const T* values = column.values + point * column.stride;
            for (openvdb::Index element = 0; element < column.elements; ++element)
                array.setUnsafe(to++, values[element]);
        }
        // Floats are left as they are: compacting takes -0 and 0 for the same value.
        if (std::is_integral_v<T>)
            // Equal numbers all over a leaf, as layers and pins mostly are, are stored once.
            array.compact();
    };
    for_each_index(leaves.size(), fill, 1);
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

void PointGridBuilder::add(const std::string& name, const std::vector<std::int32_t>& column)
{
    append<std::int32_t>(*index_, grid_->tree(), name, {column.data(), 1, 1});
}

void PointGridBuilder::add(const std::string& name, const std::vector<float>& column)
{
    append<float>(*index_, grid_->tree(), name, {column.data(), 1, 1});
}

void PointGridBuilder::add(const std::string& name, const std::vector<Vec3s>& column)
{
    append<Vec3s>(*index_, grid_->tree(), name, {column.data(), 1, 1});
}

void PointGridBuilder::add_tuples(const std::string& name, openvdb::Index stride,
                                  const std::vector<std::int32_t>& column)
{
    if (column.empty())
        return; // no leaf has an array
    append<std::int32_t>(*index_, grid_->tree(), name, {column.data(), stride, stride});
    for (openvdb::Index element = 0; element < stride; ++element)
        // From the same column by its stride, so nothing is copied.
        append<std::int32_t>(*index_, grid_->tree(), name + std::to_string(element),
                             {column.data() + element, stride, 1});
}

void PointGridBuilder::add_group(const std::string& name, const std::vector<short>& member)
{
    openvdb::points::appendGroup(grid_->tree(), name);
    if (!grid_->tree().empty())
        openvdb::points::setGroup(grid_->tree(), index_->tree(), member, name);
}

} // namespace vdb_shell

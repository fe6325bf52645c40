// SPDX-License-Identifier: Apache-2.0
#include "write/point_grids.h"

#include <openvdb/points/PointAttribute.h>
#include <openvdb/points/PointConversion.h>
#include <openvdb/points/PointGroup.h>
#include <openvdb/tools/PointIndexGrid.h>
#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <cmath>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using openvdb::points::PointDataGrid;
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
    const double area = 2.0 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]);
    const double longest = std::max({e[0], e[1], e[2]});
    const double from_area = std::sqrt(kPointsPerVoxel * area / double(positions.size()));
    // A box without area is a line or a point.
    const double voxel = std::max(from_area, longest / double(positions.size()));
    // OpenVDB refuses maps whose determinant is next to zero.
    constexpr double kSmallestVoxel = 1e-4;
    transform = openvdb::math::Transform::createLinearTransform(
        voxel > 0.0 ? std::max(voxel, kSmallestVoxel) : 1.0);
    // Starting at the box keeps voxel coordinates small wherever the shell lies.
    transform->postTranslate(bounds.low);
    return transform;
}

/// A grid of points under construction, with the order in which its voxels took the points.
class Builder
{
public:
    Builder(const char* name, const std::vector<Vec3s>& positions)
    {
        const auto transform = transform_for(positions);
        const openvdb::points::PointAttributeVector<Vec3s> list(positions);
        index_ = openvdb::tools::createPointIndexGrid<PointIndexGrid>(list, *transform);
        grid_ = openvdb::points::createPointDataGrid<openvdb::points::NullCodec, PointDataGrid>(
            *index_, list, *transform);
        grid_->setName(name);
    }

    /// get(point, element) is the attribute's value.
    template <typename T, typename Get>
    void add(const std::string& name, openvdb::Index stride, const Get& get)
    {
        auto& tree = grid_->tree();
        const auto first = tree.cbeginLeaf();
        if (!first)
            return;
        openvdb::points::appendAttribute<T>(tree, name, openvdb::zeroVal<T>(), stride);
        const auto position = tree.cbeginLeaf()->attributeSet().find(name);
        openvdb::tree::LeafManager<openvdb::points::PointDataTree> leaves(tree);
        leaves.foreach ([&](auto& leaf, std::size_t) {
            auto& array = leaf.attributeArray(position);
            openvdb::points::AttributeWriteHandle<T> handle(array);
            openvdb::Index row = 0;
            for (const auto point : index_->tree().probeConstLeaf(leaf.origin())->indices()) {
                for (openvdb::Index element = 0; element < stride; ++element)
                    handle.set(row, element, get(std::size_t(point), element));
                ++row;
            }
            // Floats are left as they are: compacting takes -0 and 0 for the same value.
            if (std::is_integral_v<T>)
                array.compact();
        });
    }

    /// One int32 per point.
    template <typename Get> void add_integer(const std::string& name, const Get& get)
    {
        add<std::int32_t>(
            name, 1, [&](std::size_t point, openvdb::Index) { return std::int32_t(get(point)); });
    }

    /// A tuple of int32 per point, and each element under its own name as well: VEX has no integer
    /// tuples.
    template <typename Get>
    void add_tuple(const std::string& name, openvdb::Index stride, const Get& get)
    {
        add<std::int32_t>(name, stride, get);
        for (openvdb::Index element = 0; element < stride; ++element)
            add_integer(name + std::to_string(element),
                        [&](std::size_t point) { return get(point, element); });
    }

    template <typename Get>
    void add_group(const std::string& name, std::size_t count, const Get& get)
    {
        std::vector<short> member(count);
        for (std::size_t i = 0; i < count; ++i)
            member[i] = get(i) ? 1 : 0;
        openvdb::points::appendGroup(grid_->tree(), name);
        if (!grid_->tree().empty())
            openvdb::points::setGroup(grid_->tree(), index_->tree(), member, name);
    }

    PointDataGrid::Ptr take() { return grid_; }

private:
    PointIndexGrid::Ptr index_;
    PointDataGrid::Ptr grid_;
};

template <typename Corner> Vec3s mean_of(int count, const Corner& corner)
{
    Vec3d sum(0.0);
    for (int i = 0; i < count; ++i)
        sum += Vec3d(corner(i));
    return Vec3s(sum / double(count));
}

PointDataGrid::Ptr make_points(const PrismShell& shell, const ShellPoints& points)
{
    Builder builder(kPointsGrid, points.position);
    const std::size_t count = points.position.size();
    const auto vertex = [&](std::size_t i) { return points.vertex[i]; };
    const auto is_pinned = [&](std::size_t i) { return shell.pinned(vertex(i)); };
    const auto outer_normals = layer_normals(shell.outer, shell.triangles);
    const auto inner_normals = layer_normals(shell.inner, shell.triangles);
    builder.add_integer("id", [](std::size_t i) { return i; });
    builder.add_integer("tet_point", [&](std::size_t i) { return points.tet_point[i]; });
    builder.add_integer("layer", [&](std::size_t i) { return points.layer[i]; });
    builder.add_integer("source_vertex", vertex);
    builder.add_integer("stop_reason",
                        [&](std::size_t i) { return std::int32_t(shell.stop[vertex(i)]); });
    builder.add_integer("pinned", is_pinned);
    builder.add<Vec3s>("rest", 1,
                       [&](std::size_t i, openvdb::Index) { return points.position[i]; });
    builder.add<Vec3s>("opposite", 1, [&](std::size_t i, openvdb::Index) {
        return points.layer[i] == 0 ? shell.inner[vertex(i)] : shell.outer[vertex(i)];
    });
    builder.add<Vec3s>("N", 1, [&](std::size_t i, openvdb::Index) {
        return (points.layer[i] == 0 ? outer_normals : inner_normals)[vertex(i)];
    });
    builder.add<float>("thickness", 1, [&](std::size_t i, openvdb::Index) {
        return float(shell.length(vertex(i)));
    });
    builder.add_group("outer", count, [&](std::size_t i) { return points.layer[i] == 0; });
    builder.add_group("inner", count, [&](std::size_t i) { return points.layer[i] == 1; });
    builder.add_group("pinned", count, is_pinned);
    return builder.take();
}

PointDataGrid::Ptr make_prisms(const PrismShell& shell, const PrismSplit& split,
                               const ShellPoints& points)
{
    std::vector<Vec3s> centres(shell.triangles.size());
    for (std::size_t p = 0; p < centres.size(); ++p) {
        const Vec3I t = shell.triangles[p];
        centres[p] =
            mean_of(6, [&](int i) { return i < 3 ? shell.outer[t[i]] : shell.inner[t[i - 3]]; });
    }
    Builder builder(kPrismsGrid, centres);
    builder.add_integer("id", [](std::size_t p) { return p; });
    builder.add_tuple("prism_pts", 6, [&](std::size_t p, openvdb::Index i) {
        const Vec3I t = shell.triangles[p];
        return std::int32_t(i < 3 ? t[int(i)] : points.inner_id[t[int(i) - 3]]);
    });
    builder.add_tuple("split_order", 3, [&](std::size_t p, openvdb::Index i) {
        return std::int32_t(split.order[p][i]);
    });
    return builder.take();
}

PointDataGrid::Ptr make_tet_points(const TetMesh& tets, const ShellPoints& points)
{
    std::vector<Vec3s> centres(tets.tets.size());
    for (std::size_t t = 0; t < centres.size(); ++t)
        centres[t] = mean_of(4, [&](int i) { return tets.points[tets.tets[t][i]]; });
    Builder builder(kTetsGrid, centres);
    builder.add_integer("id", [](std::size_t t) { return t; });
    builder.add_tuple("tet", 4, [&](std::size_t t, openvdb::Index i) {
        return std::int32_t(points.id_of_tet_point[tets.tets[t][int(i)]]);
    });
    builder.add_integer("prism", [&](std::size_t t) { return tets.prism[t]; });
    return builder.take();
}

} // namespace

std::vector<Vec3s> layer_normals(const std::vector<Vec3s>& points,
                                 const std::vector<Vec3I>& triangles)
{
    std::vector<Vec3d> sum(points.size(), Vec3d(0.0));
    for (const Vec3I& t : triangles) {
        const Vec3d a(points[t[0]]), b(points[t[1]]), c(points[t[2]]);
        const Vec3d area = (b - a).cross(c - a);
        for (int corner = 0; corner < 3; ++corner)
            sum[t[corner]] += area;
    }
    std::vector<Vec3s> normals(points.size(), Vec3s(0.0f));
    for (std::size_t i = 0; i < sum.size(); ++i)
        if (sum[i].normalize(0.0))
            normals[i] = Vec3s(sum[i]);
    return normals;
}

ShellPoints number_points(const PrismShell& shell, const TetMesh& tets)
{
    ShellPoints points;
    points.position = shell.outer;
    points.layer.assign(shell.outer.size(), 0);
    for (std::uint32_t v = 0; v < shell.outer.size(); ++v)
        points.vertex.push_back(v);
    points.inner_id = points.vertex;
    for (std::uint32_t v = 0; v < shell.outer.size(); ++v) {
        if (shell.pinned(v))
            continue;
        points.inner_id[v] = std::uint32_t(points.position.size());
        points.position.push_back(shell.inner[v]);
        points.vertex.push_back(v);
        points.layer.push_back(1);
    }
    points.tet_point.assign(points.position.size(), ShellPoints::kUnused);
    for (std::size_t i = 0; i < tets.points.size(); ++i) {
        const std::uint32_t v = tets.source_vertex[i];
        points.id_of_tet_point.push_back(tets.layer[i] == 0 ? v : points.inner_id[v]);
        points.tet_point[points.id_of_tet_point.back()] = std::int32_t(i);
    }
    return points;
}

ShellCounts counts_of(const PrismShell& shell, const TetMesh& tets)
{
    std::int64_t pillars = 0;
    for (std::size_t v = 0; v < shell.outer.size(); ++v)
        pillars += shell.pinned(v) ? 0 : 1;
    const auto vertices = std::int64_t(shell.outer.size());
    return {vertices, vertices + pillars, std::int64_t(tets.points.size()),
            std::int64_t(shell.triangles.size()), std::int64_t(tets.tets.size())};
}

PointGrids make_point_grids(const PrismShell& shell, const PrismSplit& split, const TetMesh& tets)
{
    const ShellPoints points = number_points(shell, tets);
    return {make_points(shell, points), make_prisms(shell, split, points),
            make_tet_points(tets, points)};
}

} // namespace vdb_shell

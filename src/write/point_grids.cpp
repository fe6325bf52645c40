// SPDX-License-Identifier: Apache-2.0

// Takes a consistent stack and its tets; gives three OpenVDB point grids from which the shell can
// be read back bit for bit. Two traps shape it. OpenVDB decides the order of points inside a grid,
// so every point carries its `id`. And it stores the position P relative to the voxel, in float32,
// which need not give the same float again, so the exact position stands in the attribute `rest`.
// What an attribute means is in docs/file_format.md.

#include "vdb_shell/shell/shared_points.h"

#include "write/point_grids.h"

#include "core/parallel.h"

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

    /// get(point, element) is the attribute's value. Leaves are filled in parallel; each writes its
    /// own arrays and reads shared data only. Rows are visited in the order of the index grid,
    /// because that is the order in which createPointDataGrid laid the points down.
    template <typename T, typename Get>
    void add(const std::string& name, openvdb::Index stride, const Get& get)
    {
        auto& tree = grid_->tree();
        // A shell without tets has an empty grid, and an attribute cannot be appended to a tree
        // without leaves. The reader needs none either, as it expects no rows.
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
        // Shorts, because that is the type which OpenVDB's setGroup takes.
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

/// Where a prism or a tet is drawn. Nothing is read back from it, so its rounding does not matter.
template <typename Corner> Vec3s mean_of(int count, const Corner& corner)
{
    Vec3d sum(0.0);
    for (int i = 0; i < count; ++i)
        sum += Vec3d(corner(i));
    return Vec3s(sum / double(count));
}

/// Layers on one side of the skin share their reasons (require_consistent checks that), so the last
/// layer speaks for all below the skin and the first for all above.
void add_stop_reasons(Builder& builder, const ShellStack& stack, const ShellPoints& points)
{
    const auto add = [&](const char* name, const PrismShell& layer) {
        builder.add_integer(
            name, [&](std::size_t i) { return std::int32_t(layer.stop[points.vertex[i]]); });
    };
    add("stop_reason", stack.layers.back());
    if (on_both_sides(stack))
        add(kOuterStop, stack.layers.front());
}

PointDataGrid::Ptr make_points(const ShellStack& stack, const ShellPoints& points)
{
    Builder builder(kPointsGrid, points.position);
    const std::size_t count = points.position.size(), last = stack.layers.size();
    const auto vertex = [&](std::size_t i) { return points.vertex[i]; };
    const auto layer = [&](std::size_t i) { return points.layer[i]; };
    const auto is_pinned = [&](std::size_t i) { return pinned_throughout(stack, vertex(i)); };
    std::vector<std::vector<Vec3s>> normals;
    for (std::size_t k = 0; k <= last; ++k)
        normals.push_back(layer_normals(stack.surface(k), stack.triangles()));
    builder.add_integer("id", [](std::size_t i) { return i; });
    builder.add_integer("tet_point", [&](std::size_t i) { return points.tet_point[i]; });
    builder.add_integer("layer", layer);
    builder.add_integer("source_vertex", vertex);
    add_stop_reasons(builder, stack, points);
    builder.add_integer("pinned", is_pinned);
    builder.add<Vec3s>("rest", 1,
                       [&](std::size_t i, openvdb::Index) { return points.position[i]; });
    builder.add<Vec3s>("opposite", 1, [&](std::size_t i, openvdb::Index) {
        return opposite_of(stack, layer(i), vertex(i));
    });
    builder.add<Vec3s>("N", 1,
                       [&](std::size_t i, openvdb::Index) { return normals[layer(i)][vertex(i)]; });
    builder.add<float>("thickness", 1, [&](std::size_t i, openvdb::Index) {
        return thickness_of(stack, vertex(i));
    });
    builder.add_group("outer", count, [&](std::size_t i) { return layer(i) == 0; });
    builder.add_group("inner", count, [&](std::size_t i) { return layer(i) == last; });
    builder.add_group("pinned", count, is_pinned);
    return builder.take();
}

PointDataGrid::Ptr make_prisms(const ShellStack& stack, const ShellPoints& points)
{
    const std::vector<Vec3I>& triangles = stack.triangles();
    const std::size_t faces = triangles.size();
    std::vector<Vec3s> centres(stack.layers.size() * faces);
    for (std::size_t p = 0; p < centres.size(); ++p) {
        const Vec3I t = triangles[p % faces];
        const PrismShell& layer = stack.layers[p / faces];
        centres[p] =
            mean_of(6, [&](int i) { return i < 3 ? layer.outer[t[i]] : layer.inner[t[i - 3]]; });
    }
    Builder builder(kPrismsGrid, centres);
    builder.add_integer("id", [](std::size_t p) { return p; });
    builder.add_tuple("prism_pts", 6, [&](std::size_t p, openvdb::Index i) {
        const std::size_t surface = p / faces + (i < 3 ? 0 : 1);
        return std::int32_t(points.id[surface][triangles[p % faces][int(i % 3)]]);
    });
    builder.add_tuple("split_order", 3, [&](std::size_t p, openvdb::Index i) {
        return std::int32_t(stack.splits[p / faces].order[p % faces][i]);
    });
    if (stack.layers.size() > 1) {
        builder.add_integer("layer", [&](std::size_t p) { return p / faces; });
        builder.add_integer("triangle", [&](std::size_t p) { return p % faces; });
    }
    return builder.take();
}

PointDataGrid::Ptr make_tet_points(const ShellStack& stack, const TetMesh& tets,
                                   const ShellPoints& points)
{
    const std::size_t faces = stack.triangles().size();
    std::vector<Vec3s> centres(tets.tets.size());
    for (std::size_t t = 0; t < centres.size(); ++t)
        centres[t] = mean_of(4, [&](int i) { return tets.points[tets.tets[t][i]]; });
    Builder builder(kTetsGrid, centres);
    builder.add_integer("id", [](std::size_t t) { return t; });
    builder.add_tuple("tet", 4, [&](std::size_t t, openvdb::Index i) {
        return std::int32_t(points.id_of_tet_point[tets.tets[t][int(i)]]);
    });
    builder.add_integer("prism",
                        [&](std::size_t t) { return tets.prism_layer[t] * faces + tets.prism[t]; });
    if (stack.layers.size() > 1)
        builder.add_integer("layer", [&](std::size_t t) { return tets.prism_layer[t]; });
    return builder.take();
}

} // namespace

const Vec3s& opposite_of(const ShellStack& stack, std::size_t surface, std::size_t vertex)
{
    const bool last = surface == stack.layers.size();
    return stack.surface(last ? surface - 1 : surface + 1)[vertex];
}

/// The sum over the layers and not the distance of the two ends: on both sides of the skin the
/// pillar may have a bend.
float thickness_of(const ShellStack& stack, std::size_t vertex)
{
    double sum = 0.0;
    for (const PrismShell& layer : stack.layers)
        sum += layer.length(vertex);
    return float(sum);
}

bool pinned_throughout(const ShellStack& stack, std::size_t vertex)
{
    return std::all_of(stack.layers.begin(), stack.layers.end(),
                       [&](const PrismShell& layer) { return layer.pinned(vertex); });
}

/// The cross product is twice the area times the normal, so large triangles weigh more. The sum
/// goes over the triangles in their order, in one thread, so it is rounded the same way each time.
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

namespace
{

/// Points that are one in the tets name the same point of the tets. The first place that shares a
/// point has an id of its own, which comes before those of the others.
void share_tet_points(const ShellStack& stack, ShellPoints& points)
{
    const std::vector<std::uint32_t> first = first_places(stack);
    const std::size_t vertices = stack.surface(0).size();
    for (std::size_t i = 0; i < points.position.size(); ++i) {
        const std::uint32_t place = first[points.layer[i] * vertices + points.vertex[i]];
        points.tet_point[i] = points.tet_point[points.id[place / vertices][place % vertices]];
    }
}

} // namespace

ShellPoints number_points(const ShellStack& stack, const TetMesh& tets)
{
    ShellPoints points;
    const auto vertices = std::uint32_t(stack.surface(0).size());
    points.id.assign(stack.surfaces(), std::vector<std::uint32_t>(vertices));
    for (std::size_t k = 0; k < stack.surfaces(); ++k)
        for (std::uint32_t v = 0; v < vertices; ++v) {
            // A pinned pillar has both ends at one place and gets one point. Two points at the same
            // place would part the tets there.
            if (k > 0 && stack.layers[k - 1].pinned(v)) {
                points.id[k][v] = points.id[k - 1][v];
                continue;
            }
            points.id[k][v] = std::uint32_t(points.position.size());
            points.position.push_back(stack.surface(k)[v]);
            points.vertex.push_back(v);
            points.layer.push_back(std::uint8_t(k));
        }
    points.tet_point.assign(points.position.size(), ShellPoints::kUnused);
    for (std::size_t i = 0; i < tets.points.size(); ++i) {
        points.id_of_tet_point.push_back(points.id[tets.layer[i]][tets.source_vertex[i]]);
        points.tet_point[points.id_of_tet_point.back()] = std::int32_t(i);
    }
    if (stack.tapered)
        share_tet_points(stack, points);
    return points;
}

ShellCounts counts_of(const ShellStack& stack, const TetMesh& tets)
{
    const auto vertices = std::int64_t(stack.surface(0).size());
    std::int64_t points = vertices;
    for (const PrismShell& layer : stack.layers)
        for (std::size_t v = 0; v < layer.outer.size(); ++v)
            points += layer.pinned(v) ? 0 : 1;
    const auto layers = std::int64_t(stack.layers.size());
    return {vertices,
            points,
            std::int64_t(tets.points.size()),
            layers * std::int64_t(stack.triangles().size()),
            std::int64_t(tets.tets.size()),
            layers,
            std::int64_t(stack.skin),
            stack.tapered};
}

PointGrids make_point_grids(const ShellStack& stack, const TetMesh& tets)
{
    const ShellPoints points = number_points(stack, tets);
    PointGrids grids;
    run_together([&] { grids.tets = make_tet_points(stack, tets, points); },
                 [&] { grids.points = make_points(stack, points); },
                 [&] { grids.prisms = make_prisms(stack, points); });
    return grids;
}

} // namespace vdb_shell

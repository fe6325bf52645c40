// SPDX-License-Identifier: Apache-2.0

// Takes a consistent stack and its tets; gives three OpenVDB point grids from which the shell can
// be read back bit for bit. Two traps shape it. OpenVDB decides the order of points inside a grid,
// so every point carries its `id`. And it stores the position P relative to the voxel, in float32,
// which need not give the same float again, so the exact position stands in the attribute `rest`.
// What an attribute means is in docs/file_format.md.

#include "vdb_shell/shell/shared_points.h"

#include "write/point_grids.h"

#include "core/parallel.h"
#include "write/core_feet_grid.h"
#include "write/point_grid_builder.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;
using openvdb::points::PointDataGrid;

/// get(i) for each of `count` points.
template <typename T, typename Get> std::vector<T> column(std::size_t count, const Get& get)
{
    std::vector<T> values(count);
    for_each_index(count, [&](std::size_t i) { values[i] = T(get(i)); });
    return values;
}

/// Where a prism or a tet is drawn. Nothing is read back from it, so its rounding does not matter.
template <typename Corner> Vec3s mean_of(int count, const Corner& corner)
{
    Vec3d sum(0.0);
    for (int i = 0; i < count; ++i)
        sum += Vec3d(corner(i));
    return Vec3s(sum / double(count));
}

/// Layers on one side of the skin share their reasons (require_consistent checks that), so the last
/// layer speaks for all below the skin (stop_reason_of) and the first for all above.
void add_stop_reasons(PointGridBuilder& builder, const ShellStack& stack, const ShellPoints& points)
{
    builder.add<std::int32_t>(
        "stop_reason", [&](std::size_t i) { return stop_reason_of(stack, points.vertex[i]); });
    // Only then are there two reasons for a vertex; other files go without the column.
    if (on_both_sides(stack))
        builder.add<std::int32_t>(
            kOuterStop, [&](std::size_t i) { return stack.layers.front().stop[points.vertex[i]]; });
}

/// Positions, and what is drawn or shaded with: the other end of the pillar, normal, thickness.
void add_geometry(PointGridBuilder& builder, const ShellStack& stack, const ShellPoints& points,
                  const RestPoints& rest)
{
    std::vector<std::vector<Vec3s>> normals;
    for (std::size_t k = 0; k < stack.surfaces(); ++k)
        normals.push_back(layer_normals(stack.surface(k), stack.triangles()));
    builder.add(position_attribute(rest.posed()), points.position);
    if (rest.posed())
        builder.add("rest", vectors_by_id(points, rest));
    if (!rest.velocity.empty())
        builder.add("v", vectors_by_id(points, rest.velocity));
    builder.add<Vec3s>("opposite", [&](std::size_t i) {
        return opposite_of(stack, points.layer[i], points.vertex[i]);
    });
    builder.add<Vec3s>("N",
                       [&](std::size_t i) { return normals[points.layer[i]][points.vertex[i]]; });
    builder.add<float>("thickness",
                       [&](std::size_t i) { return thickness_of(stack, points.vertex[i]); });
}

PointDataGrid::Ptr make_points(const ShellStack& stack, const ShellPoints& points,
                               const std::vector<CoreFoot>& feet, const RestPoints& rest)
{
    PointGridBuilder builder(kPointsGrid, points.position);
    const std::size_t count = points.position.size(), last = stack.layers.size();
    const auto is_pinned = [&](std::size_t i) {
        return pinned_throughout(stack, points.vertex[i]);
    };
    builder.add<std::int32_t>("id", [](std::size_t i) { return i; });
    builder.add<std::int32_t>("tet_point", [&](std::size_t i) { return points.tet_point[i]; });
    builder.add<std::int32_t>("layer", [&](std::size_t i) { return points.layer[i]; });
    builder.add<std::int32_t>("source_vertex", [&](std::size_t i) { return points.vertex[i]; });
    add_stop_reasons(builder, stack, points);
    builder.add<std::int32_t>("pinned", is_pinned);
    add_geometry(builder, stack, points, rest);
    add_core_feet(builder, points, feet);
    const auto on_surface = [&](std::size_t surface) {
        return column<short>(count, [&](std::size_t i) { return points.layer[i] == surface; });
    };
    builder.add_group("outer", on_surface(0));
    builder.add_group("inner", on_surface(last));
    builder.add_group("pinned", column<short>(count, is_pinned));
    return builder.take();
}

PointDataGrid::Ptr make_prisms(const ShellStack& stack, const ShellPoints& points)
{
    const std::vector<Vec3I>& triangles = stack.triangles();
    const std::size_t faces = triangles.size(), count = stack.layers.size() * faces;
    PointGridBuilder builder(kPrismsGrid, column<Vec3s>(count, [&](std::size_t p) {
                                 const Vec3I t = triangles[p % faces];
                                 const PrismShell& layer = stack.layers[p / faces];
                                 return mean_of(6, [&](int i) {
                                     return i < 3 ? layer.outer[t[i]] : layer.inner[t[i - 3]];
                                 });
                             }));
    builder.add<std::int32_t>("id", [](std::size_t p) { return p; });
    builder.add_tuples("prism_pts", 6, [&](std::size_t k) {
        const std::size_t p = k / 6, i = k % 6;
        const std::size_t surface = p / faces + (i < 3 ? 0 : 1);
        return points.id[surface][triangles[p % faces][int(i % 3)]];
    });
    builder.add_tuples("split_order", 3, [&](std::size_t k) {
        const std::size_t p = k / 3;
        return stack.splits[p / faces].order[p % faces][k % 3];
    });
    if (stack.layers.size() > 1) {
        builder.add<std::int32_t>("layer", [&](std::size_t p) { return p / faces; });
        builder.add<std::int32_t>("triangle", [&](std::size_t p) { return p % faces; });
    }
    return builder.take();
}

PointDataGrid::Ptr make_tet_points(const ShellStack& stack, const TetMesh& tets,
                                   const ShellPoints& points)
{
    const std::size_t faces = stack.triangles().size(), count = tets.tets.size();
    const auto centre = [&](std::size_t t) {
        return mean_of(4, [&](int i) { return tets.points[tets.tets[t][i]]; });
    };
    PointGridBuilder builder(kTetsGrid, column<Vec3s>(count, centre));
    builder.add<std::int32_t>("id", [](std::size_t t) { return t; });
    builder.add_tuples("tet", 4, [&](std::size_t k) {
        return points.id_of_tet_point[tets.tets[k / 4][int(k % 4)]];
    });
    builder.add<std::int32_t>(
        "prism", [&](std::size_t t) { return tets.prism_layer[t] * faces + tets.prism[t]; });
    if (stack.layers.size() > 1)
        builder.add<std::int32_t>("layer", [&](std::size_t t) { return tets.prism_layer[t]; });
    return builder.take();
}

} // namespace

const Vec3s& opposite_of(const ShellStack& stack, std::size_t surface, std::size_t vertex)
{
    // The innermost surface has nothing below it: its points look back up.
    const bool last = surface == stack.layers.size();
    return stack.surface(last ? surface - 1 : surface + 1)[vertex];
}

float thickness_of(const ShellStack& stack, std::size_t vertex)
{
    return float(pillar_length(stack, vertex));
}

StopReason stop_reason_of(const ShellStack& stack, std::size_t vertex)
{
    return stack.layers.back().stop[vertex];
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
        // A point whose triangles cancel or have no area keeps a normal of 0.
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

std::vector<Vec3s> vectors_by_id(const ShellPoints& points, const PointVectors& vectors)
{
    return column<Vec3s>(points.position.size(), [&](std::size_t i) {
        return vectors.surface[points.layer[i]][points.vertex[i]];
    });
}

std::vector<std::vector<Vec3s>> vectors_by_surface(const ShellPoints& points,
                                                   const std::vector<Vec3s>& by_id)
{
    std::vector<std::vector<Vec3s>> surfaces;
    for (const std::vector<std::uint32_t>& ids : points.id)
        surfaces.push_back(column<Vec3s>(ids.size(), [&](std::size_t v) { return by_id[ids[v]]; }));
    return surfaces;
}

PillarValues pillar_values(const ShellStack& stack, const TetMesh& tets, std::size_t points)
{
    PillarValues values{std::vector<float>(points), std::vector<std::int32_t>(points)};
    for_each_index(tets.points.size(), [&](std::size_t p) {
        values.thickness[p] = thickness_of(stack, tets.source_vertex[p]);
        values.stop_reason[p] = std::int32_t(stop_reason_of(stack, tets.source_vertex[p]));
    });
    return values;
}

std::vector<Vec3s> vectors_of_tet_points(const TetMesh& tets, const PointVectors& vectors)
{
    std::vector<Vec3s> points;
    for (std::size_t p = 0; !vectors.empty() && p < tets.points.size(); ++p)
        points.push_back(vectors.surface[tets.layer[p]][tets.source_vertex[p]]);
    points.insert(points.end(), vectors.core.begin(), vectors.core.end());
    return points;
}

ShellCounts counts_of(const ShellStack& stack, const TetMesh& tets, const CoreTets& core)
{
    const auto vertices = std::int64_t(stack.surface(0).size());
    std::int64_t points = vertices;
    for (const PrismShell& layer : stack.layers)
        for (std::size_t v = 0; v < layer.outer.size(); ++v)
            // As number_points counts: below a pinned pillar a surface has no point of its own.
            points += layer.pinned(v) ? 0 : 1;
    const auto layers = std::int64_t(stack.layers.size());
    return {vertices,
            points,
            std::int64_t(tets.points.size()),
            layers * std::int64_t(stack.triangles().size()),
            std::int64_t(tets.tets.size()),
            layers,
            std::int64_t(stack.skin),
            stack.tapered,
            std::int64_t(core.points.size()),
            std::int64_t(core.tets.size())};
}

PointGrids make_point_grids(const ShellStack& stack, const TetMesh& tets,
                            const std::vector<CoreFoot>& feet, const RestPoints& rest)
{
    const ShellPoints points = number_points(stack, tets);
    PointGrids grids;
    // The three only read what they share.
    run_together([&] { grids.tets = make_tet_points(stack, tets, points); },
                 [&] { grids.points = make_points(stack, points, feet, rest); },
                 [&] { grids.prisms = make_prisms(stack, points); });
    return grids;
}

} // namespace vdb_shell

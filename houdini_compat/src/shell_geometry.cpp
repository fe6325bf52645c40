// SPDX-License-Identifier: Apache-2.0

// Takes a shell's file; gives the geometry that Houdini sees: tets and surfaces that share their
// points, attributes, groups, and all that is needed to get the same shell back bit for bit
// (docs/houdini.md has the tables). Orientation is turned here, and only here and in the reader:
// polygons clockwise seen from outside, tets of negative determinant. The order of points and
// primitives is part of the format: the reader finds the surfaces by it.

#include "vdb_shell/houdini/shell_geometry.h"

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/shell/quality.h"
#include "vdb_shell/write/shell_points.h"

#include "core_columns.h"
#include "detail_figures.h"
#include "filled_core.h"
#include "geometry_digest.h"
#include "input_columns.h"
#include "shell_names.h"

#include <algorithm>
#include <array>
#include <limits>

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

constexpr const char* kOrientationText =
    "polygons clockwise seen from outside; tetrahedra (a,b,c,d) with det(b-a,c-a,d-a) < 0 unless "
    "inverted";

template <typename Get>
Attribute integers(const char* name, std::size_t count, int size, const Get& get)
{
    std::vector<std::int32_t> values;
    values.reserve(count * static_cast<std::size_t>(size));
    for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < size; ++k)
            values.push_back(static_cast<std::int32_t>(get(i, k)));
    return {name, size, kIndex, std::move(values)};
}

template <typename Get> Attribute floats(const char* name, std::size_t count, const Get& get)
{
    std::vector<float> values;
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
        values.push_back(static_cast<float>(get(i)));
    return {name, 1, "", std::move(values)};
}

template <typename Get>
Attribute vectors(const char* name, const char* meaning, std::size_t count, const Get& get)
{
    std::vector<float> values;
    values.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3s vector = get(i);
        values.insert(values.end(), {vector[0], vector[1], vector[2]});
    }
    return {name, 3, meaning, std::move(values)};
}

template <typename Belongs> Group group(const char* name, std::size_t count, const Belongs& belongs)
{
    Group made{name, std::vector<bool>(count)};
    for (std::size_t i = 0; i < count; ++i)
        made.members[i] = belongs(i);
    return made;
}

bool has_layers(const ShellStack& stack)
{
    return layered(stack.layers.size(), stack.skin);
}

/// The names of those reasons that occur, in the order of StopReason. Text is what people filter
/// by, and it survives if the numbers of the reasons ever change.
Attribute stop_reasons(const char* name, const PrismShell& shell,
                       const std::vector<std::uint32_t>& vertex)
{
    std::array<bool, kStopReasonCount> used{};
    for (const StopReason reason : shell.stop)
        used[static_cast<std::size_t>(reason)] = true;
    Strings strings;
    std::array<std::int32_t, kStopReasonCount> place{};
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) {
            place[i] = static_cast<std::int32_t>(strings.table.size());
            strings.table.emplace_back(name_of(static_cast<StopReason>(i)));
        }
    for (const std::uint32_t v : vertex)
        strings.index.push_back(place[static_cast<std::size_t>(shell.stop[v])]);
    return {name, 1, "", std::move(strings)};
}

void add_point_attributes(const ShellStack& stack, const ShellPoints& points,
                          const RestPoints& rest, HoudiniGeometry& geometry)
{
    const std::size_t count = points.position.size(), last = stack.layers.size();
    std::vector<std::vector<Vec3s>> normals;
    for (std::size_t k = 0; k <= last; ++k)
        normals.push_back(layer_normals(stack.surface(k), stack.triangles()));
    const auto vertex = [&](std::size_t i) { return points.vertex[i]; };
    const auto surface = [&](std::size_t i) { return points.layer[i]; };
    const auto position = [&](std::size_t i) { return points.position[i]; };
    const std::vector<Vec3s> at_rest = rest.posed() ? vectors_by_id(points, rest) : points.position;
    geometry.points = count;
    geometry.point_attributes = {
        vectors("P", "point", count, position),
        vectors("N", "normal", count,
                [&](std::size_t i) { return normals[surface(i)][vertex(i)]; }),
        // Without a meaning, so that transforms leave them alone. Unless the shell is posed, they
        // are the numbers of P.
        vectors(kRest, "", count, [&](std::size_t i) { return at_rest[i]; }),
        vectors(kOpposite, "point", count,
                [&](std::size_t i) { return opposite_of(stack, surface(i), vertex(i)); }),
        floats("thickness", count, [&](std::size_t i) { return thickness_of(stack, vertex(i)); }),
        floats("depth", count,
               [&](std::size_t i) { return double(surface(i)) / static_cast<double>(last); }),
        integers(kSourceVertex, count, 1, [&](std::size_t i, int) { return vertex(i); }),
        stop_reasons(kStopReason, stack.layers.back(), points.vertex)};
    if (on_both_sides(stack))
        geometry.point_attributes.push_back(
            stop_reasons(kOuterStop, stack.layers.front(), points.vertex));
    if (!rest.velocity.empty()) {
        const std::vector<Vec3s> velocity = vectors_by_id(points, rest.velocity);
        geometry.point_attributes.push_back(
            vectors(kVelocity, "vector", count, [&](std::size_t i) { return velocity[i]; }));
    }
    if (has_layers(stack))
        geometry.point_attributes.push_back(
            integers(kSurface, count, 1, [&](std::size_t i, int) { return surface(i); }));
}

void add_point_groups(const ShellStack& stack, const ShellPoints& points, HoudiniGeometry& geometry)
{
    const auto add = [&](const char* name, const auto& belongs) {
        geometry.point_groups.push_back(group(name, points.position.size(), belongs));
    };
    add("outer", [&](std::size_t i) { return points.layer[i] == 0; });
    add("inner", [&](std::size_t i) { return points.layer[i] == stack.layers.size(); });
    add("pinned", [&](std::size_t i) { return pinned_throughout(stack, points.vertex[i]); });
    // By id and not by layer: where the pillar above is pinned, the point of the skin is that of a
    // surface farther out, and has its number.
    if (has_layers(stack))
        add("skin", [&](std::size_t i) { return points.id[stack.skin][points.vertex[i]] == i; });
}

/// What a primitive belongs to; a triangle is that of its prism on `surface`.
struct Part {
    std::size_t prism = 0, layer = 0, surface = 0;
};

/// The primitives in their order: the tets, then the triangles of the surfaces that are shown. A
/// prism without tets, between those surfaces, follows as the triangle to which it has collapsed;
/// otherwise no primitive of the file would tell its diagonals, which the checksum covers.
std::vector<Part> parts_of(const ShellFile& file)
{
    const std::size_t layers = file.stack.layers.size(), prisms = file.stack.triangles().size();
    std::vector<Part> parts;
    std::vector<bool> told(layers * prisms, false);
    const auto add = [&](const Part& part) {
        told[part.layer * prisms + part.prism] = true;
        parts.push_back(part);
    };
    for (std::size_t t = 0; t < file.tets.tets.size(); ++t)
        add({file.tets.prism[t], file.tets.prism_layer[t], 0});
    for (const std::size_t surface : shown_surfaces(layers, file.stack.skin))
        for (std::size_t p = 0; p < prisms; ++p)
            add({p, layer_at(surface, layers), surface});
    for (std::size_t i = 0; i < told.size(); ++i)
        if (!told[i])
            parts.push_back({i % prisms, i / prisms, i / prisms});
    return parts;
}

/// In Houdini's orientation: a tet has its last two corners exchanged, which turns the sign of its
/// determinant, and a triangle keeps its first corner and runs backwards.
void add_primitives(const ShellFile& file, const ShellPoints& points,
                    const std::vector<Part>& parts, HoudiniGeometry& geometry)
{
    for (const openvdb::Vec4I& t : file.tets.tets) {
        for (const int corner : {0, 1, 3, 2})
            geometry.vertex_point.push_back(points.id_of_tet_point[t[corner]]);
        geometry.primitives.push_back({PrimitiveType::tetrahedron, 4});
    }
    for (std::size_t i = file.tets.tets.size(); i < parts.size(); ++i) {
        const Vec3I& t = file.stack.triangles()[parts[i].prism];
        for (const int corner : {0, 2, 1})
            geometry.vertex_point.push_back(points.id[parts[i].surface][t[corner]]);
        geometry.primitives.push_back({PrimitiveType::polygon, 3});
    }
}

/// The mean ratio of each tet, 1 for the regular one; for a triangle the worst of the tets of its
/// prism, 0 if it has none.
std::vector<float> qualities(const ShellFile& file, const std::vector<Part>& parts)
{
    const TetMesh& tets = file.tets;
    const std::size_t prisms = file.stack.triangles().size();
    const auto prism_of = [&](std::size_t i) { return parts[i].layer * prisms + parts[i].prism; };
    std::vector<float> quality;
    std::vector<float> worst(file.stack.layers.size() * prisms, 0.0f);
    std::vector<bool> seen(worst.size(), false);
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        // In double, though the corners are floats: the quality of slivers is a difference of
        // nearly equal products.
        const auto corner = [&](int k) { return Vec3d(tets.points[tets.tets[t][k]]); };
        quality.push_back(
            static_cast<float>(mean_ratio(corner(0), corner(1), corner(2), corner(3))));
        const std::size_t prism = prism_of(t);
        worst[prism] = seen[prism] ? std::min(worst[prism], quality.back()) : quality.back();
        seen[prism] = true;
    }
    for (std::size_t i = tets.tets.size(); i < parts.size(); ++i)
        quality.push_back(worst[prism_of(i)]);
    return quality;
}

void add_primitive_attributes(const ShellFile& file, const std::vector<Part>& parts,
                              HoudiniGeometry& geometry)
{
    const std::size_t count = parts.size();
    geometry.primitive_attributes = {
        integers(kPrism, count, 1, [&](std::size_t i, int) { return parts[i].prism; }),
        integers(kLayer, count, 1, [&](std::size_t i, int) { return parts[i].layer; }),
        {"quality", 1, "", qualities(file, parts)},
        integers(kSplitOrder, count, 3, [&](std::size_t i, int k) {
            const PrismSplit& split = file.stack.splits[parts[i].layer];
            return split.order[parts[i].prism][static_cast<std::size_t>(k)];
        })};
}

void add_primitive_groups(const ShellFile& file, const std::vector<Part>& parts,
                          HoudiniGeometry& geometry)
{
    const ShellStack& stack = file.stack;
    const std::size_t tets = file.tets.tets.size(), prisms = stack.triangles().size();
    const auto surfaces = shown_surfaces(stack.layers.size(), stack.skin);
    // Triangles of shown surfaces end here in the order of parts_of.
    const std::size_t collapsed = tets + surfaces.size() * prisms;
    const auto add = [&](const char* name, const auto& belongs) {
        geometry.primitive_groups.push_back(group(name, parts.size(), belongs));
    };
    const auto on_surface = [&](std::size_t surface) {
        return [&, surface](std::size_t i) {
            return i >= tets && i < collapsed && parts[i].surface == surface;
        };
    };
    add("shell", [&](std::size_t i) { return i < tets; });
    add("outer", on_surface(0));
    add("inner", on_surface(stack.layers.size()));
    add("pinned", [&](std::size_t i) {
        // A prism that is pinned at all corners has no tet in any layer, so only triangles are in
        // this group.
        const Vec3I& t = stack.triangles()[parts[i].prism];
        return pinned_throughout(stack, t[0]) && pinned_throughout(stack, t[1]) &&
               pinned_throughout(stack, t[2]);
    });
    if (!has_layers(stack))
        return;
    add("skin", on_surface(stack.skin));
    add(kCollapsed, [&](std::size_t i) { return i >= collapsed; });
}

void add_detail(const ShellFile& file, HoudiniGeometry& geometry)
{
    // The reader bounds its memory by these counts, and compares them with the primitives.
    ShellCounts counts = counts_of(file.stack, file.tets, file.core);
    counts.posed = file.rest.posed();
    const int schema = schema_for(counts);
    add_count(geometry, kSchema, static_cast<std::size_t>(schema));
    add_count(geometry, kVertices, static_cast<std::size_t>(counts.vertices));
    add_count(geometry, kPrisms, static_cast<std::size_t>(counts.prisms));
    add_count(geometry, kTets, file.tets.tets.size());
    if (schema >= kLayeredSchema) {
        add_count(geometry, kLayers, file.stack.layers.size());
        add_count(geometry, kSkin, file.stack.skin);
    }
    if (schema >= kTaperedSchema)
        add_count(geometry, kTapered, counts.tapered ? 1 : 0);
    if (counts.posed)
        add_count(geometry, kPosed, 1);
    if (!file.core.empty()) {
        add_count(geometry, kCorePointCount, file.core.points.size());
        add_count(geometry, kCoreTetCount, file.core.tets.size());
    }
    add_count(geometry, kRipples, ripples_of(file.stack));
    if (!file.input.empty())
        add_count(geometry, kInputPointCount, file.input.points.size());
    if (file.placement.moves()) {
        const Vec3d& o = file.placement.origin;
        geometry.detail_attributes.push_back(
            {kOrigin, 3, "", std::vector<double>{o[0], o[1], o[2]}});
        geometry.detail_attributes.push_back(
            {kUnit, 1, "", std::vector<double>{file.placement.unit}});
    }
    add_text(geometry, kCreator, "vdb_shell " VDB_SHELL_VERSION);
    add_text(geometry, kOrientation, kOrientationText);
    add_text(geometry, kChecksum, checksum_of(file.stack, file.tets, file.core));
    add_text(geometry, kParameters, file.parameters_json);
    add_text(geometry, kReport, file.report_json);
    add_figures(geometry, file.report_json);
}

/// The reader makes a point for each vertex on every surface, so it bounds their number by the
/// triangles that the file holds. A shell with more vertices than corners would be refused there,
/// and so it is refused here.
void require_readable(const ShellStack& stack)
{
    const std::size_t vertices = stack.surface(0).size(), triangles = stack.triangles().size();
    if ((has_layers(stack) || stack.tapered) && vertices > 3 * triangles)
        throw InvalidOption(
            "the shell cannot be written as Houdini geometry: " + std::to_string(vertices) +
            " vertices cannot all be corners of " + std::to_string(triangles) + " triangles");
}

} // namespace

HoudiniGeometry shell_geometry(const ShellFile& file)
{
    vdb_shell::require_consistent(file.stack, file.tets);
    require_consistent_core(file.stack, file.tets, file.core);
    vdb_shell::require_consistent(file.input, file.stack.surface(0).size());
    require_readable(file.stack);
    const ShellPoints points = number_points(file.stack, file.tets);
    const std::vector<Part> parts = parts_of(file);
    HoudiniGeometry geometry;
    add_point_attributes(file.stack, points, file.rest, geometry);
    add_core_attributes(points, file.core_feet, geometry);
    add_point_groups(file.stack, points, geometry);
    add_primitives(file, points, parts, geometry);
    add_primitive_attributes(file, parts, geometry);
    add_primitive_groups(file, parts, geometry);
    add_detail(file, geometry);
    if (!file.core.empty())
        append_core(file, points, geometry);
    if (!file.input.empty())
        append_input_points(file.input, geometry);
    // Last, for they are of all that is there.
    add_digests(geometry);
    return geometry;
}

void write_shell_geometry(const std::filesystem::path& path, const ShellFile& file, OutputSet* with)
{
    write_geometry(path, shell_geometry(file), with);
}

} // namespace vdb_shell::houdini

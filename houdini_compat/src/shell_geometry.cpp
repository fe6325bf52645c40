// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/houdini/shell_geometry.h"

#include "vdb_shell/certify/quality.h"
#include "vdb_shell/houdini/geometry_file.h"

#include "shell_names.h"
#include "write/point_grids.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace vdb_shell::houdini
{
namespace
{

using nlohmann::json;
using openvdb::Vec3d;
using openvdb::Vec3I;
using openvdb::Vec3s;

/// Numbers that mean nothing when they are blended.
constexpr const char* kIndex = "nonarithmetic_integer";
constexpr const char* kOrientationText =
    "polygons clockwise seen from outside; tetrahedra (a,b,c,d) with det(b-a,c-a,d-a) < 0 unless "
    "inverted";

std::int32_t as_int32(std::size_t value)
{
    constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
    return static_cast<std::int32_t>(std::min(value, kMost));
}

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

/// The names of those reasons that occur, in the order of StopReason.
Attribute stop_reasons(const PrismShell& shell, const std::vector<std::uint32_t>& vertex)
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
    return {kStopReason, 1, "", std::move(strings)};
}

void add_points(const PrismShell& shell, const ShellPoints& points, HoudiniGeometry& geometry)
{
    const std::size_t count = points.position.size();
    const auto normals_above = layer_normals(shell.outer, shell.triangles);
    const auto normals_below = layer_normals(shell.inner, shell.triangles);
    const auto is_outer = [&](std::size_t i) { return points.layer[i] == 0; };
    const auto vertex = [&](std::size_t i) { return points.vertex[i]; };
    const auto position = [&](std::size_t i) { return points.position[i]; };
    geometry.points = count;
    geometry.point_attributes = {
        vectors("P", "point", count, position),
        vectors("N", "normal", count,
                [&](std::size_t i) {
                    return (is_outer(i) ? normals_above : normals_below)[vertex(i)];
                }),
        vectors("rest", "", count, position),
        vectors(
            kOpposite, "point", count,
            [&](std::size_t i) { return (is_outer(i) ? shell.inner : shell.outer)[vertex(i)]; }),
        floats("thickness", count, [&](std::size_t i) { return shell.length(vertex(i)); }),
        floats("depth", count, [&](std::size_t i) { return is_outer(i) ? 0 : 1; }),
        integers(kSourceVertex, count, 1, [&](std::size_t i, int) { return vertex(i); }),
        stop_reasons(shell, points.vertex)};
    const auto group = [&](const char* name, const auto& belongs) {
        Group made{name, std::vector<bool>(count)};
        for (std::size_t i = 0; i < count; ++i)
            made.members[i] = belongs(i);
        geometry.point_groups.push_back(std::move(made));
    };
    group("outer", is_outer);
    group("inner", [&](std::size_t i) { return !is_outer(i); });
    group("pinned", [&](std::size_t i) { return shell.pinned(vertex(i)); });
}

/// The tets, then the outer triangles, then the inner ones; each in Houdini's orientation.
void add_primitives(const ShellFile& file, const ShellPoints& points, HoudiniGeometry& geometry)
{
    for (const openvdb::Vec4I& t : file.tets.tets) {
        for (const int corner : {0, 1, 3, 2})
            geometry.vertex_point.push_back(points.id_of_tet_point[t[corner]]);
        geometry.primitives.push_back({PrimitiveType::tetrahedron, 4});
    }
    for (const bool inner : {false, true})
        for (const Vec3I& t : file.stack.layers.front().triangles) {
            for (const int corner : {0, 2, 1})
                geometry.vertex_point.push_back(inner ? points.id[1][t[corner]] : t[corner]);
            geometry.primitives.push_back({PrimitiveType::polygon, 3});
        }
}

/// Each tet's mean ratio, and for triangles the worst of their prism's tets; 0 where it has none.
std::vector<float> qualities(const TetMesh& tets, std::size_t prisms)
{
    std::vector<float> quality;
    std::vector<float> worst(prisms, 0.0f);
    std::vector<bool> seen(prisms, false);
    for (std::size_t t = 0; t < tets.tets.size(); ++t) {
        const auto corner = [&](int k) { return Vec3d(tets.points[tets.tets[t][k]]); };
        quality.push_back(
            static_cast<float>(mean_ratio(corner(0), corner(1), corner(2), corner(3))));
        const std::uint32_t prism = tets.prism[t];
        worst[prism] = seen[prism] ? std::min(worst[prism], quality.back()) : quality.back();
        seen[prism] = true;
    }
    for (int side = 0; side < 2; ++side)
        quality.insert(quality.end(), worst.begin(), worst.end());
    return quality;
}

void add_primitive_attributes(const ShellFile& file, HoudiniGeometry& geometry)
{
    const std::size_t tets = file.tets.tets.size(),
                      prisms = file.stack.layers.front().triangles.size();
    const std::size_t count = tets + 2 * prisms;
    const auto prism = [&](std::size_t i) {
        return i < tets ? file.tets.prism[i] : (i - tets) % prisms;
    };
    geometry.primitive_attributes = {
        integers(kPrism, count, 1, [&](std::size_t i, int) { return prism(i); }),
        integers(kLayer, count, 1, [](std::size_t, int) { return 0; }),
        {"quality", 1, "", qualities(file.tets, prisms)},
        integers(kSplitOrder, count, 3, [&](std::size_t i, int k) {
            return file.stack.splits.front().order[prism(i)][static_cast<std::size_t>(k)];
        })};
    const auto group = [&](const char* name, const auto& belongs) {
        Group made{name, std::vector<bool>(count)};
        for (std::size_t i = 0; i < count; ++i)
            made.members[i] = belongs(i);
        geometry.primitive_groups.push_back(std::move(made));
    };
    const auto is_pinned = [&](std::size_t i) {
        const Vec3I& t = file.stack.layers.front().triangles[prism(i)];
        return file.stack.layers.front().pinned(t[0]) && file.stack.layers.front().pinned(t[1]) &&
               file.stack.layers.front().pinned(t[2]);
    };
    group("shell", [&](std::size_t i) { return i < tets; });
    group("outer", [&](std::size_t i) { return i >= tets && i < tets + prisms; });
    group("inner", [&](std::size_t i) { return i >= tets + prisms; });
    group("pinned", is_pinned);
}

void add_text(HoudiniGeometry& geometry, const char* name, const std::string& text)
{
    geometry.detail_attributes.push_back({name, 1, "", Strings{{text}, {0}}});
}

void add_count(HoudiniGeometry& geometry, const char* name, std::size_t count)
{
    geometry.detail_attributes.push_back({name, 1, "", std::vector<std::int32_t>{as_int32(count)}});
}

/// Figures of the report under names of their own, where it has them.
void add_figures(HoudiniGeometry& geometry, const std::string& report_json)
{
    const json report = json::parse(report_json, nullptr, /*allow_exceptions=*/false);
    const auto figure = [&](const char* pointer) -> const json* {
        const json::json_pointer place(pointer);
        return !report.is_discarded() && report.contains(place) ? &report.at(place) : nullptr;
    };
    static constexpr std::array<std::array<const char*, 2>, 7> kReals{
        {{"solid_volume", "/volume/solid"},
         {"shell_volume", "/volume/shell"},
         {"fill", "/volume/fill"},
         {"covered_share", "/coverage/covered_share"},
         {"overlap_share", "/coverage/overlap_share"},
         {"min_quality", "/quality/mean_ratio/min"},
         {"median_quality", "/quality/mean_ratio/median"}}};
    for (const auto& [name, pointer] : kReals)
        if (const json* value = figure(pointer); value && value->is_number())
            geometry.detail_attributes.push_back(
                {name, 1, "", std::vector<double>{value->get<double>()}});
    static constexpr std::array<std::array<const char*, 2>, 3> kCounts{
        {{"pinned_vertices", "/prisms/pinned_vertices"},
         {"inverted_tets", "/tets/inverted"},
         {"certified", "/certificate/certified"}}};
    for (const auto& [name, pointer] : kCounts) {
        const json* value = figure(pointer);
        if (value && value->is_boolean())
            add_count(geometry, name, value->get<bool>() ? 1 : 0);
        else if (value && value->is_number_unsigned())
            add_count(geometry, name, value->get<std::size_t>());
    }
}

void add_detail(const ShellFile& file, HoudiniGeometry& geometry)
{
    add_count(geometry, kSchema, 1);
    add_count(geometry, kVertices, file.stack.layers.front().outer.size());
    add_count(geometry, kPrisms, file.stack.layers.front().triangles.size());
    add_count(geometry, kTets, file.tets.tets.size());
    add_count(geometry, kRipples, file.stack.splits.front().ripples);
    add_text(geometry, kCreator, "vdb_shell " VDB_SHELL_VERSION);
    add_text(geometry, kOrientation, kOrientationText);
    add_text(geometry, kChecksum, checksum_of(file.stack, file.tets));
    add_text(geometry, kParameters, file.parameters_json);
    add_text(geometry, kReport, file.report_json);
    add_figures(geometry, file.report_json);
}

} // namespace

HoudiniGeometry shell_geometry(const ShellFile& file)
{
    vdb_shell::require_consistent(file.stack, file.tets);
    const ShellPoints points = number_points(file.stack, file.tets);
    HoudiniGeometry geometry;
    add_points(file.stack.layers.front(), points, geometry);
    add_primitives(file, points, geometry);
    add_primitive_attributes(file, geometry);
    add_detail(file, geometry);
    return geometry;
}

void write_shell_geometry(const std::filesystem::path& path, const ShellFile& file)
{
    write_geometry(path, shell_geometry(file));
}

ShellFile read_shell_geometry(const std::filesystem::path& path)
{
    return shell_of_geometry(read_geometry(path).geometry, path.string());
}

} // namespace vdb_shell::houdini

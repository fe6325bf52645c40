// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/geometry_file.h"
#include "vdb_shell/houdini/shell_geometry.h"
#include "vdb_shell/shell/tessellate.h"
#include "vdb_shell/write/vdb_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace vdb_shell::test
{

inline constexpr houdini::Format kFormats[] = {houdini::Format::text, houdini::Format::binary,
                                               houdini::Format::compressed};

inline std::string written(const houdini::HoudiniGeometry& geometry, houdini::Format format)
{
    std::ostringstream out;
    houdini::write_geometry(out, geometry, format);
    return out.str();
}

/// A tet, a triangle and a quad over seven points; every storage, class and kind of group, and
/// values that are easily lost.
inline houdini::HoudiniGeometry rich_geometry()
{
    using namespace houdini;
    HoudiniGeometry g;
    g.points = 7;
    g.vertex_point = {0, 1, 3, 2, 4, 6, 5, 0, 4, 5, 1};
    g.primitives = {
        {PrimitiveType::tetrahedron, 4}, {PrimitiveType::polygon, 3}, {PrimitiveType::polygon, 4}};
    g.point_attributes = {
        {"P", 3, "point",
         std::vector<float>{0, 0,     0, 1,    0, 0, 0,       1e-42f, 0, 0,       0,
                            1, -0.0f, 2, 0.1f, 1, 2, 3.4e38f, 1,      2, 16777216}},
        {"id64", 1, "nonarithmetic_integer",
         std::vector<std::int64_t>{INT64_MIN, -1, 0, 1, 127, 128, INT64_MAX}},
        {"name", 1, "", Strings{{"a", "\xc3\xa4 \"\\\n"}, {0, 1, -1, 0, 0, 1, -1}}}};
    std::vector<double> uv(22, 1.0 / 3.0);
    uv[21] = -0.0;
    g.vertex_attributes = {{"uv", 2, "vector", uv}};
    g.primitive_attributes = {
        {"pair", 2, "", std::vector<std::int32_t>{INT32_MIN, -129, -32769, 255, 65536, INT32_MAX}}};
    g.detail_attributes = {{"said", 2, "", Strings{{std::string(300, 'x'), ""}, {0, 1}}},
                           {"figure", 1, "", std::vector<double>{1e300}}};
    g.point_groups = {{"all", std::vector<bool>(7, true)}};
    g.vertex_groups = {
        {"some", {false, true, true, false, true, false, false, false, false, true, true}}};
    g.primitive_groups = {{"none", std::vector<bool>(3, false)}, {"tet", {true, false, false}}};
    return g;
}

template <typename T> bool same_values(const std::vector<T>& a, const std::vector<T>& b)
{
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool same_values(const houdini::Strings& a, const houdini::Strings& b)
{
    return a.table == b.table && a.index == b.index;
}

inline bool same_attributes(const std::vector<houdini::Attribute>& a,
                            const std::vector<houdini::Attribute>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        return x.name == y.name && x.size == y.size && x.meaning == y.meaning &&
               x.values.index() == y.values.index() &&
               std::visit(
                   [&](const auto& values) {
                       return same_values(values,
                                          std::get<std::decay_t<decltype(values)>>(y.values));
                   },
                   x.values);
    });
}

inline bool same_groups(const std::vector<houdini::Group>& a, const std::vector<houdini::Group>& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
        return x.name == y.name && x.members == y.members;
    });
}

/// Bit for bit.
inline bool same_geometry(const houdini::HoudiniGeometry& a, const houdini::HoudiniGeometry& b)
{
    const auto same_primitive = [](const houdini::Primitive& x, const houdini::Primitive& y) {
        return x.type == y.type && x.vertices == y.vertices;
    };
    return a.points == b.points && a.vertex_point == b.vertex_point &&
           std::equal(a.primitives.begin(), a.primitives.end(), b.primitives.begin(),
                      b.primitives.end(), same_primitive) &&
           same_attributes(a.vertex_attributes, b.vertex_attributes) &&
           same_attributes(a.point_attributes, b.point_attributes) &&
           same_attributes(a.primitive_attributes, b.primitive_attributes) &&
           same_attributes(a.detail_attributes, b.detail_attributes) &&
           same_groups(a.vertex_groups, b.vertex_groups) &&
           same_groups(a.point_groups, b.point_groups) &&
           same_groups(a.primitive_groups, b.primitive_groups);
}

/// A shell whose inner surface is the outer one scaled about the origin; pinned vertices stay.
inline ShellFile scaled_shell_file(const TriangleMesh& surface, float scale,
                                   const std::set<std::uint32_t>& pinned = {})
{
    PrismShell shell{surface.points, surface.points, surface.triangles, {}};
    for (std::uint32_t v = 0; v < surface.points.size(); ++v) {
        const bool stays = pinned.count(v) > 0;
        if (!stays)
            shell.inner[v] *= scale;
        shell.stop.push_back(stays ? StopReason::pinned : StopReason::thickness);
    }
    PrismSplit split = split_prisms(shell, {SplitRule::vertex_index, 1});
    split.ripples = 5;
    ShellFile file;
    file.stack = one_layer(std::move(shell), std::move(split));
    file.tets = make_tets(file.stack);
    file.parameters_json = "{\"a\": 1}";
    file.report_json = "{\"volume\": {\"fill\": 0.25}, \"certificate\": {\"certified\": true}, "
                       "\"prisms\": {\"pinned_vertices\": 3}}";
    return file;
}

/// Surfaces that are `surface` scaled about the origin by each of `scales`, from the outermost on;
/// vertices of `pinned` stay in the innermost layers, from `pinned_from` on. Each layer is split in
/// a way of its own.
inline ShellFile layered_shell_file(const TriangleMesh& surface, const std::vector<float>& scales,
                                    std::size_t skin, const std::set<std::uint32_t>& pinned = {},
                                    std::size_t pinned_from = 0)
{
    ShellFile file;
    file.stack.skin = skin;
    std::vector<openvdb::Vec3s> above = surface.points;
    for (openvdb::Vec3s& p : above)
        p *= scales[0];
    for (std::size_t k = 0; k + 1 < scales.size(); ++k) {
        PrismShell layer{above, above, surface.triangles, {}};
        for (std::uint32_t v = 0; v < surface.points.size(); ++v) {
            if (k < pinned_from || pinned.count(v) == 0)
                layer.inner[v] = surface.points[v] * scales[k + 1];
            layer.stop.push_back(StopReason((v + (k < skin ? 1 : 0)) % kStopReasonCount));
        }
        above = layer.inner;
        const bool even = k % 2 == 0;
        file.stack.splits.push_back(split_prisms(
            layer, {even ? SplitRule::vertex_index : SplitRule::length_descending, 1}));
        file.stack.layers.push_back(std::move(layer));
    }
    file.stack.splits.front().ripples = 3;
    file.tets = make_tets(file.stack);
    file.parameters_json = "{\"a\": 1}";
    file.report_json = "{\"volume\": {\"fill\": 0.25}}";
    return file;
}

template <typename T>
const std::vector<T>& held(const std::vector<houdini::Attribute>& list, const char* name)
{
    return std::get<std::vector<T>>(houdini::find(list, name)->values);
}

template <typename T>
std::vector<T>& values_of(std::vector<houdini::Attribute>& list, const char* name)
{
    const houdini::Attribute* found = houdini::find(list, name);
    return std::get<std::vector<T>>(list[static_cast<std::size_t>(found - list.data())].values);
}

/// What reading says of the shell's geometry, as x.geo, after change(geometry).
template <typename Change>
std::string refusal_of_changed(const ShellFile& shell, const Change& change)
{
    houdini::HoudiniGeometry g = houdini::shell_geometry(shell);
    change(g);
    try {
        houdini::shell_of_geometry(g, "x.geo");
    } catch (const ReadError& error) {
        return error.what();
    }
    return "it was read";
}

/// A refusal that names the file and has those words.
inline void has(const std::string& message, const std::string& words)
{
    EXPECT_EQ(message.rfind("x.geo: ", 0), 0u) << message;
    EXPECT_NE(message.find(words), std::string::npos) << '"' << words << "\": " << message;
}

} // namespace vdb_shell::test

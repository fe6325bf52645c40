// SPDX-License-Identifier: Apache-2.0
#include "vdb_shell/core/error.h"
#include "vdb_shell/houdini/shell_geometry.h"

#include "mesh/scan_text.h"
#include "shell_names.h"
#include "write/point_grids.h"

#include <limits>
#include <map>

namespace vdb_shell::houdini
{
namespace
{

using openvdb::Vec3I;
using openvdb::Vec3s;

/// The attributes of one class, by the types that a shell has.
class Columns
{
public:
    Columns(const std::vector<Attribute>& attributes, const char* kind, const std::string& name)
        : attributes_(attributes), kind_(kind), name_(name)
    {
    }
    template <typename T> const T& get(const char* attribute, int size) const
    {
        const Attribute* found = find(attributes_, attribute);
        if (!found)
            fail(attribute, "is missing");
        const T* values = std::get_if<T>(&found->values);
        if (!values || found->size != size)
            fail(attribute,
                 "is not of the type or the size " + std::to_string(size) + " that a shell has");
        return *values;
    }
    const std::vector<std::int32_t>& integers(const char* attribute, int size = 1) const
    {
        return get<std::vector<std::int32_t>>(attribute, size);
    }
    std::vector<Vec3s> vectors(const char* attribute) const
    {
        const auto& values = get<std::vector<float>>(attribute, 3);
        std::vector<Vec3s> made;
        made.reserve(values.size() / 3);
        for (std::size_t i = 0; i < values.size(); i += 3)
            made.emplace_back(values[i], values[i + 1], values[i + 2]);
        return made;
    }
    const std::string& text(const char* attribute) const
    {
        return get<Strings>(attribute, 1).at(0);
    }
    std::size_t count(const char* attribute, std::size_t limit) const
    {
        const std::int32_t value = integers(attribute)[0];
        if (value < 0 || static_cast<std::size_t>(value) > limit)
            fail(attribute, "is " + std::to_string(value) + ", which is not in [0, " +
                                std::to_string(limit) + "]");
        return static_cast<std::size_t>(value);
    }
    [[noreturn]] void fail(const char* attribute, const std::string& what) const
    {
        refuse(name_, std::string(kind_) + " \"" + attribute + "\" " + what);
    }

private:
    const std::vector<Attribute>& attributes_;
    const char* kind_;
    const std::string& name_;
};

struct Counts {
    std::size_t vertices = 0, prisms = 0, tets = 0;
};

Counts read_counts(const HoudiniGeometry& geometry, const Columns& detail, const std::string& name)
{
    const std::int32_t schema = detail.integers(kSchema)[0];
    if (schema < 1 || schema > kShellSchema)
        detail.fail(kSchema, "is " + std::to_string(schema) + ", schemas 1 to " +
                                 std::to_string(kShellSchema) + " can be read");
    Counts counts;
    counts.vertices = detail.count(kVertices, geometry.points);
    counts.prisms = detail.count(kPrisms, geometry.primitives.size());
    counts.tets = detail.count(kTets, geometry.primitives.size());
    if (counts.tets + 2 * counts.prisms != geometry.primitives.size())
        refuse(name, "it has " + std::to_string(geometry.primitives.size()) + " primitives, but " +
                         std::to_string(counts.tets) + " tets and " +
                         std::to_string(counts.prisms) + " prisms make " +
                         std::to_string(counts.tets + 2 * counts.prisms));
    for (std::size_t i = 0; i < geometry.primitives.size(); ++i) {
        const bool tet = i < counts.tets;
        const Primitive& found = geometry.primitives[i];
        if ((found.type == PrimitiveType::tetrahedron) != tet || found.vertices != (tet ? 4u : 3u))
            refuse(name, "primitive " + std::to_string(i) + " is no " +
                             (tet ? "tetrahedron" : "triangle"));
    }
    return counts;
}

std::vector<StopReason> read_stops(const Columns& points, std::size_t vertices)
{
    std::map<std::string, StopReason> by_name;
    for (int i = 0; i < kStopReasonCount; ++i)
        by_name.emplace(name_of(static_cast<StopReason>(i)), static_cast<StopReason>(i));
    const auto& strings = points.get<Strings>(kStopReason, 1);
    std::vector<StopReason> stops;
    for (std::size_t v = 0; v < vertices; ++v) {
        const auto found = by_name.find(strings.at(v));
        if (found == by_name.end())
            points.fail(kStopReason, "of point " + std::to_string(v) + " is " +
                                         vdb_shell::quoted(strings.at(v)) +
                                         ", which is no stop reason");
        stops.push_back(found->second);
    }
    return stops;
}

/// The two ends of every pillar; returns per vertex the point of the lower one.
std::vector<std::uint32_t> read_pillars(const HoudiniGeometry& geometry, const Columns& points,
                                        std::size_t vertices, PrismShell& shell)
{
    const auto& source = points.integers(kSourceVertex);
    const std::vector<Vec3s> position = points.vectors("P");
    const auto end = static_cast<std::ptrdiff_t>(vertices);
    shell.outer.assign(position.begin(), position.begin() + end);
    shell.inner = points.vectors(kOpposite);
    shell.inner.resize(vertices);
    shell.stop = read_stops(points, vertices);
    std::vector<std::uint32_t> below;
    for (std::uint32_t v = 0; v < vertices; ++v)
        below.push_back(v);
    for (std::size_t i = 0; i < geometry.points; ++i) {
        const auto vertex = static_cast<std::size_t>(source[i]);
        if (source[i] < 0 || vertex >= vertices || (i < vertices && vertex != i))
            points.fail(kSourceVertex, "of point " + std::to_string(i) + " is " +
                                           std::to_string(source[i]) + " of " +
                                           std::to_string(vertices));
        if (i < vertices)
            continue;
        if (below[vertex] != vertex || shell.pinned(vertex) ||
            !same_bits(position[i], shell.inner[vertex]))
            points.fail("P", "of point " + std::to_string(i) +
                                 " is not the one lower end of the pillar at vertex " +
                                 std::to_string(vertex));
        below[vertex] = static_cast<std::uint32_t>(i);
    }
    for (std::uint32_t v = 0; v < vertices; ++v)
        if (below[v] == v && !shell.pinned(v))
            points.fail(kSourceVertex,
                        "names no lower end of the pillar at vertex " + std::to_string(v));
    return below;
}

/// The outer triangles, and the inner ones held against them.
void read_triangles(const HoudiniGeometry& geometry, const Counts& counts,
                    const std::vector<std::uint32_t>& below, const std::string& name,
                    PrismShell& shell)
{
    const std::size_t outer = 4 * counts.tets, inner = outer + 3 * counts.prisms;
    const auto corner = [&](std::size_t first, std::size_t p, int k) {
        constexpr int kTurned[] = {0, 2, 1};
        return geometry.vertex_point[first + 3 * p + static_cast<std::size_t>(kTurned[k])];
    };
    for (std::size_t p = 0; p < counts.prisms; ++p) {
        Vec3I triangle;
        for (int k = 0; k < 3; ++k) {
            triangle[k] = corner(outer, p, k);
            if (triangle[k] >= counts.vertices || corner(inner, p, k) != below[triangle[k]])
                refuse(name, "prism " + std::to_string(p) + ": point " +
                                 std::to_string(corner(inner, p, k)) + " is not below point " +
                                 std::to_string(triangle[k]));
        }
        shell.triangles.push_back(triangle);
    }
}

void read_split(const Columns& primitives, const Counts& counts, ShellFile& file)
{
    const auto& prism = primitives.integers(kPrism);
    const auto& order = primitives.integers(kSplitOrder, 3);
    file.stack.splits.front().order.resize(counts.prisms);
    for (std::size_t p = 0; p < counts.prisms; ++p)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int32_t value = order[3 * (counts.tets + p) + k];
            if (value < 0 || value > 2)
                primitives.fail(kSplitOrder, "of primitive " + std::to_string(counts.tets + p) +
                                                 " has " + std::to_string(value) +
                                                 ", which is not in [0, 2]");
            file.stack.splits.front().order[p][k] = static_cast<std::uint8_t>(value);
        }
    for (std::size_t i = 0; i < prism.size(); ++i) {
        const bool tet = i < counts.tets;
        const std::size_t expected = tet ? 0 : (i - counts.tets) % counts.prisms;
        const bool fits = prism[i] >= 0 && static_cast<std::size_t>(prism[i]) < counts.prisms &&
                          (tet || static_cast<std::size_t>(prism[i]) == expected);
        if (!fits)
            primitives.fail(kPrism, "of primitive " + std::to_string(i) + " is " +
                                        std::to_string(prism[i]) + " of " +
                                        std::to_string(counts.prisms));
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint8_t expected_order =
                file.stack.splits.front().order[static_cast<std::size_t>(prism[i])][k];
            if (order[3 * i + k] != expected_order)
                primitives.fail(kSplitOrder, "of primitive " + std::to_string(i) + " has " +
                                                 std::to_string(order[3 * i + k]) +
                                                 " where its prism has " +
                                                 std::to_string(expected_order));
        }
        if (tet)
            file.tets.prism.push_back(static_cast<std::uint32_t>(prism[i]));
    }
}

/// The tets number those points that they use, in the same order.
void read_tets(const HoudiniGeometry& geometry, const Columns& points, const Counts& counts,
               TetMesh& tets)
{
    const auto& source = points.integers(kSourceVertex);
    const std::vector<Vec3s> position = points.vectors("P");
    std::vector<std::uint32_t> number(geometry.points, 0);
    for (std::size_t k = 0; k < 4 * counts.tets; ++k)
        number[geometry.vertex_point[k]] = 1;
    for (std::size_t i = 0; i < geometry.points; ++i) {
        if (number[i] == 0)
            continue;
        number[i] = static_cast<std::uint32_t>(tets.points.size());
        tets.points.push_back(position[i]);
        tets.source_vertex.push_back(static_cast<std::uint32_t>(source[i]));
        tets.layer.push_back(i < counts.vertices ? 0 : 1);
    }
    for (std::size_t t = 0; t < counts.tets; ++t) {
        const auto corner = [&](std::size_t k) { return number[geometry.vertex_point[4 * t + k]]; };
        tets.tets.emplace_back(corner(0), corner(1), corner(3), corner(2));
    }
}

} // namespace

bool is_shell(const HoudiniGeometry& geometry)
{
    return find(geometry.detail_attributes, kSchema) != nullptr;
}

ShellFile shell_of_geometry(const HoudiniGeometry& geometry, const std::string& name)
{
    if (!is_shell(geometry))
        refuse(name,
               std::string("it holds no shell: detail attribute \"") + kSchema + "\" is missing");
    const Columns detail(geometry.detail_attributes, "detail attribute", name);
    const Columns points(geometry.point_attributes, "point attribute", name);
    const Columns primitives(geometry.primitive_attributes, "primitive attribute", name);
    const Counts counts = read_counts(geometry, detail, name);
    ShellFile file;
    file.stack = one_layer({}, {});
    const auto below = read_pillars(geometry, points, counts.vertices, file.stack.layers.front());
    read_triangles(geometry, counts, below, name, file.stack.layers.front());
    read_split(primitives, counts, file);
    read_tets(geometry, points, counts, file.tets);
    file.tets.prism_layer.assign(counts.tets, 0);
    file.stack.splits.front().ripples =
        detail.count(kRipples, std::numeric_limits<std::int32_t>::max());
    file.parameters_json = detail.text(kParameters);
    file.report_json = detail.text(kReport);
    try {
        vdb_shell::require_consistent(file.stack, file.tets);
    } catch (const InvalidOption& error) {
        refuse(name, std::string("its parts do not fit together: ") + error.what());
    }
    const std::string found = checksum_of(file.stack, file.tets);
    if (found != detail.text(kChecksum))
        refuse(name, "the shell's arrays have checksum " + found + ", the file says " +
                         detail.text(kChecksum));
    return file;
}

} // namespace vdb_shell::houdini

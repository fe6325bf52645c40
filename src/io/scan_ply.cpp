// SPDX-License-Identifier: Apache-2.0

// Scans PLY, in text and binary: elements and properties in any order, as the header declares them.
// What is not part of the surface is stepped over value by value, since lists have no fixed size.
// Faces may stand before the vertices that they name, so their corners are tested against the
// number that the header declares; that many vertices are then read or the file is refused. Text
// coordinates go to float32 directly, binary ones from their exact double.

#include "io/file_scan.h"
#include "io/ply_values.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell
{
namespace
{

// The format is that of Greg Turk, "The PLY Polygon File Format", 1994. "tristrips" come from the
// Stanford scanning repository, whose larger models have no "face" element.

struct PlyScan {
    const std::string& name;
    const PlyHeader& header;
    Coordinates& coordinates;
    PlyValues values;
    FileScan scan;
    std::size_t strips = 0; ///< so far, counted over all restarts
    Polygon polygon;        ///< of the current face; a member so that its memory is used again
    TextureScan* texture = nullptr;
    std::vector<openvdb::Vec2d> of_vertex; ///< texture coordinates by vertex, or empty
    std::vector<double> of_face;           ///< of the current face, two numbers a corner, or empty
};

/// Values that are not wanted are stepped over one by one: only then is it known where the next
/// element begins.
void skip_property(PlyScan& ply, const PlyProperty& property, const Place& place)
{
    for (std::size_t n = property.is_list ? ply.values.list_size(property, place) : 1; n > 0; --n)
        ply.values.next(property.type, place);
}

void skip_element(PlyScan& ply, const PlyElement& element)
{
    for (std::size_t i = 0; i < element.count; ++i)
        for (const PlyProperty& property : element.properties)
            skip_property(ply, property, {"element", i, 0});
}

/// Text goes straight to float32, because by way of double it would be rounded twice.
float coordinate(PlyScan& ply, const PlyProperty& property, const Place& place, int axis)
{
    const PlyValue value = ply.values.next(property.type, place);
    return ply.header.is_text()
               ? ply.coordinates.from_text(ply.name, ply.values.here(place), value.word, axis)
               : ply.coordinates.from_number(ply.name, place, value.number, axis);
}

std::int64_t whole_number(const PlyScan& ply, const PlyValue& value, const Place& place)
{
    if (ply.header.is_text())
        return parse_integer(ply.name, place, value.word);
    // The corners may be stored as floats.
    // A double holds whole numbers exactly far beyond 1e15, and an index needs less than that.
    if (value.number != std::floor(value.number) || std::abs(value.number) > 1e15)
        refuse(ply.name, place.text() + ": the vertex index " + std::to_string(value.number) +
                             " is not a whole number");
    return static_cast<std::int64_t>(value.number);
}

/// 0 for the first texture coordinate, 1 for the second, by the names that programs write; 2 for
/// what is none.
std::size_t texture_axis(const PlyProperty& property)
{
    for (const std::string_view first : {"u", "s", "texture_u", "texture_s"})
        if (!property.is_list && property.name == first)
            return 0;
    for (const std::string_view second : {"v", "t", "texture_v", "texture_t"})
        if (!property.is_list && property.name == second)
            return 1;
    return 2;
}

double texture_number(PlyScan& ply, const PlyProperty& property, const Place& place)
{
    const PlyValue value = ply.values.next(property.type, place);
    return ply.header.is_text() ? parse_coordinate(ply.name, ply.values.here(place), value.word)
                                : checked_coordinate(ply.name, place, value.number);
}

/// Whether vertices have both texture coordinates, and they are wanted.
bool has_vertex_texture(const PlyScan& ply, const PlyElement& element)
{
    bool has[3] = {};
    for (const PlyProperty& property : element.properties)
        has[texture_axis(property)] = true;
    return ply.texture && has[0] && has[1];
}

void read_vertices(PlyScan& ply, const PlyElement& element)
{
    const bool textured = has_vertex_texture(ply, element);
    // Which coordinate each property is, found once instead of for every vertex.
    constexpr std::string_view kAxes = "xyz";
    std::vector<std::size_t> axes;
    const PlyProperty* id = nullptr;
    for (const PlyProperty& property : element.properties) {
        axes.push_back(property.is_list || property.name.size() != 1 ? kAxes.npos
                                                                     : kAxes.find(property.name));
        // An id is a whole number; a float of that name is something else, and is stepped over.
        const bool real = property.type == PlyType::float32 || property.type == PlyType::float64;
        if (property.name == "id" && !property.is_list && !real)
            id = &property;
    }
    ply.scan.points.reserve(element.count);
    for (std::size_t v = 0; v < element.count; ++v) {
        const Place place{"vertex", v, 0};
        openvdb::Vec3s point;
        if (textured)
            ply.of_vertex.emplace_back(0.0);
        for (std::size_t k = 0; k < axes.size(); ++k) {
            const PlyProperty& property = element.properties[k];
            if (&property == id) {
                ply.scan.ids.push_back(
                    whole_number(ply, ply.values.next(id->type, place), ply.values.here(place)));
                continue;
            }
            if (const std::size_t axis = textured ? texture_axis(property) : 2; axis < 2) {
                ply.of_vertex.back()[static_cast<int>(axis)] = texture_number(ply, property, place);
                continue;
            }
            if (axes[k] == kAxes.npos) {
                skip_property(ply, property, place);
                continue;
            }
            const int axis = static_cast<int>(axes[k]);
            point[axis] = coordinate(ply, property, place, axis);
        }
        ply.scan.points.push_back(point);
    }
}

std::uint32_t checked_corner(const PlyScan& ply, std::int64_t index, const Place& place)
{
    require_corner(ply.name, place, index, ply.scan.file_vertices, std::to_string(index));
    return static_cast<std::uint32_t>(index);
}

void require_three(const PlyScan& ply, std::size_t corners, const Place& place)
{
    if (corners < 3)
        refuse(ply.name, place.text() + " has " + std::to_string(corners) +
                             " corners where at least 3 are needed");
}

void read_face(PlyScan& ply, const PlyProperty& list)
{
    const Place place{"face", ply.scan.file_faces, 0};
    const std::size_t count = ply.values.list_size(list, place);
    require_three(ply, count, ply.values.here(place));
    ply.polygon.clear();
    for (std::size_t k = 0; k < count; ++k) {
        const PlyValue value = ply.values.next(list.type, place);
        const Place here = ply.values.here(place);
        ply.polygon.push_back(checked_corner(ply, whole_number(ply, value, here), here));
    }
}

/// Two numbers for each corner: a list "texcoord", as MeshLab writes it.
void read_face_texture(PlyScan& ply, const PlyProperty& list)
{
    const Place place{"face", ply.scan.file_faces, 0};
    ply.of_face.resize(ply.values.list_size(list, place));
    for (double& number : ply.of_face)
        number = texture_number(ply, list, place);
}

/// Of the face that is about to be added. A face's own coordinates come before those of vertices.
void add_texture(PlyScan& ply)
{
    TextureScan& texture = *ply.texture;
    texture.face_sizes.push_back(static_cast<std::uint32_t>(ply.polygon.size()));
    const bool own = !ply.of_face.empty();
    if (own && ply.of_face.size() != 2 * ply.polygon.size())
        refuse(ply.name, Place{"face", ply.scan.file_faces, 0}.text() + " has " +
                             std::to_string(ply.of_face.size()) +
                             " numbers of texture coordinates for " +
                             std::to_string(ply.polygon.size()) + " corners");
    for (std::size_t k = 0; k < ply.polygon.size(); ++k) {
        const std::uint32_t vertex = ply.polygon[k];
        texture.vertices.push_back(vertex);
        // Vertices without texture coordinates, or faces that stand before their vertices in the
        // file.
        if (!own && vertex >= ply.of_vertex.size()) {
            texture.texture.push_back(TextureScan::kNone);
            continue;
        }
        texture.texture.push_back(static_cast<std::uint32_t>(texture.values.size()));
        texture.values.push_back(own ? openvdb::Vec2d(ply.of_face[2 * k], ply.of_face[2 * k + 1])
                                     : ply.of_vertex[vertex]);
    }
}

/// Each corner from the third on makes a triangle with the two before it. Every other one of them
/// runs the other way round, and is turned so that all are seen from the same side.
void add_strip(PlyScan& ply, const std::vector<std::uint32_t>& strip, const Place& place)
{
    // Two restarts in a row, or one at the end of the list, as writers put it.
    if (strip.empty())
        return;
    require_three(ply, strip.size(), place);
    for (std::size_t k = 0; k + 2 < strip.size(); ++k) {
        const std::size_t turned = k % 2;
        ply.polygon = {strip[k + turned], strip[k + 1 - turned], strip[k + 2]};
        if (ply.texture)
            add_texture(ply);
        add_face(ply.scan, ply.polygon);
    }
    ++ply.strips;
}

/// A list of strips, each ended by -1 or by the end of the list.
void read_strips(PlyScan& ply, const PlyProperty& list)
{
    constexpr std::int64_t kRestart = -1;
    const std::size_t count = ply.values.list_size(list, {"triangle strip", ply.strips});
    std::vector<std::uint32_t> strip;
    for (std::size_t k = 0; k < count; ++k) {
        const Place place{"triangle strip", ply.strips};
        const PlyValue value = ply.values.next(list.type, place);
        const Place here = ply.values.here(place);
        const std::int64_t index = whole_number(ply, value, here);
        if (index != kRestart) {
            strip.push_back(checked_corner(ply, index, here));
            continue;
        }
        add_strip(ply, strip, here);
        strip.clear();
    }
    add_strip(ply, strip, ply.values.here({"triangle strip", ply.strips}));
}

void read_polygons(PlyScan& ply, const PlyElement& element)
{
    const bool strips = element.name == "tristrips";
    for (std::size_t i = 0; i < element.count; ++i) {
        const Place place{strips ? "triangle strip" : "face",
                          strips ? ply.strips : ply.scan.file_faces};
        ply.of_face.clear();
        for (const PlyProperty& property : element.properties) {
            if (ply.texture && !strips && property.is_list && property.name == "texcoord")
                read_face_texture(ply, property);
            else if (!property.holds_corners())
                skip_property(ply, property, place);
            else if (strips)
                read_strips(ply, property);
            else
                read_face(ply, property);
        }
        // The face is added only now, because other properties of it may follow its corners.
        if (strips)
            continue;
        if (ply.texture)
            add_texture(ply);
        add_face(ply.scan, ply.polygon);
    }
}

/// Memory is taken by the number of elements, so the rest of the file must be able to hold them.
void require_element(const PlyScan& ply, const PlyElement& element)
{
    const std::size_t least = element.least_size(ply.header.is_text());
    // One more than fits, because the last value of a text needs no blank behind it. This only
    // bounds the memory; that all values are there is tested at each of them.
    if (least > 0 && element.count > ply.values.bytes_left() / least + 1)
        refuse(ply.name, "the header declares " + std::to_string(element.count) + " \"" +
                             element.name + "\" elements of at least " + std::to_string(least) +
                             " bytes, but only " + std::to_string(ply.values.bytes_left()) +
                             " bytes of data are left");
}

void read_elements(PlyScan& ply)
{
    for (const PlyElement& element : ply.header.elements) {
        require_element(ply, element);
        if (element.properties.empty()) // it has no data, however many it declares
            continue;
        if (element.name == "vertex")
            read_vertices(ply, element);
        else if (element.name == "face" || element.name == "tristrips")
            read_polygons(ply, element);
        else
            skip_element(ply, element);
    }
    if (!ply.values.only_blanks_left())
        refuse(ply.name, "data goes on after the last element that the header declares");
}

} // namespace

FileScan scan_ply(const std::string& name, std::string_view bytes, Coordinates& coordinates)
{
    return scan_ply(name, bytes, coordinates, nullptr);
}

FileScan scan_ply(const std::string& name, std::string_view bytes, Coordinates& coordinates,
                  TextureScan* texture)
{
    const std::string_view data = without_byte_order_mark(bytes);
    const PlyHeader header = parse_ply_header(name, data);
    PlyScan ply{name,    header, coordinates, PlyValues(name, header, data), {}, 0, {},
                texture, {},     {}};
    ply.scan.format = header.is_text() ? "PLY (ASCII)" : "PLY (binary)";
    // Faces may stand before the vertices that they name.
    for (const PlyElement& element : header.elements)
        if (element.name == "vertex")
            ply.scan.file_vertices = element.count;
    read_elements(ply);
    return std::move(ply.scan);
}

} // namespace vdb_shell

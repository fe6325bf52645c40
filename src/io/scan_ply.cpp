// SPDX-License-Identifier: Apache-2.0
#include "io/file_scan.h"
#include "io/ply_values.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vdb_shell
{
namespace
{

// OpenMesh's PLY reader takes a list that it does not know for one value, drops properties that
// stand before the corners of a face, and does not know every type of list. It is given the three
// coordinates and the corners only, in the file's precision.

struct PlyScan {
    const std::string& name;
    const PlyHeader& header;
    Coordinates& coordinates;
    FileScan scan;
    bool single = false;         ///< all coordinates are float32
    std::string vertices, faces; ///< bodies of the stream
};

void skip_property(PlyValues& values, const PlyProperty& property, const Place& place)
{
    for (std::size_t n = property.is_list ? values.list_size(property, place) : 1; n > 0; --n)
        values.next(property.type, place);
}

void read_vertex(PlyScan& ply, PlyValues& values, const PlyElement& element)
{
    const Place place{"vertex", ply.scan.points.size(), 0};
    static constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};
    openvdb::Vec3s point;
    std::array<PlyValue, 3> found;
    for (const PlyProperty& property : element.properties) {
        const auto axis = std::find(kAxes.begin(), kAxes.end(), property.name) - kAxes.begin();
        if (axis == 3 || property.is_list) {
            skip_property(values, property, place);
            continue;
        }
        const PlyValue value = values.next(property.type, place);
        const int k = static_cast<int>(axis);
        point[k] = ply.header.is_text()
                       ? ply.coordinates.from_text(ply.name, values.here(place), value.word, k)
                       : ply.coordinates.from_number(ply.name, place, value.number, k);
        found[static_cast<std::size_t>(axis)] = value;
    }
    for (int k = 0; k < 3; ++k) {
        const PlyValue& value = found[static_cast<std::size_t>(k)];
        if (ply.header.is_text()) {
            ply.coordinates.pass_on(ply.vertices, value.word, point[k]);
            ply.vertices += ' ';
        } else if (ply.single) {
            append_bytes(ply.vertices, point[k]);
        } else {
            append_bytes(ply.vertices, value.number);
        }
    }
    if (ply.header.is_text())
        ply.vertices.back() = '\n';
    ply.scan.points.push_back(point);
}

std::int64_t whole_number(const PlyScan& ply, const PlyValue& value, const Place& place)
{
    if (ply.header.is_text())
        return parse_integer(ply.name, place, value.word);
    if (value.number != std::floor(value.number) || std::abs(value.number) > 1e15)
        refuse(ply.name, place.text() + ": the vertex index " + std::to_string(value.number) +
                             " is not a whole number");
    return static_cast<std::int64_t>(value.number);
}

void pass_face_on(PlyScan& ply, const Corners& corners)
{
    if (ply.header.is_text())
        ply.faces += std::to_string(corners.size());
    else
        append_bytes(ply.faces, static_cast<std::int32_t>(corners.size()));
    for (const std::uint32_t corner : corners) {
        if (ply.header.is_text())
            ply.faces += ' ' + std::to_string(corner);
        else
            append_bytes(ply.faces, static_cast<std::int32_t>(corner));
    }
    if (ply.header.is_text())
        ply.faces += '\n';
}

void read_face(PlyScan& ply, PlyValues& values, const PlyElement& element)
{
    const Place place{"face", ply.scan.file_faces, 0};
    Corners corners;
    for (const PlyProperty& property : element.properties) {
        if (!property.holds_corners()) {
            skip_property(values, property, place);
            continue;
        }
        const std::size_t count = values.list_size(property, place);
        if (count < 3)
            refuse(ply.name, values.here(place).text() + " has " + std::to_string(count) +
                                 " corners where at least 3 are needed");
        for (std::size_t k = 0; k < count; ++k) {
            const PlyValue value = values.next(property.type, place);
            const Place here = values.here(place);
            const std::int64_t index = whole_number(ply, value, here);
            require_corner(ply.name, here, index, ply.scan.file_vertices, std::to_string(index));
            corners.push_back(static_cast<std::uint32_t>(index));
        }
    }
    if (count_face(ply.scan, corners))
        pass_face_on(ply, corners);
}

void require_element(const PlyScan& ply, const PlyElement& element, const PlyValues& values)
{
    const std::size_t least = element.least_size(ply.header.is_text());
    if (least > 0 && element.count > values.bytes_left() / least + 1)
        refuse(ply.name, "the header declares " + std::to_string(element.count) + " \"" +
                             element.name + "\" elements of at least " + std::to_string(least) +
                             " bytes, but only " + std::to_string(values.bytes_left()) +
                             " bytes of data are left");
}

void read_elements(PlyScan& ply, PlyValues& values)
{
    for (const PlyElement& element : ply.header.elements) {
        require_element(ply, element, values);
        const bool vertices = element.name == "vertex", faces = element.name == "face";
        const std::size_t count = element.properties.empty() ? 0 : element.count;
        for (std::size_t i = 0; i < count; ++i) {
            if (vertices)
                read_vertex(ply, values, element);
            else if (faces)
                read_face(ply, values, element);
            else
                for (const PlyProperty& property : element.properties)
                    skip_property(values, property, {"element", i, 0});
        }
    }
    if (!values.only_blanks_left())
        refuse(ply.name, "data goes on after the last element that the header declares");
}

} // namespace

FileScan scan_ply(const std::string& name, const std::string& bytes, Coordinates& coordinates)
{
    const PlyHeader header = parse_ply_header(name, bytes);
    PlyScan ply{name, header, coordinates, {}, true, {}, {}};
    const bool text = header.is_text();
    ply.scan.format = text ? "PLY (ASCII)" : "PLY (binary)";
    ply.scan.reader = "ply";
    for (const PlyElement& element : header.elements) {
        if (element.name != "vertex")
            continue;
        ply.scan.file_vertices = element.count;
        for (const PlyProperty& property : element.properties)
            if (property.name == "x" || property.name == "y" || property.name == "z")
                ply.single = ply.single && property.type == PlyType::float32;
    }
    ply.single = ply.single || coordinates.placement().moves();
    PlyValues values(name, header, bytes);
    read_elements(ply, values);
    ply.scan.stream = plain_ply_header(text ? "ascii" : "binary_little_endian",
                                       text || ply.single ? "float" : "double",
                                       ply.scan.file_vertices, ply.scan.faces_passed_on()) +
                      ply.vertices + ply.faces;
    return std::move(ply.scan);
}

} // namespace vdb_shell

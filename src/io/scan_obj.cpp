// SPDX-License-Identifier: Apache-2.0

// Scans OBJ ("Object Files (.obj)", appendix B1 of the Advanced Visualizer manual). Only vertices
// and faces are read, and texture coordinates where they are asked for. What else the format has is
// passed over, except what would be a part of the surface: that is refused, because a surface with
// a hole where a line was not understood would look like a sound one. Faces may name vertices that
// come later, so indices above all vertices so far are noted and tested at the end. Trap: negative
// indices count back from where the face stands and can only name what came before.

#include "io/file_scan.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace vdb_shell
{
namespace
{

/// A face that names a vertex before the file has it.
struct EarlyFace {
    Place place;
    std::int64_t largest_index; ///< counted from 0
};

struct ObjScan {
    const std::string& name;
    Coordinates& coordinates;
    FileScan scan;
    std::vector<EarlyFace> early_faces;
    Polygon polygon; ///< of the current face; a member so that its memory is used again
    TextureScan* texture = nullptr;
    std::vector<EarlyFace> early_texture; ///< faces that name texture coordinates of later lines
};

/// What follows the third coordinate is passed over: a weight of rational curves, or a colour.
void read_vertex(ObjScan& obj, std::string_view rest, std::size_t line)
{
    const std::size_t index = obj.scan.file_vertices++;
    const Place vertex{"vertex", index, line};
    openvdb::Vec3s point;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = cut_word(rest);
        if (word.empty())
            refuse(obj.name, vertex.text() + " has " + std::to_string(axis) +
                                 " coordinates where 3 are needed");
        point[axis] = obj.coordinates.from_text(obj.name, vertex, word, axis);
    }
    obj.scan.points.push_back(point);
}

/// One to three numbers, of which the third belongs to volumes of texture.
void read_texture(ObjScan& obj, std::string_view rest, std::size_t line)
{
    const Place place{"texture coordinate", obj.texture->values.size(), line};
    openvdb::Vec2d value(0.0);
    for (int axis = 0; axis < 2; ++axis) {
        const std::string_view word = cut_word(rest);
        if (!word.empty())
            value[axis] = parse_coordinate(obj.name, place, word);
        else if (axis == 0)
            refuse(obj.name, place.text() + " has no number");
    }
    obj.texture->values.push_back(value);
}

/// What stands between the slashes of a corner; `latest` rises to the greatest number that is
/// named, which may be one of a later line.
void read_corner_texture(ObjScan& obj, const Place& face, std::string_view corner,
                         std::uint32_t vertex, std::int64_t& latest)
{
    TextureScan& texture = *obj.texture;
    texture.vertices.push_back(vertex);
    texture.texture.push_back(TextureScan::kNone);
    const std::size_t slash = corner.find('/');
    if (slash == corner.npos)
        return;
    const std::string_view rest = corner.substr(slash + 1), word = rest.substr(0, rest.find('/'));
    if (word.empty())
        return;
    const auto known = static_cast<std::int64_t>(texture.values.size());
    const std::int64_t given = parse_integer(obj.name, face, word);
    const std::int64_t index = given < 0 ? known + given : given - 1;
    if (index < 0 || index >= INT32_MAX)
        refuse(obj.name, face.text() + ": there is no texture coordinate " + std::to_string(given));
    texture.texture.back() = static_cast<std::uint32_t>(index);
    latest = std::max(latest, index);
}

/// Corners are "vertex", "vertex/texture" or "vertex/texture/normal"; only the vertex is read, and
/// the texture where it is asked for. Negative indices count back from the last vertex so far.
void read_face(ObjScan& obj, std::string_view rest, std::size_t line)
{
    const Place face{"face", obj.scan.file_faces, line};
    const auto vertices = static_cast<std::int64_t>(obj.scan.file_vertices);
    std::int64_t largest = -1, latest_texture = -1;
    obj.polygon.clear();
    for (std::string_view word = cut_word(rest); !word.empty(); word = cut_word(rest)) {
        const std::string_view vertex = word.substr(0, word.find('/'));
        const std::int64_t given = parse_integer(obj.name, face, vertex);
        // Indices count from 1. A given 0 becomes -1 here and is refused like all that is out of
        // range.
        const std::int64_t index = given < 0 ? vertices + given : given - 1;
        // An index above all vertices so far may name one that comes later.
        if (index < 0 || index > INT32_MAX)
            require_corner(obj.name, face, -1, obj.scan.file_vertices, std::to_string(given));
        obj.polygon.push_back(static_cast<std::uint32_t>(index));
        largest = std::max(largest, index);
        if (obj.texture)
            read_corner_texture(obj, face, word, obj.polygon.back(), latest_texture);
    }
    if (obj.polygon.size() < 3)
        refuse(obj.name, face.text() + " has " + std::to_string(obj.polygon.size()) +
                             " corners where at least 3 are needed");
    if (largest >= vertices)
        obj.early_faces.push_back({face, largest});
    if (obj.texture) {
        obj.texture->face_sizes.push_back(static_cast<std::uint32_t>(obj.polygon.size()));
        if (latest_texture >= static_cast<std::int64_t>(obj.texture->values.size()))
            obj.early_texture.push_back({face, latest_texture});
    }
    add_face(obj.scan, obj.polygon);
}

void require_known_corners(const ObjScan& obj)
{
    for (const EarlyFace& face : obj.early_faces)
        require_corner(obj.name, face.place, face.largest_index, obj.scan.file_vertices,
                       std::to_string(face.largest_index + 1));
    for (const EarlyFace& face : obj.early_texture)
        if (face.largest_index >= static_cast<std::int64_t>(obj.texture->values.size()))
            refuse(obj.name, face.place.text() + ": there is no texture coordinate " +
                                 std::to_string(face.largest_index + 1));
}

/// Most other statements say nothing about the surface and are passed over. Refuses those that do,
/// and what was meant for a vertex or a face but is not spelled like one: a surface with a hole
/// where a line was not understood would look like a sound one.
void refuse_lost_surface(const ObjScan& obj, std::string_view keyword, std::size_t line)
{
    struct Statement {
        std::string_view keyword;
        const char* meaning;
    };
    static constexpr std::array<Statement, 5> kUnreadable{
        {{"surf", "a free-form surface"},
         {"bsp", "a B-spline patch"},
         {"bzp", "a Bezier patch"},
         {"cdp", "a Cardinal patch"},
         {"call", "another file to be read in its place"}}};
    const std::string at = "line " + std::to_string(line) + ": the keyword " + quoted(keyword);
    for (const Statement& statement : kUnreadable)
        if (keyword == statement.keyword)
            refuse(obj.name, at + " stands for " + statement.meaning +
                                 "; only vertices and polygons can be read");
    for (const std::string_view known : {"v", "f", "fo"})
        if (equal_ignoring_case(keyword, known))
            refuse(obj.name, at + " is in capitals; in OBJ it is " + quoted(known));
    const auto begins_number = [](unsigned char c) {
        return std::isdigit(c) || c == '-' || c == '+' || c == '.';
    };
    if (keyword.size() > 1 && (keyword[0] == 'v' || keyword[0] == 'f') &&
        begins_number(static_cast<unsigned char>(keyword[1])))
        refuse(obj.name, at + " has no blank before its first number");
}

void read_statement(ObjScan& obj, std::string_view line, std::size_t number)
{
    const std::string_view keyword = cut_word(line);
    // A comment may touch the value before it.
    const std::string_view values = line.substr(0, line.find('#'));
    if (keyword == "v")
        read_vertex(obj, values, number);
    else if (keyword == "f" || keyword == "fo") // the form of version 2.11
        read_face(obj, values, number);
    else if (keyword == "vt" && obj.texture)
        read_texture(obj, values, number);
    else if (!keyword.empty() && keyword[0] != '#')
        refuse_lost_surface(obj, keyword, number);
}

/// The line without its final backslash, which joins the next one to it. A comment ends with its
/// line whatever stands there: the next one may be a vertex.
bool cut_continuation(std::string_view& line)
{
    if (line.find('#') != line.npos)
        return false;
    const std::size_t last = line.find_last_not_of(" \t");
    if (last == line.npos || line[last] != '\\')
        return false;
    line = line.substr(0, last);
    return true;
}

} // namespace

FileScan scan_obj(const std::string& name, std::string_view bytes, Coordinates& coordinates)
{
    return scan_obj(name, bytes, coordinates, nullptr);
}

FileScan scan_obj(const std::string& name, std::string_view bytes, Coordinates& coordinates,
                  TextureScan* texture)
{
    ObjScan obj{name, coordinates, {}, {}, {}, texture, {}};
    obj.scan.format = "OBJ";
    Lines lines(without_byte_order_mark(bytes));
    std::string joined;
    for (std::string_view line; lines.next(line);) {
        // A statement over several lines is named by its first.
        const std::size_t number = lines.number();
        if (cut_continuation(line)) {
            joined = line;
            for (bool more = true; more && lines.next(line);) {
                more = cut_continuation(line);
                // The backslash stands for a blank, not for nothing: numbers on both sides stay
                // apart.
                (joined += ' ') += line;
            }
            line = joined;
        }
        read_statement(obj, line, number);
    }
    require_known_corners(obj);
    return std::move(obj.scan);
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#include "io/file_scan.h"

#include <algorithm>

namespace vdb_shell
{
namespace
{

// OpenMesh's OBJ reader gives up on a texture coordinate beyond float range, takes corners that
// come twice out of a face without a word, reads no line continuation, opens the material files
// that are named, lets an index of 2^40 or a vertex of two coordinates pass, and goes by the
// process's locale. The coordinates and corners are handed to its PLY reader, in binary: its
// text reader takes as long as this scan.

struct ObjScan {
    const std::string& name;
    Coordinates& coordinates;
    FileScan scan;
    std::string vertices, faces;       ///< bodies of the stream
    std::vector<std::int64_t> largest; ///< 0-based, of each face
    std::vector<std::size_t> line_of_face;
    Corners corners; ///< of the face in hand
};

void add_vertex(ObjScan& obj, std::string_view rest, std::size_t line)
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
        append_bytes(obj.vertices, point[axis]);
    }
    obj.scan.points.push_back(point);
}

void add_face(ObjScan& obj, std::string_view rest, std::size_t line)
{
    const Place face{"face", obj.scan.file_faces, line};
    const auto vertices = static_cast<std::int64_t>(obj.scan.file_vertices);
    std::int64_t largest = -1;
    obj.corners.clear();
    for (std::string_view word = cut_word(rest); !word.empty(); word = cut_word(rest)) {
        if (word[0] == '#')
            break;
        const std::string_view vertex = word.substr(0, word.find('/'));
        const std::int64_t given = parse_integer(obj.name, face, vertex);
        const std::int64_t index = given < 0 ? vertices + given : given - 1;
        // Above, the index may name a vertex that is still to come: see require_known_corners.
        if (index < 0 || index > INT32_MAX)
            require_corner(obj.name, face, -1, obj.scan.file_vertices, std::to_string(given));
        obj.corners.push_back(static_cast<std::uint32_t>(index));
        largest = std::max(largest, index);
    }
    if (obj.corners.size() < 3)
        refuse(obj.name, face.text() + " has " + std::to_string(obj.corners.size()) +
                             " corners where at least 3 are needed");
    obj.largest.push_back(largest);
    obj.line_of_face.push_back(line);
    if (!count_face(obj.scan, obj.corners))
        return;
    append_bytes(obj.faces, static_cast<std::int32_t>(obj.corners.size()));
    for (const std::uint32_t corner : obj.corners)
        append_bytes(obj.faces, static_cast<std::int32_t>(corner));
}

void require_known_corners(const ObjScan& obj)
{
    for (std::size_t f = 0; f < obj.largest.size(); ++f)
        require_corner(obj.name, {"face", f, obj.line_of_face[f]}, obj.largest[f],
                       obj.scan.file_vertices, std::to_string(obj.largest[f] + 1));
}

/// The line without its final backslash, which joins the next one to it.
bool cut_continuation(std::string_view& line)
{
    const std::size_t last = line.find_last_not_of(" \t");
    if (last == line.npos || line[last] != '\\')
        return false;
    line = line.substr(0, last);
    return true;
}

} // namespace

FileScan scan_obj(const std::string& name, const std::string& bytes, Coordinates& coordinates)
{
    ObjScan obj{name, coordinates, {}, {}, {}, {}, {}, {}};
    obj.scan.format = "OBJ";
    obj.scan.reader = "ply";
    obj.scan.binary = true;
    Lines lines(bytes);
    std::string joined;
    for (std::string_view line; lines.next(line);) {
        const std::size_t number = lines.number();
        if (cut_continuation(line)) {
            joined = line;
            for (bool more = true; more && lines.next(line);) {
                more = cut_continuation(line);
                (joined += ' ') += line;
            }
            line = joined;
        }
        const std::string_view keyword = cut_word(line);
        if (keyword == "v")
            add_vertex(obj, line, number);
        else if (keyword == "f")
            add_face(obj, line, number);
    }
    require_known_corners(obj);
    obj.scan.stream = plain_ply_header("binary_little_endian", "float", obj.scan.file_vertices,
                                       obj.scan.faces_passed_on()) +
                      obj.vertices + obj.faces;
    return std::move(obj.scan);
}

} // namespace vdb_shell

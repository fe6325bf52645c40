// SPDX-License-Identifier: Apache-2.0
#include "io/file_scan.h"

#include <algorithm>
#include <array>

namespace vdb_shell
{
namespace
{

// OpenMesh's OFF reader knows no comments and no counts beside the keyword, and reads a stream by
// the header of the file that it opened last. What stands in an OFF file after the header - lines
// of coordinates, then of a number of corners and the corners - is the body of an ASCII PLY file
// too, so the PLY reader is given it.

/// The next line that holds more than a comment.
bool next_content(Lines& lines, std::string_view& line)
{
    while (lines.next(line)) {
        line = line.substr(0, line.find('#'));
        if (line.find_first_not_of(" \t\v\f") != line.npos)
            return true;
    }
    return false;
}

/// Checks the keyword and leaves what stands beside it in `rest`.
void read_keyword(const std::string& name, Lines& lines, std::string_view& rest)
{
    if (!next_content(lines, rest))
        refuse(name, "the OFF file holds nothing");
    const std::string_view keyword = cut_word(rest);
    static constexpr std::array<std::string_view, 8> kKnown{"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                            "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
    if (std::find(kKnown.begin(), kKnown.end(), keyword) == kKnown.end())
        refuse(name, "the keyword " + quoted(keyword) +
                         " where OFF, possibly with ST, C, N before it, is needed");
    std::string_view words = rest;
    if (cut_word(words) == "BINARY")
        refuse(name, "binary OFF is not supported, only text (there are two ways of writing it, "
                     "which cannot be told apart)");
}

std::array<std::size_t, 2> read_counts(const std::string& name, Lines& lines, std::string_view rest,
                                       std::size_t file_size)
{
    if (rest.find_first_not_of(" \t\v\f") == rest.npos && !next_content(lines, rest))
        refuse(name, "the file ends before the numbers of vertices and faces");
    std::array<std::size_t, 2> counts{};
    const char* const what[2] = {"vertices", "faces"};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string_view word = cut_word(rest);
        const std::int64_t count =
            parse_integer(name, {"number of elements", i, lines.number()}, word);
        // A vertex takes three digits and two blanks at least, a face more.
        if (count < 0 || static_cast<std::uint64_t>(count) > file_size / 5)
            refuse(name, "the header declares " + std::to_string(count) + " " + what[i] +
                             ", more than a file of " + std::to_string(file_size) +
                             " bytes can hold");
        counts[i] = static_cast<std::size_t>(count);
    }
    return counts;
}

void read_vertex(const std::string& name, const Lines& lines, std::string_view line,
                 Coordinates& coordinates, FileScan& scan)
{
    const Place vertex{"vertex", scan.points.size(), lines.number()};
    openvdb::Vec3s point;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = cut_word(line);
        if (word.empty())
            refuse(name, vertex.text() + " has " + std::to_string(axis) +
                             " coordinates where 3 are needed");
        point[axis] = coordinates.from_text(name, vertex, word, axis);
        coordinates.pass_on(scan.stream, word, point[axis]);
        scan.stream += axis < 2 ? ' ' : '\n';
    }
    scan.points.push_back(point);
}

void read_face(const std::string& name, const Lines& lines, std::string_view line, FileScan& scan,
               std::string& faces)
{
    const Place face{"face", scan.file_faces, lines.number()};
    const std::int64_t count = parse_integer(name, face, cut_word(line));
    if (count < 3)
        refuse(name, face.text() + " has " + std::to_string(count) +
                         " corners where at least 3 are needed");
    Corners corners;
    for (std::int64_t k = 0; k < count; ++k) {
        const std::string_view word = cut_word(line);
        if (word.empty())
            refuse(name, face.text() + " declares " + std::to_string(count) + " corners and has " +
                             std::to_string(k));
        const std::int64_t index = parse_integer(name, face, word);
        require_corner(name, face, index, scan.file_vertices, std::to_string(index));
        corners.push_back(static_cast<std::uint32_t>(index));
    }
    if (!count_face(scan, corners))
        return;
    faces += std::to_string(corners.size());
    for (const std::uint32_t corner : corners)
        faces += ' ' + std::to_string(corner);
    faces += '\n';
}

} // namespace

FileScan scan_off(const std::string& name, const std::string& bytes, Coordinates& coordinates)
{
    FileScan scan;
    scan.format = "OFF";
    scan.reader = "ply";
    Lines lines(bytes);
    std::string_view line;
    read_keyword(name, lines, line);
    const auto [vertices, declared_faces] = read_counts(name, lines, line, bytes.size());
    auto refuse_end = [&](const char* what, std::size_t found, std::size_t declared) {
        refuse(name, std::string("the file ends after ") + std::to_string(found) + " of the " +
                         std::to_string(declared) + " " + what + " that its header declares");
    };
    scan.file_vertices = vertices;
    while (scan.points.size() < vertices) {
        if (!next_content(lines, line))
            refuse_end("vertices", scan.points.size(), vertices);
        read_vertex(name, lines, line, coordinates, scan);
    }
    std::string faces;
    while (scan.file_faces < declared_faces) {
        if (!next_content(lines, line))
            refuse_end("faces", scan.file_faces, declared_faces);
        read_face(name, lines, line, scan, faces);
    }
    if (next_content(lines, line))
        refuse(name, "line " + std::to_string(lines.number()) + " goes on after the " +
                         std::to_string(declared_faces) + " faces that the header declares");
    scan.stream =
        plain_ply_header("ascii", "float", vertices, scan.faces_passed_on()) + scan.stream + faces;
    return scan;
}

} // namespace vdb_shell

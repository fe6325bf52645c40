// SPDX-License-Identifier: Apache-2.0

// Scans OFF (Geomview's manual, "OFF files"), in text only. Counts are held against the size of the
// file before memory is taken by them. Files differ in what follows the coordinates of a vertex and
// in how they break lines, so the first vertex decides how the others are read (read_vertices()
// says how). All that the header declares must be there, and nothing after it, since a count that
// does not fit may mean that a part of the surface is missing.

#include "io/file_scan.h"

#include <algorithm>
#include <array>

namespace vdb_shell
{
namespace
{

// Values may stand in any number of lines, except that the colour of a face ends where its line
// does. The manual lets a vertex have a normal, a colour and texture coordinates of fixed numbers,
// but programs write three or four numbers for a colour, and write colours without saying so in the
// keyword. So the rest of a vertex's line is passed over as well, in the same way.

/// The words of the file, without comments, and the line that each stands in.
class OffWords
{
public:
    OffWords(const std::string& name, std::string_view text) : name_(name), lines_(text) {}

    /// Goes to the next line that holds a word, unless there are words left in this one. False at
    /// the end of the file.
    bool find()
    {
        while (line_.find_first_not_of(" \t\v\f") == line_.npos) {
            if (!lines_.next(line_))
                return false;
            line_ = line_.substr(0, line_.find('#'));
        }
        return true;
    }
    /// Empty at the end of the file.
    std::string_view next() { return find() ? cut_word(line_) : std::string_view(); }
    /// The next word of this line; empty at its end.
    std::string_view next_in_line() { return cut_word(line_); }
    void skip_line() { line_ = {}; }
    bool has_in_line(std::size_t count) const
    {
        std::string_view line = line_;
        while (count > 0 && !cut_word(line).empty())
            --count;
        return count == 0;
    }
    std::size_t line() const { return lines_.number(); }
    const std::string& name() const { return name_; }

private:
    const std::string& name_;
    Lines lines_;
    std::string_view line_;
};

void read_keyword(OffWords& words)
{
    const std::string_view keyword = words.next();
    if (keyword.empty())
        refuse(words.name(), "the OFF file holds nothing");
    static constexpr std::array<std::string_view, 8> kKnown{"OFF",   "COFF",   "NOFF",   "CNOFF",
                                                            "STOFF", "STCOFF", "STNOFF", "STCNOFF"};
    if (std::find(kKnown.begin(), kKnown.end(), keyword) == kKnown.end())
        refuse(words.name(), "the keyword " + quoted(keyword) +
                                 " where OFF, possibly with ST, C, N before it, is needed");
}

std::array<std::size_t, 2> read_counts(OffWords& words, std::size_t file_size)
{
    if (!words.find())
        refuse(words.name(), "the file ends before the numbers of vertices and faces");
    std::array<std::size_t, 2> counts{};
    const char* const what[2] = {"vertices", "faces"};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::string_view word = words.next_in_line();
        if (i == 0 && word == "BINARY")
            refuse(words.name(), "binary OFF is not supported, only text (there are two ways of "
                                 "writing it, which cannot be told apart)");
        const std::int64_t count =
            parse_integer(words.name(), {"number of elements", i, words.line()}, word);
        // A vertex takes three digits and two blanks at least, a face more.
        if (count < 0 || static_cast<std::uint64_t>(count) > file_size / 5)
            refuse(words.name(), "the header declares " + std::to_string(count) + " " + what[i] +
                                     ", more than a file of " + std::to_string(file_size) +
                                     " bytes can hold");
        counts[i] = static_cast<std::size_t>(count);
    }
    words.skip_line(); // the number of edges, which nothing depends on
    return counts;
}

[[noreturn]] void refuse_end(const OffWords& words, const char* what, std::size_t found,
                             std::size_t declared)
{
    refuse(words.name(), std::string("the file ends after ") + std::to_string(found) + " of the " +
                             std::to_string(declared) + " " + what + " that its header declares");
}

void read_vertices(OffWords& words, Coordinates& coordinates, FileScan& scan)
{
    // Where the first vertex is spread over lines, lines mean nothing and vertices have nothing but
    // coordinates. Elsewhere a vertex has a line of its own, and one with too few numbers can be
    // named.
    const bool spread = words.find() && !words.has_in_line(3);
    scan.points.reserve(scan.file_vertices);
    while (scan.points.size() < scan.file_vertices) {
        if (!words.find())
            refuse_end(words, "vertices", scan.points.size(), scan.file_vertices);
        const Place vertex{"vertex", scan.points.size(), words.line()};
        openvdb::Vec3s point;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = spread ? words.next() : words.next_in_line();
            if (word.empty())
                refuse(words.name(), vertex.text() + " has " + std::to_string(axis) +
                                         " coordinates where 3 are needed");
            point[axis] = coordinates.from_text(
                words.name(), {vertex.what, vertex.index, words.line()}, word, axis);
        }
        if (!spread)
            words.skip_line();
        scan.points.push_back(point);
    }
}

void read_face(OffWords& words, FileScan& scan, Polygon& polygon)
{
    const Place face{"face", scan.file_faces, words.line()};
    const std::int64_t count = parse_integer(words.name(), face, words.next());
    if (count < 3)
        refuse(words.name(), face.text() + " has " + std::to_string(count) +
                                 " corners where at least 3 are needed");
    polygon.clear();
    for (std::int64_t k = 0; k < count; ++k) {
        const std::string_view word = words.next();
        if (word.empty())
            refuse(words.name(), face.text() + " declares " + std::to_string(count) +
                                     " corners and has " + std::to_string(k));
        const Place here{face.what, face.index, words.line()};
        const std::int64_t index = parse_integer(words.name(), here, word);
        require_corner(words.name(), here, index, scan.file_vertices, std::to_string(index));
        polygon.push_back(static_cast<std::uint32_t>(index));
    }
    words.skip_line(); // the colour of the face
    add_face(scan, polygon);
}

} // namespace

FileScan scan_off(const std::string& name, std::string_view bytes, Coordinates& coordinates)
{
    FileScan scan;
    scan.format = "OFF";
    OffWords words(name, without_byte_order_mark(bytes));
    read_keyword(words);
    const auto [vertices, faces] = read_counts(words, bytes.size());
    scan.file_vertices = vertices;
    read_vertices(words, coordinates, scan);
    Polygon polygon;
    while (scan.file_faces < faces) {
        if (!words.find())
            refuse_end(words, "faces", scan.file_faces, faces);
        read_face(words, scan, polygon);
    }
    if (words.find())
        refuse(name, "line " + std::to_string(words.line()) + " goes on after the " +
                         std::to_string(faces) + " faces that the header declares");
    return scan;
}

} // namespace vdb_shell

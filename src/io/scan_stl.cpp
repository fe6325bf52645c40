// SPDX-License-Identifier: Apache-2.0

// Scans STL, text and binary. The format has no vertices, only three corners a facet, so equal
// positions are merged here whatever the options say; otherwise no two facets would have a common
// edge. A binary file is known by its size, which the number of facets in its header determines
// exactly; its header may begin with "solid" as well, the word by which text is known. Normals are
// passed over, because the order of the corners says the same.

#include "io/file_scan.h"
#include "mesh/equal_points.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace vdb_shell
{
namespace
{

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

std::uint32_t little_endian_32(const char* bytes)
{
    // Byte by byte, so that the machine's own byte order does not matter.
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i)
        value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

/// Makes vertices of the corners that the facets repeat, and faces of the facets.
void merge_corners(FileScan& scan, const std::string& name)
{
    scan.file_vertices = scan.points.size();
    require_numbered(name, scan.file_vertices, "corners");
    std::vector<std::uint32_t> vertex = first_equal_point(scan.points);
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < vertex.size(); ++i) {
        // An equal point stands before this one, and its number is known.
        vertex[i] = vertex[i] == i ? kept : vertex[vertex[i]];
        // Points only move forward in the list, to places that were read already.
        if (vertex[i] == kept)
            scan.points[kept++] = scan.points[i];
    }
    scan.points.resize(kept);
    Polygon polygon;
    for (std::size_t i = 0; i < vertex.size(); i += 3) {
        polygon = {vertex[i], vertex[i + 1], vertex[i + 2]};
        add_face(scan, polygon);
    }
}

FileScan scan_binary(const std::string& name, std::string_view bytes, Coordinates& coordinates)
{
    if (bytes.size() < kHeaderBytes)
        refuse(name, "a file of " + std::to_string(bytes.size()) +
                         " bytes is neither text STL (there is no \"solid\") nor binary STL (whose "
                         "header has 84 bytes)");
    const std::size_t facets = little_endian_32(bytes.data() + 80);
    // More bytes than declared are refused too: they may be the facets of a count that was written
    // wrong.
    if (bytes.size() != kHeaderBytes + kFacetBytes * facets)
        refuse(name, "the header declares " + std::to_string(facets) + " facets, which take " +
                         std::to_string(kHeaderBytes + kFacetBytes * facets) +
                         " bytes, but the file has " + std::to_string(bytes.size()));
    FileScan scan;
    scan.format = "STL (binary)";
    scan.points.reserve(3 * facets);
    for (std::size_t facet = 0; facet < facets; ++facet) {
        // The normal is passed over: it follows from the corners, and many writers leave zero.
        const char* coordinate = bytes.data() + kHeaderBytes + kFacetBytes * facet + 12;
        for (int k = 0; k < 3; ++k) {
            openvdb::Vec3s point;
            for (int axis = 0; axis < 3; ++axis, coordinate += 4) {
                const std::uint32_t bits = little_endian_32(coordinate);
                float value = 0;
                std::memcpy(&value, &bits, sizeof bits);
                point[axis] = coordinates.from_number(name, {"face", facet}, value, axis);
            }
            scan.points.push_back(point);
        }
    }
    merge_corners(scan, name);
    return scan;
}

/// The words of a text STL, with the line they stand in: line breaks mean nothing, except behind
/// solid and endsolid.
class Words
{
public:
    Words(const std::string& name, std::string_view text) : name_(name), lines_(text) {}

    /// Empty at the end of the file.
    std::string_view next()
    {
        std::string_view word = cut_word(line_);
        while (word.empty() && lines_.next(line_))
            word = cut_word(line_);
        return word;
    }
    void skip_line() { line_ = {}; }
    std::size_t line() const { return lines_.number(); }
    void expect(std::string_view wanted, std::size_t facet)
    {
        const std::string_view word = next();
        if (equal_ignoring_case(word, wanted))
            return;
        const std::string found = word.empty() ? "the file ends" : quoted(word) + " stands";
        refuse(name_, "face " + std::to_string(facet) + " (line " + std::to_string(line()) +
                          "): " + found + " where " + quoted(wanted) + " is needed");
    }

private:
    const std::string& name_;
    Lines lines_;
    std::string_view line_;
};

void read_facet(const std::string& name, Words& words, Coordinates& coordinates, FileScan& scan)
{
    const std::size_t facet = scan.points.size() / 3;
    words.expect("normal", facet);
    // The normal is skipped and not parsed, because many writers leave "nan" here for thin facets.
    for (int axis = 0; axis < 3; ++axis)
        if (words.next().empty())
            words.expect("outer", facet);
    words.expect("outer", facet);
    words.expect("loop", facet);
    for (int k = 0; k < 3; ++k) {
        words.expect("vertex", facet);
        openvdb::Vec3s point;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = words.next();
            const Place face{"face", facet, words.line()};
            if (word.empty())
                refuse(name, face.text() + ": the file ends");
            point[axis] = coordinates.from_text(name, face, word, axis);
        }
        scan.points.push_back(point);
    }
    words.expect("endloop", facet);
    words.expect("endfacet", facet);
}

FileScan scan_text(const std::string& name, std::string_view bytes, Coordinates& coordinates)
{
    FileScan scan;
    scan.format = "STL (ASCII)";
    Words words(name, bytes);
    bool open = false;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
        if (!open && equal_ignoring_case(word, "solid")) {
            open = true;
            words.skip_line(); // a name, of any words
        } else if (open && equal_ignoring_case(word, "endsolid")) {
            open = false;
            words.skip_line();
        } else if (open && equal_ignoring_case(word, "facet")) {
            read_facet(name, words, coordinates, scan);
        } else {
            refuse(name, "line " + std::to_string(words.line()) + ": " + quoted(word) +
                             " stands where " + (open ? "facet or endsolid" : "solid") +
                             " is needed");
        }
    }
    // Without its end the file may have been cut short between two facets.
    if (open)
        refuse(name, "the file ends after " + std::to_string(scan.points.size() / 3) +
                         " facets, without endsolid");
    merge_corners(scan, name);
    return scan;
}

/// Binary files may begin with "solid" as well; a binary file says its own size.
bool is_text(std::string_view bytes)
{
    if (bytes.size() >= kHeaderBytes &&
        bytes.size() == kHeaderBytes + kFacetBytes * little_endian_32(bytes.data() + 80))
        return false;
    std::string_view start = without_byte_order_mark(bytes.substr(0, 4096));
    return start.find('\0') == start.npos && equal_ignoring_case(cut_word(start), "solid");
}

} // namespace

FileScan scan_stl(const std::string& name, std::string_view bytes, Coordinates& coordinates)
{
    // The header of a binary file may hold any bytes, so a byte-order mark is looked for in text
    // only.
    return is_text(bytes) ? scan_text(name, without_byte_order_mark(bytes), coordinates)
                          : scan_binary(name, bytes, coordinates);
}

} // namespace vdb_shell

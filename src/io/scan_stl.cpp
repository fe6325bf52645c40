// SPDX-License-Identifier: Apache-2.0
#include "io/file_scan.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace vdb_shell
{
namespace
{

// OpenMesh's STL readers merge equal positions themselves and leave out facets of which two corners
// are merged; both are foreseen here. They take any number of facets on trust and read nonsense
// behind the end of the file.

constexpr std::size_t kHeaderBytes = 84, kFacetBytes = 50;

std::uint32_t little_endian_32(const char* bytes)
{
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i)
        value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
}

void put_little_endian(char* bytes, float value)
{
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; ++i)
        bytes[i] = static_cast<char>(bits >> (8 * i) & 0xFF);
}

/// Turns three points a facet into what OpenMesh will make of them.
void foresee_merging(FileScan& scan)
{
    scan.file_vertices = scan.points.size();
    const std::vector<std::uint32_t> first = first_equal_point(scan.points);
    for (std::size_t facet = 0; facet < scan.points.size() / 3; ++facet) {
        Corners corners{first[3 * facet], first[3 * facet + 1], first[3 * facet + 2]};
        count_face(scan, corners);
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < first.size(); ++i)
        if (first[i] == i)
            scan.points[kept++] = scan.points[i];
    scan.points.resize(kept);
}

FileScan scan_binary(const std::string& name, std::string bytes, Coordinates& coordinates)
{
    if (bytes.size() < kHeaderBytes)
        refuse(name, "a file of " + std::to_string(bytes.size()) +
                         " bytes is neither text STL (there is no \"solid\") nor binary STL (whose "
                         "header has 84 bytes)");
    const std::size_t facets = little_endian_32(bytes.data() + 80);
    if (bytes.size() != kHeaderBytes + kFacetBytes * facets)
        refuse(name, "the header declares " + std::to_string(facets) + " facets, which take " +
                         std::to_string(kHeaderBytes + kFacetBytes * facets) +
                         " bytes, but the file has " + std::to_string(bytes.size()));
    FileScan scan;
    scan.format = "STL (binary)";
    scan.reader = "stl";
    scan.binary = true;
    scan.points.reserve(3 * facets);
    for (std::size_t facet = 0; facet < facets; ++facet) {
        char* corner = bytes.data() + kHeaderBytes + kFacetBytes * facet + 12;
        for (int k = 0; k < 3; ++k, corner += 12) {
            openvdb::Vec3s point;
            char* coordinate = corner;
            for (int axis = 0; axis < 3; ++axis, coordinate += 4) {
                const std::uint32_t bits = little_endian_32(coordinate);
                float value = 0;
                std::memcpy(&value, &bits, sizeof bits);
                point[axis] = coordinates.from_number(name, {"face", facet}, value, axis);
                put_little_endian(coordinate, point[axis]);
            }
            scan.points.push_back(point);
        }
    }
    scan.stream = std::move(bytes);
    foresee_merging(scan);
    return scan;
}

/// The words of a text STL, with the line they stand in.
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
    // Only skipped: many writers leave "nan" here for thin facets.
    for (int axis = 0; axis < 3; ++axis)
        if (words.next().empty())
            words.expect("outer", facet);
    words.expect("outer", facet);
    words.expect("loop", facet);
    scan.stream += "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) {
        words.expect("vertex", facet);
        scan.stream += "vertex";
        openvdb::Vec3s point;
        for (int axis = 0; axis < 3; ++axis) {
            const std::string_view word = words.next();
            const Place face{"face", facet, words.line()};
            if (word.empty())
                refuse(name, face.text() + ": the file ends");
            point[axis] = coordinates.from_text(name, face, word, axis);
            scan.stream += ' ';
            coordinates.pass_on(scan.stream, word, point[axis]);
        }
        scan.stream += '\n';
        scan.points.push_back(point);
    }
    words.expect("endloop", facet);
    words.expect("endfacet", facet);
    scan.stream += "endloop\nendfacet\n";
}

FileScan scan_text(const std::string& name, const std::string& bytes, Coordinates& coordinates)
{
    FileScan scan;
    scan.format = "STL (ASCII)";
    scan.reader = "stl";
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
    if (open)
        refuse(name, "the file ends after " + std::to_string(scan.points.size() / 3) +
                         " facets, without endsolid");
    foresee_merging(scan);
    return scan;
}

/// Binary files may begin with "solid" as well; a binary file says its own size.
bool is_text(const std::string& bytes)
{
    if (bytes.size() >= kHeaderBytes &&
        bytes.size() == kHeaderBytes + kFacetBytes * little_endian_32(bytes.data() + 80))
        return false;
    std::string_view start = std::string_view(bytes).substr(0, 4096);
    return start.find('\0') == start.npos && equal_ignoring_case(cut_word(start), "solid");
}

} // namespace

FileScan scan_stl(const std::string& name, std::string bytes, Coordinates& coordinates)
{
    return is_text(bytes) ? scan_text(name, bytes, coordinates)
                          : scan_binary(name, std::move(bytes), coordinates);
}

} // namespace vdb_shell

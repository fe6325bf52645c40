// SPDX-License-Identifier: Apache-2.0

// The header of a PLY file, and its data value by value (Greg Turk, "The PLY Polygon File Format",
// 1994). A header is taken only if it is complete and says how to read a surface; data are read in
// the order and the types that it declares. No length in the file is believed before the bytes for
// it are there, since memory is taken by it.

#include "io/ply_values.h"

#include "core/byte_order.h"
#include "vdb_shell/options/option_value.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

namespace vdb_shell
{
namespace
{

std::optional<PlyType> type_named(std::string_view word)
{
    using Entry = std::pair<std::string_view, PlyType>;
    static constexpr std::array<Entry, 16> kTypes{{{"char", PlyType::int8},
                                                   {"int8", PlyType::int8},
                                                   {"uchar", PlyType::uint8},
                                                   {"uint8", PlyType::uint8},
                                                   {"short", PlyType::int16},
                                                   {"int16", PlyType::int16},
                                                   {"ushort", PlyType::uint16},
                                                   {"uint16", PlyType::uint16},
                                                   {"int", PlyType::int32},
                                                   {"int32", PlyType::int32},
                                                   {"uint", PlyType::uint32},
                                                   {"uint32", PlyType::uint32},
                                                   {"float", PlyType::float32},
                                                   {"float32", PlyType::float32},
                                                   {"double", PlyType::float64},
                                                   {"float64", PlyType::float64}}};
    for (const Entry& entry : kTypes)
        if (entry.first == word)
            return entry.second;
    return std::nullopt;
}

/// The header line by line. It is text in binary files as well.
class HeaderParser
{
public:
    HeaderParser(const std::string& name, std::string_view bytes)
        : name_(name), bytes_(bytes), lines_(bytes)
    {
    }

    PlyHeader parse()
    {
        std::string_view line;
        // Line breaks of all three kinds are taken here, since binary files come from any system.
        if (!lines_.next(line) || cut_word(line) != "ply")
            refuse(name_, "the first line is not \"ply\"");
        while (true) {
            if (!lines_.next(line))
                refuse(name_, "the file ends before \"end_header\"");
            const std::string_view keyword = cut_word(line);
            if (keyword == "end_header")
                break;
            if (keyword == "format")
                add_format(line);
            else if (keyword == "element")
                add_element(line);
            else if (keyword == "property")
                add_property(line);
            else if (!keyword.empty() && !is_remark(keyword))
                complain("the keyword " + quoted(keyword) + " is unknown");
        }
        if (!has_format_)
            refuse(name_, "the header has no format line");
        // Binary data begins right behind the line break of end_header.
        header_.bytes = bytes_.size() - lines_.rest().size();
        // Text data count on from here, so that messages name lines of the file.
        header_.lines = lines_.number();
        require_mesh();
        return std::move(header_);
    }

private:
    // Blender 2.4x wrote "Created by Blender3D 247 - ..." into its headers, without "comment".
    static bool is_remark(std::string_view keyword)
    {
        return keyword == "comment" || keyword == "obj_info" || keyword == "Created";
    }

    [[noreturn]] void complain(const std::string& what) const
    {
        refuse(name_, "line " + std::to_string(lines_.number()) + " of the header: " + what);
    }

    void add_format(std::string_view line)
    {
        const std::string_view word = cut_word(line);
        if (word == "ascii")
            header_.encoding = PlyEncoding::text;
        else if (word == "binary_little_endian")
            header_.encoding = PlyEncoding::little_endian;
        else if (word == "binary_big_endian")
            header_.encoding = PlyEncoding::big_endian;
        else
            complain("the format " + quoted(word) + " is unknown");
        has_format_ = true;
    }

    void add_element(std::string_view line)
    {
        PlyElement element;
        element.name = cut_word(line);
        const std::int64_t count = parse_integer(
            name_, {"element count", header_.elements.size(), lines_.number()}, cut_word(line));
        // OpenVDB and Houdini number points and faces with int32.
        if (count < 0 || count > INT32_MAX)
            complain("the number of \"" + element.name + "\" elements, " + std::to_string(count) +
                     ", is beyond the limit of " + std::to_string(INT32_MAX));
        // Whether so many fit into the file is tested where their data begin (scan_ply.cpp), since
        // types are not known yet.
        element.count = static_cast<std::size_t>(count);
        header_.elements.push_back(std::move(element));
    }

    PlyType type(std::string_view word) const
    {
        const std::optional<PlyType> found = type_named(word);
        if (!found)
            complain("the type " + quoted(word) + " is unknown");
        return *found;
    }

    void add_property(std::string_view line)
    {
        if (header_.elements.empty())
            complain("a property stands before any element");
        PlyProperty property;
        std::string_view word = cut_word(line);
        property.is_list = word == "list";
        // "list", the type of its length, the type of its values, its name; a single value has only
        // the last two.
        if (property.is_list) {
            property.count_type = type(cut_word(line));
            word = cut_word(line);
        }
        property.type = type(word);
        property.name = cut_word(line);
        header_.elements.back().properties.push_back(std::move(property));
    }

    template <typename Wanted>
    static std::ptrdiff_t count_of(const PlyElement& element, const Wanted& wanted)
    {
        return std::count_if(element.properties.begin(), element.properties.end(), wanted);
    }

    // With two properties of one name it would be chance which of them is the coordinate, so both
    // none and two are refused.
    void require_vertices(const PlyElement& element) const
    {
        for (const char* const axis : {"x", "y", "z"})
            if (count_of(element,
                         [&](const PlyProperty& p) { return !p.is_list && p.name == axis; }) != 1)
                refuse(name_,
                       std::string("the header gives its vertices not one property ") + axis);
    }

    void require_polygons(const PlyElement& element) const
    {
        const char* const what = element.name == "face" ? "faces" : "tristrips";
        if (count_of(element, [](const PlyProperty& p) { return p.holds_corners(); }) != 1)
            refuse(name_, std::string("the header gives its ") + what +
                              " not one list \"vertex_indices\" (or \"vertex_index\")");
    }

    void require_mesh() const
    {
        std::size_t vertex_elements = 0;
        bool faces = false, strips = false;
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex") {
                ++vertex_elements;
                require_vertices(element);
            } else if (element.name == "face" || element.name == "tristrips") {
                require_polygons(element);
                (element.name == "face" ? faces : strips) |= element.count > 0;
            }
        }
        // Faces number the vertices of one list. Of two lists nothing would say which is meant.
        if (vertex_elements != 1)
            refuse(name_, "the header declares " + std::to_string(vertex_elements) +
                              " vertex elements where 1 is needed");
        // Neither is said to replace the other, so reading both could double the surface.
        if (faces && strips)
            refuse(name_, "the header declares both faces and tristrips, which may be the same "
                          "surface twice; one of them is needed");
    }

    const std::string& name_;
    std::string_view bytes_;
    Lines lines_;
    PlyHeader header_;
    bool has_format_ = false;
};

/// A double holds every value of every type of the format exactly.
template <typename Number> double number_at(const std::array<char, 8>& bytes)
{
    Number value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return static_cast<double>(value);
}

double decode(PlyType type, const std::array<char, 8>& bytes)
{
    switch (type) {
    case PlyType::int8:
        return number_at<std::int8_t>(bytes);
    case PlyType::uint8:
        return number_at<std::uint8_t>(bytes);
    case PlyType::int16:
        return number_at<std::int16_t>(bytes);
    case PlyType::uint16:
        return number_at<std::uint16_t>(bytes);
    case PlyType::int32:
        return number_at<std::int32_t>(bytes);
    case PlyType::uint32:
        return number_at<std::uint32_t>(bytes);
    case PlyType::float32:
        return number_at<float>(bytes);
    case PlyType::float64:
        break;
    }
    return number_at<double>(bytes);
}

} // namespace

std::size_t size_of(PlyType type)
{
    switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
        return 1;
    case PlyType::int16:
    case PlyType::uint16:
        return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
        return 4;
    case PlyType::float64:
        break;
    }
    return 8;
}

std::size_t PlyElement::least_size(bool text) const
{
    std::size_t size = 0;
    for (const PlyProperty& property : properties)
        // In text, a digit and a blank.
        size += text ? 2 : size_of(property.is_list ? property.count_type : property.type);
    return size;
}

PlyHeader parse_ply_header(const std::string& name, std::string_view bytes)
{
    return HeaderParser(name, bytes).parse();
}

PlyValues::PlyValues(const std::string& name, const PlyHeader& header, std::string_view bytes)
    : name_(name), encoding_(header.encoding), header_lines_(header.lines),
      data_(header.is_text() ? std::string_view() : bytes.substr(header.bytes)),
      lines_(header.is_text() ? bytes.substr(header.bytes) : std::string_view())
{
}

PlyValue PlyValues::next(PlyType type, const Place& place)
{
    PlyValue value;
    if (encoding_ == PlyEncoding::text) {
        value.word = cut_word(line_);
        // Values are taken wherever the lines break, so an element that runs over several lines is
        // read too.
        while (value.word.empty() && lines_.next(line_))
            value.word = cut_word(line_);
        if (value.word.empty())
            refuse(name_, "the file ends in " + place.text() + ", before what its header declares");
        return value;
    }
    const std::size_t size = size_of(type);
    if (data_.size() < size)
        refuse(name_, "the file ends in " + place.text() + ", before what its header declares");
    // Values are not aligned, so they are copied before they are looked at.
    std::array<char, 8> bytes{};
    std::copy_n(data_.begin(), size, bytes.begin());
    if ((encoding_ == PlyEncoding::little_endian) != little_endian_machine())
        std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    data_.remove_prefix(size);
    value.number = decode(type, bytes);
    return value;
}

std::size_t PlyValues::list_size(const PlyProperty& list, const Place& place)
{
    const PlyValue value = next(list.count_type, place);
    const bool text = encoding_ == PlyEncoding::text;
    const Place at = here(place);
    const double size =
        text ? static_cast<double>(parse_integer(name_, at, value.word)) : value.number;
    // A damaged length must not be believed: memory for the list is taken by it.
    const double most =
        static_cast<double>(bytes_left()) / static_cast<double>(text ? 1 : size_of(list.type));
    // Also for lengths that are stored as floats and are not numbers.
    if (!(size >= 0 && size <= most) || size != std::floor(size))
        refuse(name_, at.text() + ": a list \"" + list.name + "\" of " + text_of(size) +
                          " values, where the rest of the file can hold " +
                          std::to_string(static_cast<std::size_t>(most)));
    return static_cast<std::size_t>(size);
}

bool PlyValues::only_blanks_left()
{
    // Many writers end a binary file with a line break too.
    constexpr std::string_view kBlanks = " \t\r\n\v\f";
    return line_.find_first_not_of(kBlanks) == line_.npos &&
           data_.find_first_not_of(kBlanks) == data_.npos &&
           lines_.rest().find_first_not_of(kBlanks) == std::string_view::npos;
}

Place PlyValues::here(const Place& place) const
{
    return {place.what, place.index,
            encoding_ == PlyEncoding::text ? header_lines_ + lines_.number() : 0};
}

} // namespace vdb_shell

// SPDX-License-Identifier: Apache-2.0
#pragma once

// The header of a PLY file, and its data as a row of values.

#include "io/scan_text.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vdb_shell
{

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
std::size_t size_of(PlyType type);

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8; ///< of a list

    bool holds_corners() const
    {
        return is_list && (name == "vertex_indices" || name == "vertex_index");
    }
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;

    /// Bytes that one of them takes at least.
    std::size_t least_size(bool text) const;
};

enum class PlyEncoding { text, little_endian, big_endian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::text;
    std::vector<PlyElement> elements;
    std::size_t bytes = 0; ///< the data begins here
    std::size_t lines = 0;

    bool is_text() const { return encoding == PlyEncoding::text; }
};

/// Throws ReadError unless the header is complete, has one "vertex" element with scalar x, y, z,
/// and gives "face" or "tristrips" elements, if any, one list of corners; not both of them.
PlyHeader parse_ply_header(const std::string& name, std::string_view bytes);

struct PlyValue {
    std::string_view word; ///< in text data
    double number = 0;     ///< in binary data
};

/// Steps through the data; the end of the file where a value is due is a ReadError that names
/// `place`.
class PlyValues
{
public:
    PlyValues(const std::string& name, const PlyHeader& header, std::string_view bytes);

    PlyValue next(PlyType type, const Place& place);
    /// The length of a list, which the rest of the file can hold.
    std::size_t list_size(const PlyProperty& list, const Place& place);
    std::size_t bytes_left() const { return line_.size() + data_.size() + lines_.rest().size(); }
    bool only_blanks_left();
    /// `place` with the line of the last value.
    Place here(const Place& place) const;

private:
    const std::string& name_;
    PlyEncoding encoding_;
    std::size_t header_lines_;
    std::string_view data_; ///< binary
    Lines lines_;           ///< text
    std::string_view line_;
};

} // namespace vdb_shell

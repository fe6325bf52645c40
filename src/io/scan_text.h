// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the scans of all text formats share. Numbers are parsed without the process's locale.

#include "vdb_shell/io/read_file.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace vdb_shell
{

/// An element of the file, put into words only when there is something to complain about.
struct Place {
    const char* what;
    std::size_t index;
    std::size_t line = 0;     ///< 0: in binary data
    std::string text() const; ///< "vertex 3 (line 7)"
};

/// A coordinate, correctly rounded to float32; refused when it is no number or not finite in
/// float32.
float parse_coordinate(const std::string& name, const Place& place, std::string_view word);

/// The same for a number that the file holds in binary.
float checked_coordinate(const std::string& name, const Place& place, double value);

/// A whole number.
std::int64_t parse_integer(const std::string& name, const Place& place, std::string_view word);

/// Steps through lines that end in LF, CR LF or CR.
class Lines
{
public:
    explicit Lines(std::string_view text) : text_(text) {}
    bool next(std::string_view& line); ///< false at the end
    std::size_t number() const { return number_; }
    std::string_view rest() const { return text_; }

private:
    std::string_view text_;
    std::size_t number_ = 0;
};

/// Cuts the first blank-separated word off `text`; empty when there is none.
std::string_view cut_word(std::string_view& text);

/// `text` without the UTF-8 byte-order mark that some editors put before it: left in place it would
/// become a part of the first word.
std::string_view without_byte_order_mark(std::string_view text);

bool equal_ignoring_case(std::string_view a, std::string_view b);

} // namespace vdb_shell

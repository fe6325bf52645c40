// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scf.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace vdb_shell::houdini
{

/// Writes a document value by value. A list or map that is opened must be closed; keys of a map are
/// texts that come before their values.
class DocumentWriter
{
public:
    virtual ~DocumentWriter() = default;
    virtual void open_list() = 0;
    virtual void close_list() = 0;
    virtual void open_map() = 0;
    virtual void close_map() = 0;
    virtual void text(std::string_view value) = 0;
    virtual void integer(std::int64_t value) = 0;
    virtual void real(double value) = 0;
    virtual void boolean(bool value) = 0;
    /// A list of numbers, in the form's most compact way.
    virtual void numbers(const std::int8_t* values, std::size_t count) = 0;
    virtual void numbers(const std::int32_t* values, std::size_t count) = 0;
    virtual void numbers(const std::int64_t* values, std::size_t count) = 0;
    virtual void numbers(const float* values, std::size_t count) = 0;
    virtual void numbers(const double* values, std::size_t count) = 0;
    /// Whether attributes are stored in pages rather than in lists of tuples.
    virtual bool paged() const = 0;
    /// The text form breaks its line here.
    virtual void new_line() {}
    /// Passes on what is still held back; nothing may be written after it.
    virtual void finish() = 0;
};

/// Throws InvalidOption at a number that is not finite and at a string that is not UTF-8.
std::unique_ptr<DocumentWriter> make_text_writer(Sink out);
std::unique_ptr<DocumentWriter> make_binary_writer(Sink out);

/// A key of a map with its value, or an entry of a flat list of both.
inline void key_text(DocumentWriter& out, const char* key, std::string_view value)
{
    out.text(key);
    out.text(value);
}

inline void key_integer(DocumentWriter& out, const char* key, std::size_t value)
{
    out.text(key);
    out.integer(static_cast<std::int64_t>(value));
}

} // namespace vdb_shell::houdini

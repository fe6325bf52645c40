// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <charconv>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>

namespace vdb_shell
{

/// Text to a stream, free of its locale, in large pieces.
class TextOut
{
public:
    explicit TextOut(std::ostream& out) : out_(out) {}
    ~TextOut() { flush(); }
    TextOut(const TextOut&) = delete;
    TextOut& operator=(const TextOut&) = delete;

    TextOut& operator<<(std::string_view text)
    {
        buffer_ += text;
        if (buffer_.size() > kFlushAt)
            flush();
        return *this;
    }
    TextOut& operator<<(const char* text) { return *this << std::string_view(text); }
    TextOut& operator<<(char c) { return *this << std::string_view(&c, 1); }
    template <typename Number, typename = std::enable_if_t<std::is_arithmetic_v<Number>>>
    TextOut& operator<<(Number value)
    {
        char digits[64];
        const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
        return *this << std::string_view(digits, std::size_t(end - digits));
    }
    /// Three coordinates with a space between. Their digits are those of the double: the digits of
    /// the float mean another number to a program that reads doubles.
    TextOut& operator<<(const openvdb::Vec3s& point) { return *this << openvdb::Vec3d(point); }
    TextOut& operator<<(const openvdb::Vec3d& point)
    {
        return *this << point[0] << ' ' << point[1] << ' ' << point[2];
    }

private:
    static constexpr std::size_t kFlushAt = 1 << 16;
    void flush()
    {
        out_.write(buffer_.data(), std::streamsize(buffer_.size()));
        buffer_.clear();
    }
    std::ostream& out_;
    std::string buffer_;
};

} // namespace vdb_shell

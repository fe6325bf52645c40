// SPDX-License-Identifier: Apache-2.0

// Writes a document as Houdini's binary JSON, the .bgeo form (docs/houdini.md has the table of
// kinds). The bytes are a function of the document alone: always least significant byte first,
// integers as short as they go, each text defined as a token where it first occurs, numbered from
// 0. Attributes have their numbers packed without tags, so that the file has about the size of its
// arrays.

#include "document_writer.h"

#include "binary_kinds.h"

#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <type_traits>

namespace vdb_shell::houdini
{
namespace
{

template <typename T> bool fits(std::int64_t value)
{
    return value >= std::numeric_limits<T>::min() && value <= std::numeric_limits<T>::max();
}

class BinaryWriter final : public DocumentWriter
{
public:
    explicit BinaryWriter(Sink out) : out_(std::move(out)) { buffer_ = kBinaryMark; }
    void open_list() override { kind(Kind::list_begin); }
    void close_list() override { kind(Kind::list_end); }
    void open_map() override { kind(Kind::map_begin); }
    void close_map() override { kind(Kind::map_end); }
    /// Every string is a token, defined where it comes first. A document of this kind says the same
    /// few keys again and again, and a token with a small number costs two bytes.
    void text(std::string_view value) override
    {
        const auto [token, is_new] = tokens_.try_emplace(std::string(value), tokens_.size());
        if (is_new) {
            kind(Kind::token_def);
            length(token->second);
            length(value.size());
            buffer_ += value;
        }
        kind(Kind::token_ref);
        length(token->second);
    }
    /// In as few bytes as it takes. The kind tells the width, so readers lose nothing.
    void integer(std::int64_t value) override
    {
        if (fits<std::int8_t>(value))
            tagged(Kind::int8, static_cast<std::int8_t>(value));
        else if (fits<std::int16_t>(value))
            tagged(Kind::int16, static_cast<std::int16_t>(value));
        else if (fits<std::int32_t>(value))
            tagged(Kind::int32, static_cast<std::int32_t>(value));
        else
            tagged(Kind::int64, value);
    }
    // Single reals are bounds and defaults, which are few: they all take eight bytes, and a float
    // keeps its value in a double.
    void real(double value) override { tagged(Kind::real64, value); }
    void boolean(bool value) override { kind(value ? Kind::yes : Kind::no); }
    void numbers(const std::int8_t* values, std::size_t count) override
    {
        array(Kind::int8, values, count);
    }
    void numbers(const std::int32_t* values, std::size_t count) override
    {
        array(Kind::int32, values, count);
    }
    void numbers(const std::int64_t* values, std::size_t count) override
    {
        array(Kind::int64, values, count);
    }
    void numbers(const float* values, std::size_t count) override
    {
        array(Kind::real32, values, count);
    }
    void numbers(const double* values, std::size_t count) override
    {
        array(Kind::real64, values, count);
    }
    bool paged() const override { return true; }
    void finish() override { flush(); }

private:
    static constexpr std::size_t kFlushAt = 1 << 16;

    void kind(Kind value)
    {
        buffer_ += static_cast<char>(value);
        if (buffer_.size() > kFlushAt)
            flush();
    }
    /// Least significant byte first, on any machine. Bits are taken by memcpy and shifts, which is
    /// defined for floats too.
    template <typename T> void little_endian(T value)
    {
        std::uint64_t bits = 0;
        if constexpr (std::is_same_v<T, float>) {
            std::uint32_t word = 0;
            std::memcpy(&word, &value, sizeof word);
            bits = word;
        } else if constexpr (std::is_same_v<T, double>) {
            std::memcpy(&bits, &value, sizeof bits);
        } else {
            // A signed byte goes through the unsigned one of its size first, so that its sign does
            // not spread into the higher bits of the word.
            using Byte = std::conditional_t<sizeof(T) == 1, std::uint8_t, T>;
            bits = static_cast<std::uint64_t>(static_cast<Byte>(value));
        }
        for (std::size_t i = 0; i < sizeof(T); ++i)
            buffer_ += static_cast<char>((bits >> (8 * i)) & 0xffu);
    }
    template <typename T> void tagged(Kind tag, T value)
    {
        kind(tag);
        little_endian(value);
    }
    // The shortest of the four spellings. Readers take longer ones as well, but then equal
    // documents would not have equal bytes.
    void length(std::size_t value)
    {
        if (value < kLengths) {
            little_endian(static_cast<std::uint8_t>(value));
        } else if (value <= std::numeric_limits<std::uint16_t>::max()) {
            little_endian(kLength16);
            little_endian(static_cast<std::uint16_t>(value));
        } else if (value <= std::numeric_limits<std::uint32_t>::max()) {
            little_endian(kLength32);
            little_endian(static_cast<std::uint32_t>(value));
        } else {
            little_endian(kLength64);
            little_endian(static_cast<std::uint64_t>(value));
        }
    }
    template <typename T> void array(Kind element, const T* values, std::size_t count)
    {
        kind(Kind::uniform);
        kind(element);
        length(count);
        // Flushed on the way: an array may be larger than all else together, and the buffer should
        // not grow with it.
        for (std::size_t i = 0; i < count; ++i) {
            little_endian(values[i]);
            if (buffer_.size() > kFlushAt)
                flush();
        }
    }
    void flush()
    {
        out_(buffer_.data(), buffer_.size());
        buffer_.clear();
    }

    Sink out_;
    std::string buffer_;
    std::map<std::string, std::size_t> tokens_;
};

} // namespace

std::unique_ptr<DocumentWriter> make_binary_writer(Sink out)
{
    return std::make_unique<BinaryWriter>(std::move(out));
}

} // namespace vdb_shell::houdini

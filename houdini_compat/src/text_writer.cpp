// SPDX-License-Identifier: Apache-2.0

// Writes a document as JSON text, the .geo form. Numbers keep their value: digits are the shortest
// that give the same double again, and do not depend on the locale. The commas and colons follow
// from what was written last, so callers only say values. A trap: JSON has no NaN and no infinity,
// so those are refused; and text has to be UTF-8, which the binary form does not ask for.

#include "vdb_shell/core/error.h"

#include "document_writer.h"

#include <nlohmann/json.hpp>

#include <charconv>
#include <cmath>
#include <string>

namespace vdb_shell::houdini
{
namespace
{

class TextWriter final : public DocumentWriter
{
public:
    explicit TextWriter(Sink out) : out_(std::move(out)) {}
    void open_list() override { open('['); }
    void close_list() override { close(']'); }
    void open_map() override
    {
        open('{');
        maps_.back() = true;
    }
    void close_map() override { close('}'); }
    void text(std::string_view value) override
    {
        before_value();
        // The JSON library quotes and escapes; for a string that is not UTF-8 it throws, and the
        // message then shows the string with its bad bytes replaced.
        try {
            buffer_ += nlohmann::json(value).dump();
        } catch (const nlohmann::json::exception&) {
            throw InvalidOption("a string that is not UTF-8 cannot be written as text: " +
                                nlohmann::json(value).dump(
                                    -1, ' ', false, nlohmann::json::error_handler_t::replace));
        }
        after_value();
    }
    void integer(std::int64_t value) override { value_of(value); }
    void real(double value) override { value_of(value); }
    void boolean(bool value) override
    {
        before_value();
        buffer_ += value ? "true" : "false";
        after_value();
    }
    void numbers(const std::int8_t* values, std::size_t count) override { list(values, count); }
    void numbers(const std::int32_t* values, std::size_t count) override { list(values, count); }
    void numbers(const std::int64_t* values, std::size_t count) override { list(values, count); }
    void numbers(const float* values, std::size_t count) override { list(values, count); }
    void numbers(const double* values, std::size_t count) override { list(values, count); }
    bool paged() const override { return false; }
    // Kept until the next value, because the break goes behind the comma and before the value.
    void new_line() override { line_break_ = true; }
    void finish() override
    {
        buffer_ += '\n';
        flush();
    }

private:
    // In bytes: large enough for few calls of the sink, and small beside a document for which
    // memory matters.
    static constexpr std::size_t kFlushAt = 1 << 16;

    void before_value()
    {
        if (follows_)
            buffer_ += after_key_ ? ':' : ',';
        if (line_break_)
            buffer_ += '\n';
        line_break_ = false;
    }
    void after_value()
    {
        follows_ = true;
        // In a map every other value is a key.
        after_key_ = !maps_.empty() && maps_.back() && !after_key_;
        if (buffer_.size() > kFlushAt)
            flush();
    }
    void open(char mark)
    {
        before_value();
        buffer_ += mark;
        follows_ = after_key_ = false;
        maps_.push_back(false);
    }
    // A break that was wanted last goes before the bracket, so that the brackets of long documents
    // stand on lines of their own.
    void close(char mark)
    {
        if (line_break_)
            buffer_ += '\n';
        line_break_ = false;
        buffer_ += mark;
        maps_.pop_back();
        // A container in a map is a value, so a key comes next.
        after_key_ = !maps_.empty() && maps_.back();
        after_value();
    }

    void digits(std::int64_t value)
    {
        char text[32];
        buffer_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
    }
    /// A float's digits are those of the double of the same value. The shortest digits of the float
    /// itself name another double, and most readers read doubles.
    void digits(double value)
    {
        if (!std::isfinite(value))
            throw InvalidOption("the number " + std::to_string(value) +
                                " cannot be written as text, only finite ones can");
        char text[64];
        buffer_.append(text, std::to_chars(text, text + sizeof text, value).ptr);
        // "-0" without a point is an integer to most readers, and integers have no negative zero;
        // the sign would be lost, and with it the checksum of the shell.
        if (value == 0 && std::signbit(value))
            buffer_ += ".0";
    }
    template <typename T> void value_of(T value)
    {
        before_value();
        digits(value);
        after_value();
    }
    template <typename T> void list(const T* values, std::size_t count)
    {
        open_list();
        for (std::size_t i = 0; i < count; ++i) {
            if constexpr (std::is_integral_v<T>)
                value_of(static_cast<std::int64_t>(values[i]));
            else
                value_of(static_cast<double>(values[i]));
        }
        close_list();
    }
    void flush()
    {
        out_(buffer_.data(), buffer_.size());
        buffer_.clear();
    }

    Sink out_;
    std::string buffer_;
    std::vector<bool> maps_;
    bool follows_ = false, after_key_ = false, line_break_ = false;
};

} // namespace

std::unique_ptr<DocumentWriter> make_text_writer(Sink out)
{
    return std::make_unique<TextWriter>(std::move(out));
}

} // namespace vdb_shell::houdini
